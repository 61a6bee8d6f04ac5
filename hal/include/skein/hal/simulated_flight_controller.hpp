// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/hal/flight_controller.hpp"
#include "skein/models/heading_dynamics.hpp"
#include "skein/models/wind.hpp"

namespace skein::hal {

/// A flight controller with its fixed wing, in this process: models::HeadingDynamics, integrated up
/// to `now` whenever it is asked. Until `from` it stays at its start. A setpoint with a landing
/// brings it down where it flies, at 5 m/s, to the origin's height, where it stays for good.
class SimulatedFlightController final : public FlightController {
 public:
  SimulatedFlightController(const VehicleSpec& vehicle, const Pose2& start,
                            const models::WindParams& wind, Instant from = Instant{});

  [[nodiscard]] std::optional<VehicleState> state(Instant now) override;
  void command(const Demand& demand, Instant now) override;
  /// From mission time `from` on it flies for good.
  [[nodiscard]] Airborne airborne() const override {
    return !landed_ && model_.state().time > from_ ? Airborne::yes : Airborne::no;
  }

 private:
  void advance_to(Instant now);

  Instant from_;
  models::HeadingDynamics model_;
  std::optional<Setpoint> landing_;
  bool landed_ = false;
};

}  // namespace skein::hal
