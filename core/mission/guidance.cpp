// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/guidance.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace skein::mission {
namespace {

/// A copter that is farther from its height does not fly its plan: a pilot has had it.
constexpr double kLayer_m = 5.0;

static_assert(std::is_trivially_copyable_v<Guidance> && std::is_trivially_copyable_v<Demand> &&
              std::is_trivially_copyable_v<HeldGuidance>);

PositionSetpoint setpoint_on(const MotionTrack& track, Instant now) {
  const MotionTrack::Moment moment = track.at(now);
  PositionSetpoint setpoint;
  setpoint.x_m = moment.position_m.x();
  setpoint.y_m = moment.position_m.y();
  setpoint.z_m = moment.position_m.z();
  setpoint.vx_mps = moment.velocity_mps.x();
  setpoint.vy_mps = moment.velocity_mps.y();
  setpoint.vz_mps = moment.velocity_mps.z();
  setpoint.ax_mps2 = moment.acceleration_mps2.x();
  setpoint.ay_mps2 = moment.acceleration_mps2.y();
  setpoint.az_mps2 = moment.acceleration_mps2.z();
  setpoint.yaw_rad = track.yaw_rad;
  return setpoint;
}

/// Up or down, m/s.
double height_rate_mps(const FlightPlan& plan, Instant at) {
  const double from_m = height_offset_m(plan, at);
  if (from_m == plan.height_to_m || at < plan.height_since) return 0.0;
  return plan.height_to_m > from_m ? kHeightRate_mps : -kHeightRate_mps;
}

/// The path's point at `now`: velocity along it, acceleration towards the centre of its arc.
PositionSetpoint setpoint_on(const FlightPlan& plan, const VehicleSpec& vehicle, Instant now) {
  const TimedPath& path = plan.timed;
  const double distance_m = path.distance_at(now);
  const Pose2 pose = path.pose_at_distance(distance_m);
  const double speed_mps = now < path.start_time ? 0.0 : path.speed_mps;
  const Vec2 velocity = speed_mps * unit_vector(pose.heading_rad);
  const Vec2 acceleration = speed_mps * path.curvature_at_distance(distance_m) * left_of(velocity);
  PositionSetpoint setpoint;
  setpoint.x_m = pose.x_m;
  setpoint.y_m = pose.y_m;
  setpoint.z_m = vehicle.height_m + height_offset_m(plan, now);
  setpoint.vx_mps = velocity.x();
  setpoint.vy_mps = velocity.y();
  setpoint.vz_mps = height_rate_mps(plan, now);
  setpoint.ax_mps2 = acceleration.x();
  setpoint.ay_mps2 = acceleration.y();
  setpoint.yaw_rad = pose.heading_rad;
  return setpoint;
}

/// Straight up or down to its height: there alone it is clear of vehicles in other layers.
PositionSetpoint back_to_height(double height_m, const VehicleState& state) {
  PositionSetpoint setpoint;
  setpoint.x_m = state.x_m;
  setpoint.y_m = state.y_m;
  setpoint.z_m = height_m;
  setpoint.yaw_rad = state.heading_rad;
  return setpoint;
}

/// Followed without the way that a state has made since it was measured, as by a copter.
Deviation off_track(const MotionTrack& track, const VehicleState& state) {
  const Vec3 off = state.position().metres() - track.at(state.time).position_m;
  return {track.number, 0.0, off.norm()};
}

Deviation off_point(const FlightPlan& plan, const VehicleState& state) {
  const Pose2 pose = plan.timed.pose_at(state.time);
  const Vec2 forward = unit_vector(pose.heading_rad);
  const Vec2 off = Vec2{state.x_m, state.y_m} - pose.position();
  return {plan.number, forward.dot(off), left_of(forward).dot(off)};
}

}  // namespace

double height_offset_m(const FlightPlan& plan, Instant at) {
  const double way_m = plan.height_to_m - plan.height_from_m;
  const double done_m = kHeightRate_mps * std::max(0.0, to_seconds(at - plan.height_since));
  if (done_m >= std::abs(way_m)) return plan.height_to_m;
  return plan.height_from_m + std::copysign(done_m, way_m);
}

HeldGuidance::HeldGuidance(const Guidance& held) : guidance{held} {
  if (const auto* plan = std::get_if<FlightPlan>(&guidance)) starts.emplace(plan->timed.path);
}

Demand follow(const HeldGuidance& held, const planning::PathFollowerParams& params,
              const VehicleSpec& vehicle, const VehicleState& state, Instant now) {
  if (const auto* track = std::get_if<MotionTrack>(&held.guidance)) return setpoint_on(*track, now);
  const auto& plan = std::get<FlightPlan>(held.guidance);
  if (vehicle.is_copter()) {
    const double height_m = vehicle.height_m + height_offset_m(plan, now);
    const bool in_layer = std::abs(state.z_m - height_m) <= kLayer_m;
    return in_layer ? setpoint_on(plan, vehicle, now) : back_to_height(height_m, state);
  }
  Setpoint setpoint = planning::follow_path(params, vehicle, plan.timed, *held.starts, state, now);
  setpoint.height_m += height_offset_m(plan, now);
  if (plan.lands) setpoint.landing = plan.landing;
  return setpoint;
}

Deviation deviation(const HeldGuidance& held, const VehicleSpec& vehicle, const VehicleState& state,
                    Instant now) {
  if (const auto* track = std::get_if<MotionTrack>(&held.guidance)) return off_track(*track, state);
  const auto& plan = std::get<FlightPlan>(held.guidance);
  if (vehicle.is_copter()) return off_point(plan, state);
  const auto error = planning::follow_error(plan.timed, *held.starts, state, now);
  return {plan.number, error.along_m, error.cross_m};
}

}  // namespace skein::mission
