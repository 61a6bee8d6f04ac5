// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "skein/ardupilot/flight_limits.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/mavlink/enums.hpp"

namespace skein::ardupilot {

/// A parameter of the autopilot that the safety of a flight rests on.
struct SafetyParameter {
  std::string_view name;        ///< of 4.5 and 4.6
  std::string_view later_name;  ///< of later releases, where they have another; else empty
  std::span<const int> good;    ///< what it may be; empty: the autopilot's own system
  std::string_view why;         ///< what is lost without
};

/// HEARTBEAT's `custom_mode`, and as pilots call it.
using NamedMode = std::pair<std::uint32_t, std::string_view>;

/// All that the companion does differently by what an ArduPilot flies. Another airframe is another
/// row of airframe.cpp; docs/ardupilot.md is printed from it.
struct AirframeTraits {
  std::span<const NamedMode> modes;
  std::span<const std::uint8_t> vehicle_types;  ///< HEARTBEAT's `type`
  std::uint32_t guided_mode = 0;
  std::uint32_t takeoff_mode = 0;               ///< in which it leaves the ground
  std::uint32_t land_mode = 0;                  ///< in which it is landed
  std::span<const std::uint32_t> return_modes;  ///< RTL and the like
  bool flies_to_points = false;                 ///< else by a bank, an airspeed and a height
  bool is_lifted = false;                       ///< NAV_TAKEOFF takes it off, in that mode
  /// Taken off, it hovers until it is given a place to fly to.
  bool hovers_first = false;
  /// The end of the mission that lands it; none: the mode lands it where it is.
  std::optional<mavlink::Command> touch_down;
  std::span<const SafetyParameter> safety;
  std::span<const LimitParameter> limits;

  [[nodiscard]] bool is_return(std::uint32_t mode) const;
  [[nodiscard]] bool is_of(std::uint8_t vehicle_type) const;
  /// "GUIDED"; the number of one that has no name here.
  [[nodiscard]] std::string name_of(std::uint32_t mode) const;
};
[[nodiscard]] const AirframeTraits& traits_of(Airframe airframe);

}  // namespace skein::ardupilot
