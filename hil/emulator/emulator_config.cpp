// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/emulator_config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plane_airframe.hpp"
#include "skein/autopilot/fixed_wing_loops.hpp"
#include "skein/autopilot/hexarotor_loops.hpp"
#include "skein/autopilot/modes.hpp"
#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"

namespace skein::hil {
namespace {

double bank_of_circle(const EmulatorConfig& config) {
  return std::atan(config.airspeed_mps * config.airspeed_mps /
                   (kGravity_mps2 * config.turn_radius_m));
}

constexpr double kCopterClimbMost_mps = 12.0;

Result<void> check_plane(const EmulatorConfig& c) {
  const PlaneAirframe* const found = airframe_for(c);
  if (found == nullptr || !(c.airspeed_min_mps <= c.airspeed_mps) ||
      !(c.airspeed_mps <= c.airspeed_max_mps)) {
    return Error{fmt::format(
        "airspeeds least {:g}, cruise {:g}, greatest {:g} m/s: they must rise, within the {} m/s "
        "of an airframe",
        c.airspeed_min_mps, c.airspeed_mps, c.airspeed_max_mps, airframe_speeds(c.airframe))};
  }
  const autopilot::FixedWingTuning& airframe = found->tuning;
  if (!(c.turn_radius_m > 0.0) || bank_of_circle(c) > airframe.roll_max_rad) {
    const double least =
        c.airspeed_mps * c.airspeed_mps / (kGravity_mps2 * std::tan(airframe.roll_max_rad));
    return Error{
        fmt::format("turn radius {:g} m: at {:g} m/s the airframe turns no tighter than {:.0f} m",
                    c.turn_radius_m, c.airspeed_mps, std::ceil(least))};
  }
  return {};
}

Result<void> check_copter(const EmulatorConfig& c) {
  const autopilot::HexarotorTuning airframe;
  if (!(c.airspeed_mps >= 1.0 && c.airspeed_mps <= airframe.speed_max_mps)) {
    return Error{fmt::format("speed {:g} m/s: the copter flies at 1 to {:g}", c.airspeed_mps,
                             airframe.speed_max_mps)};
  }
  if (!(c.climb_mps >= 0.5 && c.climb_mps <= kCopterClimbMost_mps)) {
    return Error{fmt::format("climb {:g} m/s: the copter climbs and sinks at 0.5 to {:g}",
                             c.climb_mps, kCopterClimbMost_mps)};
  }
  return {};
}

}  // namespace

std::optional<std::uint32_t> mode_named(Airframe airframe, std::string_view name) {
  constexpr std::uint32_t kNumbers = 32;
  for (std::uint32_t number = 0; number < kNumbers; ++number) {
    if (airframe != Airframe::copter) {
      const auto mode = autopilot::plane_mode(number);
      const bool flown =
          mode && (airframe == Airframe::quadplane || !autopilot::needs_rotors(*mode));
      if (flown && autopilot::to_string(*mode) == name) return number;
    } else {
      const auto mode = autopilot::copter_mode(number);
      if (mode && autopilot::to_string(*mode) == name) return number;
    }
  }
  return std::nullopt;
}

double bank_limit_rad(const EmulatorConfig& config) {
  const PlaneAirframe* const airframe = airframe_for(config);
  SKEIN_ASSERT(airframe != nullptr);
  return std::min(bank_of_circle(config) + airframe->bank_reserve_rad,
                  airframe->tuning.roll_max_rad);
}

Result<void> check(const EmulatorConfig& c) {
  if (c.node_id < 1 || c.node_id > 127 || c.companion_node < 1 || c.companion_node > 127) {
    return Error{
        fmt::format("nodes {} and {}: a DroneCAN node is 1 to 127", c.node_id, c.companion_node)};
  }
  if (!(c.battery_mah >= 100.0 && c.battery_mah <= 1e6)) {
    return Error{fmt::format("battery of {:g} mAh: it has 100 to 1000000", c.battery_mah)};
  }
  if (c.node_id == c.companion_node) {
    return Error{fmt::format("node {}: the companion must have another", c.node_id)};
  }
  if (c.serial_id < 0 || c.serial_id > 15) {
    return Error{fmt::format("serial port {}: it is 0 to 15", c.serial_id)};
  }
  if (c.system_id < 1 || c.companion_system < 1) {
    return Error{"MAVLink systems are 1 to 255"};
  }
  if (!std::isfinite(c.start.x_m) || !std::isfinite(c.start.y_m) || !std::isfinite(c.height_m) ||
      !std::isfinite(c.start.heading_rad)) {
    return Error{"the start is not a number"};
  }
  if (c.airborne && !(c.height_m >= 10.0)) {
    return Error{fmt::format("start height {:g} m: in flight it is at least 10 m", c.height_m)};
  }
  if (!c.wind_mps.allFinite() || !(c.wind_mps.norm() <= 25.0) ||
      !(c.gusts_wind_mps >= 0.0 && c.gusts_wind_mps <= 25.0)) {
    return Error{fmt::format("wind {:g} m/s, gusts of {:g} m/s: 0 to 25 can be flown",
                             c.wind_mps.norm(), c.gusts_wind_mps)};
  }
  if (!(c.fence_height_m >= 0.0 && c.fence_height_m <= 10'000.0)) {
    return Error{fmt::format("a fence of {:g} m: 0 to 10000 can be kept", c.fence_height_m)};
  }
  if (!(c.turbulence_mps >= 0.0 && c.turbulence_mps <= 20.0)) {
    return Error{fmt::format("turbulence of {:g} m/s: 0 to 20 can be flown", c.turbulence_mps)};
  }
  if (auto origin = MissionOrigin::make(c.origin); !origin) return origin.error();
  if (c.airborne && !mode_named(c.airframe, c.mode)) {
    return Error{fmt::format("mode '{}': the emulated autopilot has none of that name", c.mode)};
  }
  return c.airframe == Airframe::copter ? check_copter(c) : check_plane(c);
}

}  // namespace skein::hil
