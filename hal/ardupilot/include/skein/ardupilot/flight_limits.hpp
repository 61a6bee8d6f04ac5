// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "skein/domain/vehicle.hpp"

namespace skein::ardupilot {

/// A parameter of an ArduPilot that limits what may be asked of it, in SI units but for degrees.
struct LimitParameter {
  std::string_view name;
  std::string_view older_name;  ///< empty where it has always had that one
  double older_unit = 1.0;      ///< what 1 of the older one is
};
inline constexpr LimitParameter kRollLimit{"ROLL_LIMIT_DEG", "LIM_ROLL_CD", 0.01};
inline constexpr LimitParameter kAirspeedMin{"AIRSPEED_MIN", "ARSPD_FBW_MIN"};
inline constexpr LimitParameter kAirspeedMax{"AIRSPEED_MAX", "ARSPD_FBW_MAX"};
inline constexpr LimitParameter kAirspeedCruise{"AIRSPEED_CRUISE", "TRIM_ARSPD_CM", 0.01};
/// Of the energy between height and airspeed, which is pitch's to share out: 0 is height alone.
inline constexpr LimitParameter kSpeedWeight{"TECS_SPDWEIGHT", ""};
/// Where it is 1, AIRSPEED_MIN limits the bank, too.
inline constexpr LimitParameter kStallPrevention{"STALL_PREVENTION", ""};
/// Of a quadplane: slower than that its rotors carry, too, and it banks no more than they may.
inline constexpr LimitParameter kAssistSpeed{"Q_ASSIST_SPEED", ""};
/// Of a copter, how fast GUIDED lets it climb and sink: a place that does so faster it is late at.
inline constexpr LimitParameter kClimbSpeed{"WP_SPD_UP", "WPNAV_SPEED_UP", 0.01};
inline constexpr LimitParameter kSinkSpeed{"WP_SPD_DN", "WPNAV_SPEED_DN", 0.01};

/// How high above the ground it is taken over on its way to that height: near enough to fly its
/// plan, and below where a climb ends that levels out early.
[[nodiscard]] constexpr double taken_over_at_m(double takeoff_height_m) {
  constexpr double kShort_m = 3.0;
  constexpr double kShare = 0.9;
  return std::max(kShare * takeoff_height_m, takeoff_height_m - kShort_m);
}
/// The bank that an ArduPlane's STALL_PREVENTION leaves (Plane::update_load_factor): the
/// load factor's root, 1 / sqrt(cos(bank)), is at most airspeed / AIRSPEED_MIN, but 25 degrees it
/// leaves always. The limit by ROLL_LIMIT_DEG comes on top.
[[nodiscard]] double prevented_bank_deg(double airspeed_mps, double airspeed_min_mps);

/// What a vehicle's configuration asks of a parameter.
struct LimitFinding {
  enum class Verdict : std::uint8_t { good, differs, refused };
  Verdict verdict = Verdict::good;
  std::string found;   ///< what the autopilot has
  std::string remedy;  ///< which number to change, and to what; empty where it is good
};
/// `name` is the one that the autopilot answered by, `value` as it told it, and what
/// STALL_PREVENTION is, where that is told. A circle is flown where V^2 / (g tan(bank)) is no more
/// than its radius, by the bank that ROLL_LIMIT_DEG and stall prevention leave.
[[nodiscard]] LimitFinding judge_limit(const VehicleSpec& vehicle, const LimitParameter& parameter,
                                       std::string_view name, double value,
                                       std::optional<double> stall_prevention);

}  // namespace skein::ardupilot
