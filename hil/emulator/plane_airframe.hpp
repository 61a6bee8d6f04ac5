// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "skein/autopilot/fixed_wing_loops.hpp"
#include "skein/autopilot/vtol_flight.hpp"
#include "skein/hil/emulator_config.hpp"
#include "skein/models/fixed_wing.hpp"

namespace skein::hil {

/// An aircraft that can be emulated, with the loops that fly it.
struct PlaneAirframe {
  models::FixedWingParams model;
  autopilot::FixedWingTuning tuning;  ///< its airspeeds: what it can fly
  double parked_height_m = 0.0;       ///< of the wheels under the centre of mass
  double rotate_share = 0.0;          ///< of its least airspeed, at which it lifts its nose
  double flare_height_m = 0.0;
  double bank_reserve_rad = 0.0;  ///< of its limit, over the bank of the circle without slip
  std::optional<autopilot::VtolParams> vtol = {};  ///< of a quadplane
};

/// The airframe of the configuration's kind that flies all its three airspeeds, or nothing.
[[nodiscard]] const PlaneAirframe* airframe_for(const EmulatorConfig& config);

/// The airspeeds of all of that kind, for who asked for others: "15 to 35 or 40 to 70".
[[nodiscard]] std::string airframe_speeds(Airframe kind);

}  // namespace skein::hil
