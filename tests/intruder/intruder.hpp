// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/random.hpp"
#include "skein/network/node.hpp"

/// What somebody sends who reaches the mission network and has no keys.
namespace skein::intruder {

using Bytes = std::vector<std::uint8_t>;

/// UDP from one socket of loopback.
class Socket {
 public:
  Socket();
  ~Socket();
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  /// One of loopback, or a group that is listened to there.
  void send(std::span<const std::uint8_t> datagram, const network::Endpoint& to) const;

 private:
  int descriptor_ = -1;
};

/// An RTPS message of a Skein node with that id, as its GUID says, with one submessage.
[[nodiscard]] Bytes rtps_message(VehicleId as, std::uint8_t submessage, std::size_t bytes);
/// What made Debian's Fast DDS 2.9 abort: its statistics submessage, 4 bytes long.
[[nodiscard]] Bytes killing_statistics(VehicleId as);
/// What made a vehicle deaf to its ground station: a heartbeat of sequence numbers far ahead.
[[nodiscard]] Bytes deafening_heartbeat(VehicleId as);
/// Begins as a sealed datagram, or as news of a key; the rest is random.
[[nodiscard]] Bytes forged_seal(VehicleId as, Random& random);
[[nodiscard]] Bytes forged_news(Random& random);
[[nodiscard]] Bytes noise(Random& random);

}  // namespace skein::intruder
