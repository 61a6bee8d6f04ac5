// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/path_follower.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "skein/base/angles.hpp"

namespace skein::planning {
namespace {

constexpr double kNearestMax_m = 200.0;  ///< how far along from its time the vehicle is sought
constexpr int kNearestSteps = 4;
constexpr double kBefore_m = 1e-3;   ///< where it is on time, speed and curvature may step
constexpr double kSettled_m = 1e-9;  ///< a step as small as that ends the search
/// Where it is to be on time and leads straight on, it is to be on its course, too: so long before,
/// and so long after, it leans towards its line by no more than that (3 degrees).
constexpr double kLinedUpFor_s = 1.5;
constexpr double kLinedUpAfter_s = 0.5;
constexpr double kLeanMost = 0.05;

/// Where the vehicle is on its path.
struct Nearest {
  double on_time_m = 0.0;  ///< where it is to be
  double ahead_m = 0.0;    ///< of its time
  double left_m = 0.0;
  double heading_rad = 0.0;  ///< of the path there
  Vec2 forward{1.0, 0.0};    ///< the direction of that
  double curvature_per_m = 0.0;
  double curvature_soon_per_m = 0.0;  ///< where it is when a turn begun now is flown
};

/// A pose of the plan, and the direction of its heading.
struct PlanPose {
  Pose2 pose;
  Vec2 forward;
};

/// The plan's poses and curvatures, as TimedPath::pose_at_distance() and curvature_at_distance()
/// and with the same roundings, but from where the pieces begin, and straight ones have one
/// direction.
class PlanPoses {
 public:
  PlanPoses(const TimedPath& plan, const PieceStarts& starts) : plan_{plan}, starts_{starts} {}
  [[nodiscard]] PlanPose at(double distance_m) {
    const auto& segments = plan_.path.segments;
    double left = std::max(distance_m, 0.0);
    std::size_t piece = 0;
    while (piece < segments.size() && left > segments[piece].length_m)
      left -= segments[piece++].length_m;
    if (piece != piece_) forward_.reset();
    piece_ = piece;
    if (piece < segments.size()) return along(segments[piece].curvature_per_m, left);
    if (distance_m <= starts_.length_m()) return along(0.0, 0.0);
    return along(plan_.tail_curvature_per_m, distance_m - starts_.length_m());
  }
  [[nodiscard]] double curvature_at(double distance_m) const {
    return distance_m < starts_.length_m() ? plan_.path.curvature_at(distance_m)
                                           : plan_.tail_curvature_per_m;
  }

 private:
  [[nodiscard]] PlanPose along(double curvature_per_m, double distance_m) {
    const Pose2& start = starts_[piece_];
    if (curvature_per_m == 0.0 && wrap_pi(start.heading_rad) == start.heading_rad) {
      if (!forward_) forward_ = unit_vector(start.heading_rad);
      return {{start.x_m + distance_m * forward_->x(), start.y_m + distance_m * forward_->y(),
               start.heading_rad},
              *forward_};
    }
    const Pose2 pose = advance(start, curvature_per_m, distance_m);
    return {pose, unit_vector(pose.heading_rad)};
  }

