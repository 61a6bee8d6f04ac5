// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <utility>

#include "key_news_desk.hpp"
#include "progress.hpp"
#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"
#include "skein/seal/keys.hpp"
#include "skein/seal/opener.hpp"
#include "skein/seal/sealer.hpp"

namespace skein::network {

/// What a carrier seals and opens with; from any thread.
class Seals {
 public:
  /// Where another node listens: IPv4 address as a number, and UDP port.
  using Place = std::pair<std::uint32_t, std::uint16_t>;

  Seals(const seal::SenderStart& start, const seal::EpochKey& key, seal::CounterRange counters,
        std::map<Place, VehicleId> peers);
  /// Seals with this key from now on, and goes on to open the present one's for so long.
  void change_key(const seal::EpochKey& key, Duration old_for);

  [[nodiscard]] std::uint8_t epoch() const;

  seal::Sealer sealer;
  seal::Opener opener;
  /// Opened, but not what a node of ours sends: no whole submessages, or in another's name.
  std::atomic<std::uint64_t> misformed{0};
  Progress progress;
  KeyNewsDesk news;
  const std::map<Place, VehicleId> peers;  ///< told of news

 private:
  mutable std::mutex mutex_;
  seal::EpochKey key_;  ///< of now
};

/// By the clock that epochs end by, and progress is seen: it never jumps.
[[nodiscard]] Instant steady_now();

}  // namespace skein::network
