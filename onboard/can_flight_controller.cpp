// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/can_flight_controller.hpp"

#include <poll.h>

#include <ctime>

namespace skein::onboard {

std::optional<VehicleState> CanFlightController::state(Instant now) {
  if (const auto* newer = sample_.read()) newest_ = *newer;
  if (!newest_) return std::nullopt;
  return ardupilot::carried_to(*newest_, now);
}

void CanFlightController::command(const Setpoint& setpoint, Instant now) {
  command_.write({setpoint, now});
}

void CanFlightController::step(Instant now) {
  if (const auto* newer = command_.read()) {
    link_.companion().command(newer->setpoint, newer->at);
  }
  if (resume_.exchange(false, std::memory_order_acq_rel)) (void)link_.companion().resume(now);
  link_.step(now);
  if (const auto sample = link_.companion().sample()) sample_.write(*sample);
  while (auto notice = link_.companion().poll_notice()) notices_.push(std::move(*notice));
}

void CanFlightController::wait(Duration at_most) const {
  // What the kernel had no room for is offered to it again soon.
  const Duration most =
      link_.bus().pending() > 0 ? Duration{std::chrono::milliseconds{1}} : at_most;
  const timespec timeout{.tv_sec = 0, .tv_nsec = static_cast<long>(most.count())};
  pollfd item{link_.bus().descriptor(), POLLIN, 0};
  (void)::ppoll(&item, 1, &timeout, nullptr);
}

}  // namespace skein::onboard
