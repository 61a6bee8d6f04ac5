// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/path_follower.hpp"

#include <algorithm>
#include <cmath>

#include "skein/base/angles.hpp"

namespace skein::planning {

FollowError follow_error(const TimedPath& plan, const VehicleState& state, Instant now) {
  const Pose2 reference = plan.pose_at(now);
  const Vec2 along = unit_vector(reference.heading_rad);
  const Vec2 offset = Vec2{state.x_m, state.y_m} - reference.position();
  return {along.dot(offset), cross(along, offset)};
}

Setpoint follow_path(const PathFollowerParams& params, const VehicleSpec& vehicle,
                     const TimedPath& plan, const VehicleState& state, Instant now) {
  const double distance = plan.distance_at(now);
  const Pose2 reference = plan.pose_at_distance(distance);
  const FollowError error = follow_error(plan, state, now);

  // Over the ground: back to the path at a rate proportional to the distance from it, and faster or
  // slower in proportion to the metres that time is ahead or behind.
  const double course =
      reference.heading_rad - std::atan(params.cross_track_gain_per_m * error.cross_m);
  const double groundspeed = std::max(
      0.5 * plan.speed_mps, plan.speed_mps - params.along_track_gain_per_s * error.along_m);

  // Through the air: less the wind, which is what ground and air velocity differ by.
  const Vec2 wind = state.groundspeed_mps * unit_vector(state.course_rad) -
                    state.airspeed_mps * unit_vector(state.heading_rad);
  const Vec2 through_air = groundspeed * unit_vector(course) - wind;
  const double airspeed =
      std::clamp(through_air.norm(), vehicle.speed_min_mps, vehicle.speed_max_mps);
  const double heading = std::atan2(through_air.y(), through_air.x());

  // The autopilot turns at W (commanded - heading): the turn that the path needs is commanded
  // ahead.
  const double rate_limit = state.airspeed_mps / vehicle.turn_radius_m;
  const double wanted_rate = plan.curvature_at_distance(distance) * groundspeed +
                             vehicle.heading_gain_per_s * wrap_pi(heading - state.heading_rad);
  const double rate = std::clamp(wanted_rate, -rate_limit, rate_limit);
  return {wrap_pi(state.heading_rad + rate / vehicle.heading_gain_per_s), airspeed,
          vehicle.height_m};
}

}  // namespace skein::planning
