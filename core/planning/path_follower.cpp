// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/path_follower.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "skein/base/angles.hpp"

namespace skein::planning {
namespace {

constexpr double kAirspeedTime_s = 1.0;  ///< of the autopilot's airspeed loop, to be inverted
constexpr double kNearestMax_m = 200.0;  ///< how far along from its time the vehicle is sought
constexpr int kNearestSteps = 4;
constexpr double kSettled_m = 1e-9;  ///< a step as small as that ends the search

/// Where the vehicle is on its path.
struct Nearest {
  double on_time_m = 0.0;  ///< where it is to be
  double ahead_m = 0.0;    ///< of its time
  double left_m = 0.0;
  double heading_rad = 0.0;  ///< of the path there
  double curvature_per_m = 0.0;
  double curvature_soon_per_m = 0.0;  ///< where it is when a turn begun now is flown
};

/// A pose of the plan, and the direction of its heading.
struct PlanPose {
  Pose2 pose;
  Vec2 forward;
};

/// The plan's poses, as TimedPath::pose_at_distance() and with the same roundings, but pieces that
/// lie before all that is asked for are integrated once, and straight ones have one direction.
class PlanPoses {
 public:
  explicit PlanPoses(const TimedPath& plan)
      : plan_{plan}, length_m_{plan.path.length_m()}, start_{plan.path.start} {}
  [[nodiscard]] PlanPose at(double distance_m) {
    const auto& segments = plan_.path.segments;
    double left = std::max(distance_m, 0.0);
    std::size_t piece = 0;
    while (piece < segments.size() && left > segments[piece].length_m)
      left -= segments[piece++].length_m;
    go_to(piece);
    if (piece < segments.size()) return along(segments[piece].curvature_per_m, left);
    if (distance_m <= length_m_) return along(0.0, 0.0);
    return along(plan_.tail_curvature_per_m, distance_m - length_m_);
  }

 private:
  [[nodiscard]] PlanPose along(double curvature_per_m, double distance_m) {
    if (curvature_per_m == 0.0 && wrap_pi(start_.heading_rad) == start_.heading_rad) {
      if (!forward_) forward_ = unit_vector(start_.heading_rad);
      return {{start_.x_m + distance_m * forward_->x(), start_.y_m + distance_m * forward_->y(),
               start_.heading_rad},
              *forward_};
    }
    const Pose2 pose = advance(start_, curvature_per_m, distance_m);
    return {pose, unit_vector(pose.heading_rad)};
  }
  void go_to(std::size_t piece) {
    if (piece == piece_) return;
    forward_.reset();
    if (piece < piece_) {
      piece_ = 0;
      start_ = plan_.path.start;
    }
    for (; piece_ < piece; ++piece_) {
      const Segment& passed = plan_.path.segments[piece_];
      start_ = advance(start_, passed.curvature_per_m, passed.length_m);
    }
  }

  const TimedPath& plan_;
  double length_m_;
  std::size_t piece_ = 0;
  Pose2 start_;                  ///< of that piece
  std::optional<Vec2> forward_;  ///< there, once it was asked for
};

Nearest nearest(const TimedPath& plan, const Vec2& position, Instant now, double lead_m = 0.0) {
  PlanPoses poses{plan};
  const double on_time_m = plan.distance_at(now);
  double distance_m = on_time_m;
  Nearest result;
  for (int step = 0; step <= kNearestSteps; ++step) {
    const auto [pose, forward] = poses.at(distance_m);
    const Vec2 offset = position - pose.position();
    result = {on_time_m,
              distance_m - on_time_m,
              left_of(forward).dot(offset),
              pose.heading_rad,
              plan.curvature_at_distance(distance_m),
              plan.curvature_at_distance(distance_m + lead_m)};
    // Along an arc the same angle is a shorter way for who flies inside it.
    const double scale = std::max(0.5, 1.0 - result.curvature_per_m * result.left_m);
    const double moved_m = distance_m + forward.dot(offset) / scale;
    const double low_m = std::max(0.0, on_time_m - kNearestMax_m);
    const double next_m = std::clamp(moved_m, low_m, on_time_m + kNearestMax_m);
    if (std::abs(next_m - distance_m) < kSettled_m) break;
    distance_m = next_m;
  }
  return result;
}

/// The plan's speed when what is commanded now is flown: begun so much earlier, a step of it costs
/// no way in the end.
double speed_soon(const TimedPath& plan, double on_time_m) {
  const double lead_m = plan.speed_at_distance(on_time_m) * kAirspeedTime_s;
  return plan.speed_at_distance(on_time_m + lead_m);
}

}  // namespace

Setpoint follow_path(const PathFollowerParams& params, const VehicleSpec& vehicle,
                     const TimedPath& plan, const VehicleState& state, Instant now) {
  const Nearest at =
      nearest(plan, {state.x_m, state.y_m}, now, params.turn_lead_s * state.groundspeed_mps);
  const Vec2 over_ground = state.groundspeed_mps * unit_vector(state.course_rad);
  const Vec2 wind = over_ground - state.airspeed_mps * unit_vector(state.heading_rad);

  // Course: towards the path, the steeper the farther.
  const double lean = params.cross_track_gain_per_m * at.left_m;
  const double course = at.heading_rad - std::atan(lean);
  const double closing_mps = over_ground.dot(left_of(unit_vector(at.heading_rad)));
  const double along_mps = over_ground.dot(unit_vector(at.heading_rad)) /
                           std::max(0.5, 1.0 - at.curvature_per_m * at.left_m);
  const double course_rate = at.curvature_soon_per_m * along_mps -
                             params.cross_track_gain_per_m * closing_mps / (1.0 + lean * lean);

  // Velocity over the ground, and the velocity through the air that gives it.
  const double ground_mps =
      std::max(0.0, speed_soon(plan, at.on_time_m) - params.along_track_gain_per_s * at.ahead_m);
  const Vec2 wanted = ground_mps * unit_vector(course);
  const Vec2 wanted_rate = course_rate * left_of(wanted);
  const Vec2 through_air = wanted - wind;
  const double air_mps = through_air.norm();
  Setpoint setpoint{state.heading_rad, vehicle.speed_min_mps, vehicle.height_m};
  if (air_mps < 1.0) return setpoint;

  const double air_rate = through_air.dot(wanted_rate) / air_mps;
  setpoint.airspeed_mps = std::clamp(air_mps + kAirspeedTime_s * air_rate, vehicle.speed_min_mps,
                                     vehicle.speed_max_mps);
  // The heading loop d heading/dt = W (commanded - heading) is inverted; its rate keeps within
  // what the turn radius allows.
  const double heading_rate = cross(through_air, wanted_rate) / (air_mps * air_mps);
  const double error = wrap_pi(std::atan2(through_air.y(), through_air.x()) - state.heading_rad);
  const double rate_max = state.airspeed_mps / vehicle.turn_radius_m;
  const double rate =
      std::clamp(vehicle.heading_gain_per_s * error + heading_rate, -rate_max, rate_max);
  setpoint.heading_rad = wrap_pi(state.heading_rad + rate / vehicle.heading_gain_per_s);
  return setpoint;
}

FollowError follow_error(const TimedPath& plan, const VehicleState& state, Instant now) {
  const Nearest at = nearest(plan, {state.x_m, state.y_m}, now);
  return {at.ahead_m, at.left_m};
}

}  // namespace skein::planning
