// SPDX-License-Identifier: Apache-2.0
#include "skein/hal/simulated_flight_controller.hpp"

#include <algorithm>

namespace skein::hal {

SimulatedFlightController::SimulatedFlightController(const VehicleSpec& vehicle, const Pose2& start,
                                                     const models::WindParams& wind, Instant from)
    : from_{from}, model_{vehicle, models::Wind{wind}, start, from} {}

void SimulatedFlightController::advance_to(Instant now) {
  if (now > model_.state().time) model_.advance_to(now);
}

std::optional<VehicleState> SimulatedFlightController::state(Instant now) {
  advance_to(now);
  VehicleState state = model_.state();
  state.time = std::min(now, state.time);  // at rest before `from`, yet not out of date
  return state;
}

void SimulatedFlightController::command(const Demand& demand, Instant now) {
  const auto* setpoint = std::get_if<Setpoint>(&demand);
  if (setpoint == nullptr) return;
  advance_to(now);  // the setpoint before this one stood until now
  model_.command(*setpoint);
}

}  // namespace skein::hal