  const TimedPath& plan_;
  const PieceStarts& starts_;
  std::size_t piece_ = 0;
  std::optional<Vec2> forward_;  ///< where that begins, once it was asked for
};

Nearest nearest(const TimedPath& plan, const PieceStarts& starts, const Vec2& position, Instant now,
                double lead_m = 0.0) {
  PlanPoses poses{plan, starts};
  const double on_time_m = plan.distance_at(now);
  double distance_m = on_time_m;
  Nearest result;
  for (int step = 0;; ++step) {
    const auto [pose, forward] = poses.at(distance_m);
    const Vec2 offset = position - pose.position();
    result = {
        on_time_m, distance_m - on_time_m,        left_of(forward).dot(offset), pose.heading_rad,
        forward,   poses.curvature_at(distance_m)};
    // Along an arc the same angle is a shorter way for who flies inside it.
    const double scale = std::max(0.5, 1.0 - result.curvature_per_m * result.left_m);
    const double moved_m = distance_m + forward.dot(offset) / scale;
    const double low_m = std::max(0.0, on_time_m - kNearestMax_m);
    const double next_m = std::clamp(moved_m, low_m, on_time_m + kNearestMax_m);
    if (step == kNearestSteps || std::abs(next_m - distance_m) < kSettled_m) break;
    distance_m = next_m;
  }
  result.curvature_soon_per_m = poses.curvature_at(distance_m + lead_m);
  return result;
}

/// The airspeed that the plan takes there.
double planned_airspeed(const TimedPath& plan, PlanPoses& poses, double distance_m,
                        const Vec2& wind_mps) {
  return (plan.speed_at_distance(distance_m) * poses.at(distance_m).forward - wind_mps).norm();
}

/// By how much the plan's airspeed rises until what is commanded now is flown: begun so much
/// earlier, a change of it costs no way in the end. Nothing is seen beyond where the plan is to be
/// on time, from where another leads on (a run from a gate, a way from a site), nor of its hold,
/// which is there for want of another plan.
double airspeed_rise(const TimedPath& plan, const PieceStarts& starts, double on_time_m,
                     const Vec2& wind_mps, double lead_s) {
  PlanPoses poses{plan, starts};
  const double now_mps = planned_airspeed(plan, poses, on_time_m, wind_mps);
  const double soon_m = on_time_m + lead_s * plan.speed_at_distance(on_time_m);
  const bool is_timed = on_time_m < plan.on_time_m;
  const double end_m = is_timed ? plan.on_time_m - kBefore_m : starts.length_m();
  const double seen_m = std::max(on_time_m, std::min(soon_m, end_m));
  return planned_airspeed(plan, poses, seen_m, wind_mps) - now_mps;
}

/// How steeply it may lean towards its line there, of the path.
double lean_most(const TimedPath& plan, const PieceStarts& starts, double distance_m,
                 double speed_mps) {
  const double to_go_s = (plan.on_time_m - distance_m) / std::max(1.0, speed_mps);
  const double beyond_m = plan.on_time_m + kBefore_m;
  const bool lines_up = plan.on_time_m > 0.0 && to_go_s < kLinedUpFor_s &&
                        to_go_s > -kLinedUpAfter_s &&
                        (beyond_m >= starts.length_m() || plan.path.curvature_at(beyond_m) == 0.0);
  return lines_up ? kLeanMost : std::numeric_limits<double>::infinity();
}

/// The most airspeed at that turn rate; cruise speed always may be flown.
double turning_speed(const PathFollowerParams& params, const VehicleSpec& vehicle,
                     double rate_radps) {
  const double cruise = vehicle.cruise_speed_mps;
  if (rate_radps == 0.0) return vehicle.speed_max_mps;
  return std::max(
      cruise, params.turn_share * cruise * cruise / (vehicle.turn_radius_m * std::abs(rate_radps)));
}

}  // namespace

PieceStarts::PieceStarts(const Path& path) : length_m_{path.length_m()} {
  poses_.push_back(path.start);
  for (const Segment& s : path.segments) {
    poses_.push_back(advance(poses_.back(), s.curvature_per_m, s.length_m));
  }
}

Setpoint follow_path(const PathFollowerParams& params, const VehicleSpec& vehicle,
                     const TimedPath& plan, const PieceStarts& starts, const VehicleState& state,
                     Instant now) {
  const Nearest at = nearest(plan, starts, {state.x_m, state.y_m}, now,
                             params.turn_lead_s * state.groundspeed_mps);
  const Vec2 over_ground = state.groundspeed_mps * unit_vector(state.course_rad);
  const Vec2 wind = over_ground - state.airspeed_mps * unit_vector(state.heading_rad);

  // Course: towards the path, the steeper the farther.
  const double leans = params.cross_track_gain_per_m * at.left_m;
  const double most = lean_most(plan, starts, at.on_time_m + at.ahead_m, state.groundspeed_mps);
  const double lean = std::clamp(leans, -most, most);
  const double course = at.heading_rad - std::atan(lean);
  const double closing_mps = over_ground.dot(left_of(at.forward));
  const double along_mps =
      over_ground.dot(at.forward) / std::max(0.5, 1.0 - at.curvature_per_m * at.left_m);
  const double leaning_rate =
      lean == leans ? params.cross_track_gain_per_m * closing_mps / (1.0 + lean * lean) : 0.0;
  const double course_rate = at.curvature_soon_per_m * along_mps - leaning_rate;

  // Velocity over the ground, and the velocity through the air that gives it.
  const double ground_mps = std::max(
      0.0, plan.speed_at_distance(at.on_time_m) - params.along_track_gain_per_s * at.ahead_m);
  const Vec2 wanted = ground_mps * unit_vector(course);
  const Vec2 wanted_rate = course_rate * left_of(wanted);
  const Vec2 through_air = wanted - wind;
  const double air_mps = through_air.norm();
  Setpoint setpoint{state.heading_rad, vehicle.speed_min_mps, vehicle.height_m};
  if (air_mps < 1.0) return setpoint;

  const double rise_mps = airspeed_rise(plan, starts, at.on_time_m, wind, params.airspeed_lead_s);
  const double most_mps =
      std::min(vehicle.speed_max_mps,
               turning_speed(params, vehicle, at.curvature_per_m * state.groundspeed_mps));
  setpoint.airspeed_mps = std::clamp(air_mps + rise_mps, vehicle.speed_min_mps, most_mps);
  // The heading loop d heading/dt = W (commanded - heading) is inverted; its rate keeps within
  // what the turn radius allows.
  const double heading_rate = cross(through_air, wanted_rate) / (air_mps * air_mps);
  const double error = wrap_pi(std::atan2(through_air.y(), through_air.x()) - state.heading_rad);
  const double rate_max = state.airspeed_mps / vehicle.turn_radius_m;
  const double gain = std::min(vehicle.heading_gain_per_s, params.heading_gain_most_per_s);
  const double rate = std::clamp(gain * error + heading_rate, -rate_max, rate_max);
  setpoint.heading_rad = wrap_pi(state.heading_rad + rate / vehicle.heading_gain_per_s);
  return setpoint;
}

FollowError follow_error(const TimedPath& plan, const PieceStarts& starts,
                         const VehicleState& state, Instant now) {
  const Nearest at = nearest(plan, starts, {state.x_m, state.y_m}, now);
  return {at.ahead_m, at.left_m};
}

}  // namespace skein::planning
