// SPDX-License-Identifier: Apache-2.0
#include "turn_room.hpp"

#include <algorithm>
#include <cmath>

#include "skein/planning/arrival_forecast.hpp"

namespace skein::mission {
namespace {

constexpr double kMemory_s = 20.0;
constexpr double kGap_s = 1.0;      ///< of states; a longer one counts as this
constexpr double kTrusted_s = 5.0;  ///< of wind, before it changes what is planned
/// Of what the wind takes: none is left there by a bank that is used up, and gusts take some.
constexpr double kReserve = 1.15;
constexpr double kLeast = 1.05;    ///< of it: with less, turns are planned wider
constexpr double kStep = 1.05;     ///< less changes nothing
constexpr double kRelieved = 0.8;  ///< of the radius: then it is planned tighter again
constexpr double kTight = 1.2;     ///< what is so much too tight is flown well off its line
constexpr double kFlying = 0.8;    ///< of the least airspeed: slower, it tells nothing of the wind

/// No wider than what its sensors take it around a site on.
double widest(const VehicleSpec& vehicle) {
  double widest_m = TurnRoom::kWidest * vehicle.turn_radius_m;
  if (vehicle.capabilities.has(TaskKind::survey)) {
    widest_m = std::min(widest_m, vehicle.sensor_radius_m);
  }
  if (vehicle.capabilities.has(TaskKind::assess)) {
    widest_m = std::min(widest_m, vehicle.assess_radius_m);
  }
  return std::max(widest_m, vehicle.planning_radius_m());
}

}  // namespace

TurnRoom::TurnRoom(const VehicleSpec& vehicle, bool heeds_wind)
    : vehicle_{vehicle},
      heeds_wind_{heeds_wind && !vehicle.is_copter()},
      widest_m_{widest(vehicle)},
      radius_m_{vehicle.planning_radius_m()} {}

double TurnRoom::held_radius_m() const {
  const double gust_mps = std::sqrt(gusts_m2ps2_ / 2.0);  // along the wind, one deviation
  const double stretched = 1.0 + (wind_mps_.norm() + gust_mps) / vehicle_.cruise_speed_mps;
  return vehicle_.turn_radius_m * stretched * stretched;
}

bool TurnRoom::on_state(const VehicleState& state) {
  if (!heeds_wind_) return false;
  if (state.airspeed_mps < kFlying * vehicle_.speed_min_mps) return false;
  const bool first = !last_;  // all there is to begin a flight with
  const double since_s = first ? 0.0 : std::min(to_seconds(state.time - *last_), kGap_s);
  last_ = state.time;
  if (!first && since_s <= 0.0) return false;
  heard_s_ = std::min(heard_s_ + since_s, kMemory_s);
  const double weight = first ? 1.0 : since_s / heard_s_;
  const Vec2 other_mps = planning::wind_of(state) - wind_mps_;
  wind_mps_ += weight * other_mps;
  gusts_m2ps2_ += weight * ((1.0 - weight) * other_mps.squaredNorm() - gusts_m2ps2_);
  if (!first && heard_s_ < kTrusted_s) return false;

  const double held_m = held_radius_m();
  const double stretched_m = std::min(kReserve * held_m, widest_m_);
  const double wanted_m = std::max(stretched_m, vehicle_.planning_radius_m());
  lacks_room_ = held_m > kTight * widest_m_;
  const bool wider = kLeast * held_m > radius_m_ && wanted_m > kStep * radius_m_;
  const bool tighter = held_m < kRelieved * radius_m_ && wanted_m < radius_m_ / kStep;
  const bool other_wind = (wind_mps_ - planned_wind_mps_).norm() >= kWindChange_mps;
  if (!wider && !tighter && !other_wind) return false;
  if (wider || tighter) radius_m_ = wanted_m;
  planned_wind_mps_ = wind_mps_;
  return true;
}

}  // namespace skein::mission
