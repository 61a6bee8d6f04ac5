// SPDX-License-Identifier: Apache-2.0
#include "skein/hal/simulated_flight_controller.hpp"

#include <algorithm>

namespace skein::hal {
namespace {

constexpr double kSink_mps = 5.0;
constexpr double kGround_m = 0.0;      ///< the origin's height
constexpr double kHeightTime_s = 3.0;  ///< the lag of the model's height
constexpr Duration kSinkStep = std::chrono::milliseconds{20};

}  // namespace

SimulatedFlightController::SimulatedFlightController(const VehicleSpec& vehicle, const Pose2& start,
                                                     const models::WindParams& wind, Instant from)
    : from_{from}, model_{vehicle, models::Wind{wind}, start, from} {}

void SimulatedFlightController::advance_to(Instant now) {
  if (landed_ || now <= model_.state().time) return;
  if (!landing_) return model_.advance_to(now);
  Setpoint down = *landing_;
  while (model_.state().time < now && !landed_) {
    const Duration step = std::min(kSinkStep, now - model_.state().time);
    down.height_m = model_.state().z_m - kSink_mps * kHeightTime_s;
    model_.command(down);
    model_.advance_to(model_.state().time + step);
    landed_ = model_.state().z_m <= kGround_m;
  }
}

std::optional<VehicleState> SimulatedFlightController::state(Instant now) {
  advance_to(now);
  VehicleState state = model_.state();
  state.time = std::min(now, state.time);  // at rest before `from`, yet not out of date
  state.phase = landed_    ? FlightPhase::disarmed
                : landing_ ? FlightPhase::landing
                           : FlightPhase::flying;
  if (!landed_) return state;
  state.time = std::max(now, state.time);
  state.z_m = kGround_m;
  state.groundspeed_mps = 0.0;
  state.airspeed_mps = 0.0;
  return state;
}

void SimulatedFlightController::command(const Demand& demand, Instant now) {
  const auto* setpoint = std::get_if<Setpoint>(&demand);
  if (setpoint == nullptr) return;
  advance_to(now);  // the setpoint before this one stood until now
  if (landed_) return;
  if (setpoint->landing) {
    landing_ = *setpoint;
    return;
  }
  landing_.reset();
  model_.command(*setpoint);
}

}  // namespace skein::hal
