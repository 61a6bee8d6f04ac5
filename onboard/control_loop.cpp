// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/control_loop.hpp"

namespace skein::onboard {

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
  if (const auto* newer = ports_->guidance.read()) {
    guidance_.emplace(*newer);
    if (const auto* plan = std::get_if<mission::FlightPlan>(newer)) {
      ports_->plans.push({plan->number, now, plan->timed});
    }
  }
  const auto state = flight_controller_->state(now);
  ports_->airborne.store(flight_controller_->airborne(), std::memory_order_relaxed);
  if (!state || now - state->time > mission::kFlightControllerSilence) {
    ports_->stale_states.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  ports_->state.write(*state);
  if (guidance_) {
    flight_controller_->command(mission::follow(*guidance_, follower_, vehicle_, *state, now), now);
  }
  // What a silent flight controller has told before is recorded once.
  if (now >= next_track_ && state->time > recorded_) {
    recorded_ = state->time;
    recording::TrackPoint point{.state = *state};
    if (guidance_) {
      const auto off = mission::deviation(*guidance_, vehicle_, *state, now);
      point.plan_number = off.number;
      point.along_error_m = off.along_error_m;
      point.cross_error_m = off.cross_error_m;
    }
    ports_->track.push(point);
    // Aligned to the period, so that a late step does not shift those that follow.
    next_track_ = next_multiple(now, kTrackPeriod);
  }
}

}  // namespace skein::onboard
