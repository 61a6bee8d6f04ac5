// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/guidance.hpp"

#include <type_traits>

namespace skein::mission {
namespace {

static_assert(std::is_trivially_copyable_v<Guidance> && std::is_trivially_copyable_v<Demand>);

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

}  // namespace

Demand follow(const Guidance& guidance, const planning::PathFollowerParams& params,
              const VehicleSpec& vehicle, const VehicleState& state, Instant now) {
  if (const auto* track = std::get_if<MotionTrack>(&guidance)) return setpoint_on(*track, now);
  return planning::follow_path(params, vehicle, std::get<FlightPlan>(guidance).timed, state, now);
}

Deviation deviation(const Guidance& guidance, const VehicleState& state, Instant now) {
  if (const auto* track = std::get_if<MotionTrack>(&guidance)) {
    // A track is followed without the way that a state has made since it was measured.
    const Vec3 off = state.position().metres() - track->at(state.time).position_m;
    return {track->number, 0.0, off.norm()};
  }
  const auto& plan = std::get<FlightPlan>(guidance);
  const auto error = planning::follow_error(plan.timed, state, now);
  return {plan.number, error.along_m, error.cross_m};
}

}  // namespace skein::mission
