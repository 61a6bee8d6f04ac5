// SPDX-License-Identifier: Apache-2.0
#include "task_timing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "skein/planning/arrival_forecast.hpp"

namespace skein::mission {
namespace {
constexpr Duration kStateAgeMax = std::chrono::seconds{1};
constexpr double kUntimely_s = 0.3;
constexpr double kGain_s = 0.2;  ///< at least, of a new path
/// A new path leaves that share of the speed limits to the gusts.
constexpr double kReserve = 0.02;
/// Farther from its time the follower no longer finds where on its path the vehicle is.
constexpr double kAstrayMax_m = 120.0;
constexpr int kSpeeds = 12;  ///< that are tried, to each side of cruise speed

double error_s(const VehicleSpec& vehicle, const TimedPath& timed, double along_m,
               const Vec2& wind_mps, Instant now, Instant time) {
  const auto forecast =
      planning::forecast_arrival({}, vehicle, timed, along_m, wind_mps, now, time);
  if (forecast.astray_m > kAstrayMax_m) return std::numeric_limits<double>::infinity();
  return std::abs(forecast.along_m) / timed.speed_mps;
}

}  // namespace

bool is_untimely(const Ownship& ownship, const TaskFlight& task, Instant now) {
  const VehicleState& state = ownship.state();
  if (now - state.time > kStateAgeMax || now < task.plan.timed.start_time) return false;
  const double expected_s = error_s(ownship.spec(), task.plan.timed, ownship.along_m(),
                                    planning::wind_of(state), now, task.assignment.time);
  return expected_s > kUntimely_s;
}

std::optional<double> timely_speed(const Ownship& ownship, const TaskFlight& task, Instant start) {
  const VehicleSpec& vehicle = ownship.spec();
  const Vec2 wind = planning::wind_of(ownship.state());
  const double ahead_m = ownship.along_m();
  const Instant time = task.assignment.time;
  VehicleSpec careful = vehicle;
  careful.speed_min_mps *= 1.0 + kReserve;
  careful.speed_max_mps *= 1.0 - kReserve;
  const double slowest = std::max(0.5 * vehicle.speed_min_mps, vehicle.speed_min_mps - wind.norm());
  const double fastest = vehicle.speed_max_mps + wind.norm();
  auto self = ownship.candidate(ownship.flight().pose_at(start), start);
  std::optional<double> best;
  double least_s = error_s(vehicle, task.plan.timed, ahead_m, wind, start, time) - kGain_s;
  for (int i = 0; i <= kSpeeds; ++i) {
    const double share = static_cast<double>(i) / kSpeeds;
    for (const double end : {slowest, fastest}) {
      self.speed_mps = vehicle.cruise_speed_mps + share * (end - vehicle.cruise_speed_mps);
      const auto plan = ownship.plan_task(self, start, task.site, task.assignment);
      if (!plan) continue;
      const double error = error_s(careful, plan->timed, ahead_m, wind, start, time);
      if (error >= least_s) continue;
      least_s = error;
      best = self.speed_mps;
    }
    if (best && least_s <= kUntimely_s / 2.0) break;
  }
  return best;
}

}  // namespace skein::mission
