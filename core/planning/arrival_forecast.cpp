// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/arrival_forecast.hpp"

#include <algorithm>
#include <cmath>

namespace skein::planning {
namespace {

constexpr double kStep_s = 0.5;
constexpr int kStepsMax = 1000;

/// Over the ground along that direction, the nose turned into the wind as far as it takes.
double ground_speed(double airspeed_mps, const Vec2& wind, const Vec2& forward) {
  const double across = cross(forward, wind);
  const double left = airspeed_mps * airspeed_mps - across * across;
  return std::max(0.0, wind.dot(forward) + std::sqrt(std::max(left, 0.0)));
}

}  // namespace

Vec2 wind_of(const VehicleState& state) {
  return state.groundspeed_mps * unit_vector(state.course_rad) -
         state.airspeed_mps * unit_vector(state.heading_rad);
}

ArrivalForecast forecast_arrival(const PathFollowerParams& params, const VehicleSpec& vehicle,
                                 const TimedPath& plan, double along_m, const Vec2& wind_mps,
                                 Instant now, Instant until) {
  const double left_s = to_seconds(until - now);
  if (left_s <= 0.0) return {along_m, std::abs(along_m)};
  const int steps =
      static_cast<int>(std::clamp(std::ceil(left_s / kStep_s), 1.0, double{kStepsMax}));
  const double step_s = left_s / steps;
  const double begin_m = plan.distance_at(now);
  const double mean_mps = (plan.distance_at(until) - begin_m) / left_s;  // it may not have begun
  ArrivalForecast forecast{along_m, std::abs(along_m)};
  for (int i = 0; i < steps; ++i) {
    const double even_m = begin_m + i * step_s * mean_mps;
    // With a wind the plan has its own speed everywhere.
    const double planned_m =
        plan.has_wind() ? plan.distance_at(now + from_seconds(i * step_s)) : even_m;
    const double speed_mps = plan.has_wind() ? plan.speed_at_distance(planned_m) : mean_mps;
    const double at_m = planned_m + forecast.along_m;
    const Vec2 forward = unit_vector(plan.pose_at_distance(at_m).heading_rad);
    const double wanted = speed_mps - params.along_track_gain_per_s * forecast.along_m;
    const double flown = std::clamp(wanted, ground_speed(vehicle.speed_min_mps, wind_mps, forward),
                                    ground_speed(vehicle.speed_max_mps, wind_mps, forward));
    forecast.along_m += (flown - speed_mps) * step_s;
    forecast.astray_m = std::max(forecast.astray_m, std::abs(forecast.along_m));
  }
  return forecast;
}

}  // namespace skein::planning
