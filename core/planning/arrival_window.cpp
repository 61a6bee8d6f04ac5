// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/arrival_window.hpp"

#include <algorithm>
#include <cmath>

#include "skein/base/geometry.hpp"
#include "skein/planning/path_follower.hpp"

namespace skein::planning {
namespace {

constexpr double kStep_m = 20.0;
constexpr int kStepsMax = 1000;
/// Against a wind that is stronger than it flies, a vehicle arrives after a very long time.
constexpr double kLeast_mps = 0.1;

/// Over the ground along that direction, the nose turned into the wind as far as it takes.
double ground_speed(double airspeed_mps, const Vec2& wind, const Vec2& forward) {
  const double across = cross(forward, wind);
  const double left = airspeed_mps * airspeed_mps - across * across;
  return std::max(kLeast_mps, wind.dot(forward) + std::sqrt(std::max(left, 0.0)));
}

}  // namespace

ArrivalWindow arrival_window(const VehicleSpec& vehicle, const TimedPath& plan,
                             const VehicleState& state, double distance_m, Instant now) {
  const double at_m = plan.distance_at(now) + follow_error(plan, state, now).along_m;
  const double left_m = distance_m - at_m;
  if (left_m <= 0.0) return {now, now};
  const Vec2 wind = state.groundspeed_mps * unit_vector(state.course_rad) -
                    state.airspeed_mps * unit_vector(state.heading_rad);
  const int steps = std::clamp(static_cast<int>(std::ceil(left_m / kStep_m)), 1, kStepsMax);
  const double step_m = left_m / steps;
  double fast_s = 0.0;
  double slow_s = 0.0;
  for (int i = 0; i < steps; ++i) {
    const Vec2 forward = unit_vector(plan.pose_at_distance(at_m + (i + 0.5) * step_m).heading_rad);
    fast_s += step_m / ground_speed(vehicle.speed_max_mps, wind, forward);
    slow_s += step_m / ground_speed(vehicle.speed_min_mps, wind, forward);
  }
  return {now + from_seconds(fast_s), now + from_seconds(slow_s)};
}

}  // namespace skein::planning
