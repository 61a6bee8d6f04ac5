// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/control_loop.hpp"

namespace skein::onboard {

namespace {

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

std::uint32_t PeriodicSchedule::advance(Instant now) {
  next_ += period_;
  if (now < next_) return 0;
  const auto missed = (now - next_) / period_;
  next_ += missed * period_;
  return static_cast<std::uint32_t>(missed);
}

ControlLoop::ControlLoop(const VehicleSpec& vehicle, hal::FlightController& flight_controller,
                         ControlPorts& ports, const planning::PathFollowerParams& follower)
    : vehicle_{vehicle},
      follower_{follower},
      flight_controller_{&flight_controller},
      ports_{&ports} {}

void ControlLoop::step(Instant now) {
  ports_->periods.fetch_add(1, std::memory_order_relaxed);
  if (const auto* newer = ports_->plan.read()) {
    plan_ = *newer;
    has_plan_ = true;
    ports_->plans.push({plan_.number, now, plan_.timed});
  }
  if (const auto* newer = ports_->motion.read()) {
    motion_ = *newer;
    has_motion_ = true;
  }
  const auto state = flight_controller_->state(now);
  if (!state || now - state->time > kStateAgeMax) {
    ports_->stale_states.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  ports_->state.write(*state);
  if (has_plan_) {
    flight_controller_->command(
        planning::follow_path(follower_, vehicle_, plan_.timed, *state, now), now);
  }
  if (has_motion_) flight_controller_->command(setpoint_on(motion_, now), now);
  // What a silent flight controller has told before is recorded once.
  if (now >= next_track_ && state->time > recorded_) {
    recorded_ = state->time;
    recording::TrackPoint point{.state = *state};
    if (has_plan_) {
      const auto error = planning::follow_error(plan_.timed, *state, now);
      point.plan_number = plan_.number;
      point.along_error_m = error.along_m;
      point.cross_error_m = error.cross_m;
    }
    if (has_motion_) {
      const Vec3 at{state->x_m, state->y_m, state->z_m};
      const Vec3 off = at - motion_.at(state->time).position_m;
      point.plan_number = motion_.number;
      point.cross_error_m = off.norm();
    }
    ports_->track.push(point);
    // Aligned to the period, so that a late step does not shift those that follow.
    next_track_ = Instant{(now.time_since_epoch() / kTrackPeriod + 1) * kTrackPeriod};
  }
}

}  // namespace skein::onboard
