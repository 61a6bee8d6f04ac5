// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "skein/agencies/shown.hpp"
#include "skein/base/time.hpp"
#include "skein/mavlink/enums.hpp"
#include "skein/mavlink/parser.hpp"

namespace skein::agencies {

/// Shows every vehicle as a MAVLink system of its number, component autopilot: HEARTBEAT,
/// SYS_STATUS, BATTERY_STATUS, of its way MISSION_CURRENT and NAV_CONTROLLER_OUTPUT, and who has a
/// Remote ID that (OPEN_DRONE_ID_*), once a second; what it does as text when it changes; position,
/// attitude and speeds with newer states, kStatePeriod apart; nothing of vehicles that are silent,
/// and of those beyond kVehicleMax. Pure; `now` never decreases.
class MavlinkFeed {
 public:
  static constexpr std::uint16_t kVehicleMax = 250;  ///< above it ground stations have theirs
  static constexpr Duration kHeartbeatPeriod = std::chrono::seconds{1};
  static constexpr Duration kStatePeriod = std::chrono::milliseconds{190};

  /// The packets that are due, one a datagram. Heights are told as above the ellipsoid, and above
  /// the origin. `unix_ns` is `now` by the clock that others have.
  [[nodiscard]] std::vector<mavlink::WireBytes> update(const Shown& shown, Instant now,
                                                       std::int64_t unix_ns);
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
    std::optional<mission::Activity> told;
    std::optional<Wgs84> take_off;  ///< where it was first heard
    std::uint16_t texts = 0;
  };

  System& system_of(VehicleId vehicle);
  void say_mission(System& system, const Shown& shown, VehicleId vehicle,
                   std::vector<mavlink::WireBytes>& due) const;
  void say_activity(System& system, const ShownVehicle& vehicle,
                    std::vector<mavlink::WireBytes>& due) const;

  std::map<VehicleId, System> systems_;
};

}  // namespace skein::agencies
