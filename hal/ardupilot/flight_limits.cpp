// SPDX-License-Identifier: Apache-2.0
#include "skein/ardupilot/flight_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "skein/base/angles.hpp"
#include "skein/base/attitude.hpp"

namespace skein::ardupilot {
namespace {

using Verdict = LimitFinding::Verdict;

/// Parameters are floats, and people round.
constexpr double kSlack = 1e-3;
/// Of bank, over that of a steady turn: an aircraft slips, and rolls past before it settles.
constexpr double kBankReserve_deg = 5.0;
constexpr double kBankMax_deg = 80.0;
/// The autopilot returns home by itself at its own cruise airspeed.
constexpr double kCruiseOff_mps = 2.0;
/// Of a quadplane's least airspeed: gusts shall not start its rotors.
constexpr double kAssistBelow_mps = 2.0;
/// ArduPlane, STALL_PREVENTION: it always leaves this much bank.
constexpr double kBankAlways_deg = 25.0;

/// At 1 heights were off by 3.3 m rms in 5 m/s of wind, at 0 by 1.2 (docs/ardupilot.md).
constexpr double kSpeedWeightMost = 0.5;

/// In the unit of the name that the autopilot knows.
std::string number(const LimitParameter& parameter, std::string_view name, double value) {
  const bool is_older = name == parameter.older_name;
  return fmt::format("{:.{}f}", is_older ? value / parameter.older_unit : value,
                     is_older && parameter.older_unit < 1.0 ? 0 : 1);
}

/// Of a circle in level flight, without slip.
double bank_of_circle(double airspeed_mps, double radius_m) {
  return std::atan(airspeed_mps * airspeed_mps / (kGravity_mps2 * radius_m));
}

LimitFinding judge_roll(const VehicleSpec& vehicle, std::string_view name, double limit_deg,
                        std::string found) {
  const double v2 = vehicle.cruise_speed_mps * vehicle.cruise_speed_mps;
  const double radius_m = limit_deg <= 0.0
                              ? INFINITY
                              : v2 / (kGravity_mps2 * std::tan(radians(std::min(limit_deg, 89.0))));
  found +=
      fmt::format(": at {:g} m/s it turns within {:.0f} m", vehicle.cruise_speed_mps, radius_m);
  if (radius_m <= vehicle.turn_radius_m * (1.0 + kSlack)) return {Verdict::good, found, {}};
  const double needed_deg =
      std::ceil(degrees(bank_of_circle(vehicle.cruise_speed_mps, vehicle.turn_radius_m)));
  const double good_deg =
      std::max(needed_deg, std::min(kBankMax_deg, needed_deg + kBankReserve_deg));
  return {Verdict::refused, found,
          fmt::format("turn_radius_m is {:g}: set {} to {} ({} at least), or "
                      "turn_radius_m to {:.0f} or more",
                      vehicle.turn_radius_m, name, number(kRollLimit, name, good_deg),
                      number(kRollLimit, name, needed_deg), std::ceil(radius_m))};
}

/// The highest AIRSPEED_MIN with which stall prevention lets it turn within `radius_m`.
double airspeed_min_most(double airspeed_mps, double radius_m) {
  const double bank_rad = bank_of_circle(airspeed_mps, radius_m);
  if (bank_rad <= radians(kBankAlways_deg)) return INFINITY;
  return airspeed_mps * std::sqrt(std::cos(bank_rad));
}

/// Of an AIRSPEED_MIN that is low enough to be flown at. Plans turn at cruise, and at less to be on
/// time.
LimitFinding judge_bank(const VehicleSpec& vehicle, std::string_view name, double least_mps,
                        std::optional<double> stall_prevention, const std::string& found) {
  if (stall_prevention == 0.0) return {Verdict::good, found, {}};
  for (const double airspeed_mps : {vehicle.cruise_speed_mps, vehicle.speed_min_mps}) {
    const double most_mps = airspeed_min_most(airspeed_mps, vehicle.turn_radius_m);
    if (least_mps <= most_mps * (1.0 + kSlack)) continue;
    const bool refused = stall_prevention && airspeed_mps == vehicle.cruise_speed_mps;
    return {refused ? Verdict::refused : Verdict::differs, found,
            fmt::format("while STALL_PREVENTION is 1 it banks no more than {:.0f} degrees at "
                        "{:g} m/s, too little for turn_radius_m {:g}: set {} to {:.1f} or less, or "
                        "STALL_PREVENTION to 0",
                        prevented_bank_deg(airspeed_mps, least_mps), airspeed_mps,
                        vehicle.turn_radius_m, name, std::floor(most_mps * 10.0) / 10.0)};
  }
  return {Verdict::good, found, {}};
}

/// Places of a formation climb and sink as fast as they move: without tasks of its own it flies
/// those. In a coalition it is where it is, and its plan waits.
LimitFinding judge_vertical(const VehicleSpec& vehicle, const LimitParameter& parameter,
                            std::string_view name, double limit_mps, const std::string& found) {
  const bool flies_places = vehicle.capabilities == Capabilities{};
  if (!flies_places || limit_mps >= vehicle.cruise_speed_mps * (1.0 - kSlack)) {
    return {Verdict::good, found, {}};
  }
  return {Verdict::refused, found,
          fmt::format("it {} at {:g} m/s at most, and its places at up to cruise_speed_mps, {:g}: "
                      "set {} to {} or more, or cruise_speed_mps to {:g} or less",
                      parameter.name == kClimbSpeed.name ? "climbs" : "sinks", limit_mps,
                      vehicle.cruise_speed_mps, name,
                      number(parameter, name, std::ceil(10.0 * vehicle.cruise_speed_mps) / 10.0),
                      limit_mps)};
}

}  // namespace

double prevented_bank_deg(double airspeed_mps, double airspeed_min_mps) {
  const double least_mps = std::max(airspeed_min_mps, 1.0);
  if (airspeed_mps <= least_mps) return kBankAlways_deg;
  const double inverse = least_mps / airspeed_mps;
  return std::max(kBankAlways_deg, degrees(std::acos(inverse * inverse)));
}

LimitFinding judge_limit(const VehicleSpec& vehicle, const LimitParameter& parameter,
                         std::string_view name, double value,
                         std::optional<double> stall_prevention) {
  const std::string found = fmt::format("{} is {:g}", name, value);
  const double si = name == parameter.older_name ? value * parameter.older_unit : value;
  const auto set = [&](double wanted) { return number(parameter, name, wanted); };
  if (!std::isfinite(si)) return {Verdict::refused, found, fmt::format("set {} anew", name)};
  if (parameter.name == kRollLimit.name) return judge_roll(vehicle, name, si, found);
  if (parameter.name == kClimbSpeed.name || parameter.name == kSinkSpeed.name)
    return judge_vertical(vehicle, parameter, name, si, found);
  if (parameter.name == kAirspeedMin.name && si > vehicle.speed_min_mps * (1.0 + kSlack)) {
    return {Verdict::refused, found,
            fmt::format("the autopilot flies no slower, and speed_min_mps is {:g}: set {} to {} or "
                        "less, or speed_min_mps to {:g} or more",
                        vehicle.speed_min_mps, name, set(vehicle.speed_min_mps), si)};
  }
  if (parameter.name == kAirspeedMin.name)
    return judge_bank(vehicle, name, si, stall_prevention, found);
  if (parameter.name == kAirspeedMax.name && si < vehicle.speed_max_mps * (1.0 - kSlack)) {
    return {Verdict::refused, found,
            fmt::format("the autopilot flies no faster, and speed_max_mps is {:g}: set {} to {} or "
                        "more, or speed_max_mps to {:g} or less",
                        vehicle.speed_max_mps, name, set(vehicle.speed_max_mps), si)};
  }
  if (parameter.name == kAirspeedCruise.name &&
      std::abs(si - vehicle.cruise_speed_mps) > kCruiseOff_mps) {
    return {Verdict::differs, found,
            fmt::format("cruise_speed_mps is {:g}, and by itself it returns home at its own: set "
                        "{} to {}, or cruise_speed_mps to {:g}",
                        vehicle.cruise_speed_mps, name, set(vehicle.cruise_speed_mps), si)};
  }
  if (parameter.name == kSpeedWeight.name && si > kSpeedWeightMost) {
    return {Verdict::differs, found,
            fmt::format("height swings by metres while the airspeed changes: set {} to 0", name)};
  }
  if (parameter.name == kAssistSpeed.name && si >= vehicle.speed_min_mps) {
    return {
        Verdict::differs, found,
        fmt::format("its rotors run in flight, since speed_min_mps is {:g}: set {} to {} or "
                    "less",
                    vehicle.speed_min_mps, name, set(vehicle.speed_min_mps - kAssistBelow_mps))};
  }
  return {Verdict::good, found, {}};
}

}  // namespace skein::ardupilot
