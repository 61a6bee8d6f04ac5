// SPDX-License-Identifier: Apache-2.0
#include "turn_room.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "skein/planning/arrival_forecast.hpp"

namespace skein::mission {
namespace {

constexpr double kMemory_s = 20.0;
constexpr double kGap_s = 1.0;      ///< of states; a longer one counts as this
constexpr double kTrusted_s = 5.0;  ///< of wind, before it widens a turn
constexpr double kReserve = 1.05;   ///< of what the wind takes
constexpr double kRelieved = 0.8;   ///< of the radius: then it is planned tighter again
constexpr double kTight = 1.2;      ///< what is so much too tight is flown well off its line
constexpr double kFlying = 0.8;     ///< of the least airspeed: slower, it tells nothing of the wind

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

TurnRoom::TurnRoom(const VehicleSpec& vehicle, std::optional<double> airspeed_change_mps2)
    : vehicle_{vehicle},
      airspeed_change_mps2_{airspeed_change_mps2},
      widest_m_{widest(vehicle)},
      radius_m_{vehicle.planning_radius_m()} {}

double TurnRoom::held_radius_m() const {
  const double speed_mps = vehicle_.cruise_speed_mps;
  const double left_mps = speed_mps - wind_mps();
  if (left_mps <= 0.0) return std::numeric_limits<double>::infinity();
  const double stretched = speed_mps / left_mps;
  return std::max(vehicle_.turn_radius_m * stretched * stretched,
                  wind_mps() * speed_mps / *airspeed_change_mps2_);
}

bool TurnRoom::on_state(const VehicleState& state) {
  if (!airspeed_change_mps2_ || vehicle_.is_copter()) return false;
  if (state.airspeed_mps < kFlying * vehicle_.speed_min_mps) return false;
  const double since_s = last_ ? std::min(to_seconds(state.time - *last_), kGap_s) : 0.0;
  last_ = state.time;
  if (since_s <= 0.0) return false;
  heard_s_ = std::min(heard_s_ + since_s, kMemory_s);
  wind_mps_ += since_s / heard_s_ * (planning::wind_of(state) - wind_mps_);
  if (heard_s_ < kTrusted_s) return false;

  const double held_m = held_radius_m();
  const double stretched_m = std::min(kReserve * held_m, widest_m_);
  const double wanted_m = std::max(stretched_m, vehicle_.planning_radius_m());
  lacks_room_ = held_m > kTight * widest_m_;
  const bool wider = held_m > radius_m_ && wanted_m > kReserve * radius_m_;
  const bool tighter = held_m < kRelieved * radius_m_ && wanted_m < radius_m_ / kReserve;
  if (!wider && !tighter) return false;
  radius_m_ = wanted_m;
  return true;
}

}  // namespace skein::mission
