// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fastdds/rtps/transport/TransportDescriptorInterface.h>

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
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

/// What a node's sealed transport works with; the node keeps it, too, to change keys and to count.
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

/// Puts a transport around `transport` that sends nothing in clear, and hands on only what was
/// opened: before that nothing of a datagram is parsed but the 14 bytes of its header.
[[nodiscard]] std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> sealed(
    std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface> transport,
    std::shared_ptr<Seals> seals);

}  // namespace skein::network
