// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string_view>
#include <vector>

#include "skein/agencies/shown.hpp"
#include "skein/base/time.hpp"
#include "skein/mavlink/enums.hpp"
#include "skein/mavlink/parser.hpp"

namespace skein::agencies {

/// Shows every vehicle as a MAVLink system of its number, component autopilot: HEARTBEAT,
/// SYS_STATUS and BATTERY_STATUS once a second, position, attitude and speeds with newer states,
/// kStatePeriod apart; nothing of vehicles that are silent, and of those beyond kVehicleMax. Pure;
/// `now` never decreases.
class MavlinkFeed {
 public:
  static constexpr std::uint16_t kVehicleMax = 250;  ///< above it ground stations have theirs
  static constexpr Duration kHeartbeatPeriod = std::chrono::seconds{1};
  static constexpr Duration kStatePeriod = std::chrono::milliseconds{190};

  /// The packets that are due, one a datagram. Heights are told as above the ellipsoid, and above
  /// the origin.
  [[nodiscard]] std::vector<mavlink::WireBytes> update(const Shown& shown, Instant now);
  /// What is said of that vehicle, in as many STATUSTEXTs as it takes.
  [[nodiscard]] std::vector<mavlink::WireBytes> alarm(VehicleId vehicle, std::string_view text);

 private:
  struct System {
    explicit System(VehicleId id)
        : encoder{static_cast<std::uint8_t>(id.value), mavlink::kComponentAutopilot} {}
    mavlink::Encoder encoder;
    Instant heartbeat_at{Instant::min()};
    Instant state_at{Instant::min()};
    Instant measured{Instant::min()};
    std::uint16_t texts = 0;
  };

  System& system_of(VehicleId vehicle);

  std::map<VehicleId, System> systems_;
};

}  // namespace skein::agencies
