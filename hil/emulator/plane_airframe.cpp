// SPDX-License-Identifier: Apache-2.0
#include "plane_airframe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "skein/base/angles.hpp"

namespace skein::hil {
namespace {

/// Speeds and times of the small one are half of those of the fast one, lengths a quarter.
constexpr double kSmallScale = 0.25;

PlaneAirframe fast() {
  return {.model = models::fast_fixed_wing(),
          .tuning = {},
          .parked_height_m = 0.46,
          .rotate_share = 0.95,
          .flare_height_m = 8.0,
          .bank_reserve_rad = radians(5.0)};
}

PlaneAirframe small() {
  PlaneAirframe airframe{.model = models::small_fixed_wing(),
                         .tuning = autopilot::froude_scaled({}, kSmallScale),
                         .parked_height_m = 0.46 * kSmallScale,
                         .rotate_share = 0.95,
                         .flare_height_m = 4.0,
                         .bank_reserve_rad = radians(10.0)};
  autopilot::FixedWingTuning& t = airframe.tuning;
  t.airspeed_min_mps = 15.0;
  t.airspeed_max_mps = 35.0;
  // RLL2SRV_TCONST, PTCH2SRV_TCONST and the RMAX of both, as ArduPilot's own simulated plane has
  // them: an agile model aircraft could be twice as quick.
  t.roll_gain_per_s = 4.0;
  t.pitch_gain_per_s = 4.0;
  t.roll_rate_max_radps = 1.57;
  t.pitch_rate_max_radps = 1.57;
  // As ArduPlane by default (YAW2SRV_SLIP and YAW2SRV_DAMP are 0): nothing takes the slip out of
  // its turns.
  t.yaw_gain_s = 0.0;
  t.sideslip_gain_s_per_m = 0.0;
  t.slow_energy.emplace();
  return airframe;
}

PlaneAirframe small_vtol() {
  PlaneAirframe airframe = small();
  airframe.model = models::small_quadplane();
  const models::LiftRotorParams& rotors = *airframe.model.lift;
  autopilot::VtolParams& vtol = airframe.vtol.emplace();
  vtol.tuning.mass_kg = airframe.model.mass.mass_kg();
  vtol.tuning.inertia_kgm2 = airframe.model.mass.inertia_kgm2().diagonal();
  // Q_WP_SPD_UP and Q_WP_SPD_DN; a wing stalls in what a multirotor would tilt by.
  vtol.tuning.climb_max_mps = 2.5;
  vtol.tuning.sink_max_mps = 1.5;
  vtol.tuning.tilt_max_rad = 0.4;
  vtol.tuning.acceleration_max_mps2 = 3.0;
  vtol.arm_forward_m = rotors.arm_forward_m;
  vtol.arm_right_m = rotors.arm_right_m;
  vtol.rotor_thrust_max_n = rotors.thrust_max_n;
  vtol.torque_per_lift_m = rotors.torque_per_lift_m;
  return airframe;
}

const std::array<PlaneAirframe, 3>& airframes() {
  static const std::array<PlaneAirframe, 3> all{small(), fast(), small_vtol()};
  return all;
}

bool is_of(Airframe kind, const PlaneAirframe& airframe) {
  return airframe.vtol.has_value() == (kind == Airframe::quadplane);
}

}  // namespace

const PlaneAirframe* airframe_for(const EmulatorConfig& config) {
  const auto found = std::find_if(airframes().begin(), airframes().end(), [&](const auto& a) {
    return is_of(config.airframe, a) && config.airspeed_min_mps >= a.tuning.airspeed_min_mps &&
           config.airspeed_max_mps <= a.tuning.airspeed_max_mps;
  });
  return found == airframes().end() ? nullptr : &*found;
}

std::string airframe_speeds(Airframe kind) {
  std::string text;
  for (const PlaneAirframe& a : airframes()) {
    if (!is_of(kind, a)) continue;
    text += fmt::format("{}{:g} to {:g}", text.empty() ? "" : " or ", a.tuning.airspeed_min_mps,
                        a.tuning.airspeed_max_mps);
  }
  return text;
}

}  // namespace skein::hil
