// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "skein/planning/arrival_forecast.hpp"
#include "vehicle_agent_impl.hpp"

namespace skein::mission {
namespace {
constexpr Duration kLookPeriod = std::chrono::seconds{1};
/// Nearer to its time a new path would gain little.
constexpr Duration kLookLatest = std::chrono::seconds{5};
constexpr Duration kStateAgeMax = std::chrono::seconds{1};
constexpr Duration kLead = std::chrono::milliseconds{200};  ///< for control to take it over
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

/// Control keeps the time by speed. Where the wind takes more than that has, another path keeps it:
/// at a speed over the ground that the wind lets it have, as long or short as that makes it.
void VehicleAgent::Impl::keep_time(Instant now) {
  if (config_.vehicle.is_copter()) return;  // flown by position: on time wherever it can be at all
  const Instant time = task_->assignment.time;
  if (task_->in_run() || now < time_again_ || time - now < kLookLatest) return;
  time_again_ = now + kLookPeriod;
  if (now - state_.time > kStateAgeMax || now < task_->plan.timed.start_time) return;
  const double along_m = planning::follow_error(flight_.plan().timed, state_, state_.time).along_m;
  const double expected_s =
      error_s(config_.vehicle, task_->plan.timed, along_m, planning::wind_of(state_), now, time);
  if (expected_s <= kUntimely_s) return;
  const Instant start = now + kLead;
  if (const auto speed_mps = speed_for(*task_, along_m, start)) {
    const auto outcome = set_out(*task_, *speed_mps, start, now);
    if (const auto* task = std::get_if<TaskFlight>(&outcome)) {
      task_ = *task;
      report(event::PlanRetimed{*speed_mps}, task_->round, task_->assignment.task, now);
      return;
    }
  }
  if (std::exchange(task_->untimely, true)) return;
  report(event::VehicleTrouble{event::Trouble::untimely}, task_->round, task_->assignment.task,
         now);
}

/// The speed over the ground nearest to cruise speed at which a path from where it is at `start` is
/// on time; without one, the best, where that gains enough.
std::optional<double> VehicleAgent::Impl::speed_for(const TaskFlight& task, double along_m,
                                                    Instant start) const {
  const auto& vehicle = config_.vehicle;
  const Vec2 wind = planning::wind_of(state_);
  const Instant time = task.assignment.time;
  VehicleSpec careful = vehicle;
  careful.speed_min_mps *= 1.0 + kReserve;
  careful.speed_max_mps *= 1.0 - kReserve;
  const double slowest = std::max(0.5 * vehicle.speed_min_mps, vehicle.speed_min_mps - wind.norm());
  const double fastest = vehicle.speed_max_mps + wind.norm();
  auto self = candidate(flight_.pose_at(start), start);
  std::optional<double> best;
  double least_s = error_s(vehicle, task.plan.timed, along_m, wind, start, time) - kGain_s;
  for (int i = 0; i <= kSpeeds; ++i) {
    const double share = static_cast<double>(i) / kSpeeds;
    for (const double end : {slowest, fastest}) {
      self.speed_mps = vehicle.cruise_speed_mps + share * (end - vehicle.cruise_speed_mps);
      const auto plan =
          planning::plan_task(config_.planning, self, start, task.site, task.assignment, hazards_);
      if (!plan) continue;
      const double error = error_s(careful, plan->timed, along_m, wind, start, time);
      if (error >= least_s) continue;
      least_s = error;
      best = self.speed_mps;
    }
    if (best && least_s <= kUntimely_s / 2.0) break;
  }
  return best;
}

}  // namespace skein::mission
