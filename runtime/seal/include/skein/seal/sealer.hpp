// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "skein/seal/header.hpp"
#include "skein/seal/keys.hpp"

namespace skein::seal {

class Cipher;

/// Which counters of a start are one sealer's: where several seal for one start, one after the
/// other, nobody may use another's.
struct CounterRange {
  std::uint64_t first = 0;
  std::uint64_t end = kCounterMax + 1;  ///< without it
};

/// Seals what one start of one node sends. From any thread.
class Sealer {
 public:
  Sealer(const SenderStart& start, const EpochKey& key, CounterRange counters = {});
  ~Sealer();
  Sealer(const Sealer&) = delete;
  Sealer& operator=(const Sealer&) = delete;

  /// From now on with the key of another epoch.
  void change(const EpochKey& key);

  /// More counters are its own, up to this one. Never fewer.
  void extend(std::uint64_t end);
  /// Of the next datagram.
  [[nodiscard]] std::uint64_t next() const;

  /// `out` becomes the sealed datagram. False where its counters are used up; those of a whole
  /// start last for three years of 10,000 datagrams a second.
  [[nodiscard]] bool seal(std::span<const std::uint8_t> plain, std::vector<std::uint8_t>& out);

 private:
  const SenderStart start_;
  mutable std::mutex mutex_;  ///< of everything below
  std::unique_ptr<Cipher> cipher_;
  std::uint8_t epoch_;
  CounterRange left_;
};

}  // namespace skein::seal
