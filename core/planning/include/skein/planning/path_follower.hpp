// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>

#include "skein/base/static_vector.hpp"
#include "skein/domain/path.hpp"
#include "skein/domain/vehicle.hpp"

namespace skein::planning {

struct PathFollowerParams {
  double cross_track_gain_per_m = 0.01;  ///< tuned in path_follower_test
  double along_track_gain_per_s = 0.3;   ///< metres behind to m/s faster
  double turn_lead_s = 0.0;      ///< turns are begun so much earlier: the time that rolling takes
  double airspeed_lead_s = 1.0;  ///< lag of the autopilot's airspeed loop, to be inverted
  /// Errors of the heading are taken back at that rate, or at the vehicle's own if it is lower: an
  /// aircraft answers late, and one that is asked for more swings.
  double heading_gain_most_per_s = std::numeric_limits<double>::infinity();
  /// An aircraft that banks turns at cruise_speed^2 / turn_radius at most, so the wider the faster
  /// it is: in turns it gets no faster than where they take this share of that, to make up for time
  /// later. Not of one whose turns have one radius at any speed.
  double turn_share = std::numeric_limits<double>::infinity();
};

/// How the vehicle stands to its plan, for reports.
struct FollowError {
  double along_m = 0.0;  ///< positive when ahead of time
  double cross_m = 0.0;  ///< positive when left of the path
};

/// Where the pieces of a path begin, as Path::pose_at() has it: worked out once for a path that is
/// followed for many control periods. Trivially copyable.
class PieceStarts {
 public:
  explicit PieceStarts(const Path& path);
  /// The path's end where `piece` is the number of pieces, which is the most that it may be.
  [[nodiscard]] const Pose2& operator[](std::size_t piece) const { return poses_[piece]; }
  [[nodiscard]] double length_m() const { return length_m_; }

 private:
  StaticVector<Pose2, kPathSegmentsMax + 1> poses_;
  double length_m_ = 0.0;
};

/// Control of a planned path to its times, for one control period: the heading and airspeed to
/// command so that the vehicle is at plan.pose_at(now). Turn commands respect the vehicle's turn
/// radius and heading dynamics, airspeed its limits; wind is estimated from the difference of
/// velocity over the ground and through the air. Pure: no state, no allocation, no clock; bounded
/// time. `starts` are those of the plan's path.
[[nodiscard]] Setpoint follow_path(const PathFollowerParams& params, const VehicleSpec& vehicle,
                                   const TimedPath& plan, const PieceStarts& starts,
                                   const VehicleState& state, Instant now);
[[nodiscard]] inline Setpoint follow_path(const PathFollowerParams& params,
                                          const VehicleSpec& vehicle, const TimedPath& plan,
                                          const VehicleState& state, Instant now) {
  return follow_path(params, vehicle, plan, PieceStarts{plan.path}, state, now);
}
[[nodiscard]] FollowError follow_error(const TimedPath& plan, const PieceStarts& starts,
                                       const VehicleState& state, Instant now);
[[nodiscard]] inline FollowError follow_error(const TimedPath& plan, const VehicleState& state,
                                              Instant now) {
  return follow_error(plan, PieceStarts{plan.path}, state, now);
}

}  // namespace skein::planning
