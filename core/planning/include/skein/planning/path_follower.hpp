// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/domain/path.hpp"
#include "skein/domain/vehicle.hpp"

namespace skein::planning {

struct PathFollowerParams {
  double cross_track_gain_per_m = 0.01;  ///< tuned in path_follower_test
  double along_track_gain_per_s = 0.3;   ///< metres behind to m/s faster
  double turn_lead_s = 0.0;  ///< turns are begun so much earlier: the time that rolling takes
};

/// How the vehicle stands to its plan, for reports.
struct FollowError {
  double along_m = 0.0;  ///< positive when ahead of time
  double cross_m = 0.0;  ///< positive when left of the path
};

/// Control of a planned path to its times, for one control period: the heading and airspeed to
/// command so that the vehicle is at plan.pose_at(now). Turn commands respect the vehicle's turn
/// radius and heading dynamics, airspeed its limits; wind is estimated from the difference of
/// velocity over the ground and through the air. Pure: no state, no allocation, no clock; bounded
/// time.
[[nodiscard]] Setpoint follow_path(const PathFollowerParams& params, const VehicleSpec& vehicle,
                                   const TimedPath& plan, const VehicleState& state, Instant now);
[[nodiscard]] FollowError follow_error(const TimedPath& plan, const VehicleState& state,
                                       Instant now);

}  // namespace skein::planning
