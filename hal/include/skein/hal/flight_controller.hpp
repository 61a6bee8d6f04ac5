// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "skein/base/time.hpp"
#include "skein/domain/vehicle.hpp"

namespace skein::hal {

/// A flight controller, as the control thread sees it. All calls are made from that one thread at
/// the control rate; none blocks, allocates or locks. A fixed wing is flown by Setpoint, a
/// multirotor by PositionSetpoint (an ArduPilot copter by either: the newest counts).
class FlightController {
 public:
  virtual ~FlightController() = default;

  /// The newest state, or nothing before the first one arrived. `state.time` says how old it is.
  [[nodiscard]] virtual std::optional<VehicleState> state(Instant now) = 0;

  /// Asks for a heading, airspeed and height from `now` on; the last one stands until the next.
  /// Has no effect on a simulated multirotor.
  virtual void command(const Setpoint& setpoint, Instant now) = 0;

  /// Asks to be where a point is that is there at `now` and moves on. Has no effect on a fixed
  /// wing.
  virtual void command(const PositionSetpoint& /*setpoint*/, Instant /*now*/) {}
};

}  // namespace skein::hal
