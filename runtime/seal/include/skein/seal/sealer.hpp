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

/// Seals what one start of one node sends. From any thread.
class Sealer {
 public:
  Sealer(const SenderStart& start, const EpochKey& key);
  ~Sealer();
  Sealer(const Sealer&) = delete;
  Sealer& operator=(const Sealer&) = delete;

  /// From now on with the key of another epoch.
  void change(const EpochKey& key);

  /// `out` becomes the sealed datagram. False where this start's counters are used up, which takes
  /// three years of 10,000 datagrams a second.
  [[nodiscard]] bool seal(std::span<const std::uint8_t> plain, std::vector<std::uint8_t>& out);

 private:
  const SenderStart start_;
  std::mutex mutex_;  ///< of everything below
  std::unique_ptr<Cipher> cipher_;
  std::uint8_t epoch_;
  std::uint64_t next_ = 0;
};

}  // namespace skein::seal
