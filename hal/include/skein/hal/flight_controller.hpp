// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "skein/base/time.hpp"
#include "skein/domain/vehicle.hpp"

namespace skein::hal {

/// Whether an aircraft may be in the air: its motors are armed or turn, or it is off the ground.
enum class Airborne : std::uint8_t { unknown, no, yes };

/// A flight controller, as the control thread sees it. All calls are made from that one thread at
/// the control rate; none blocks, allocates or locks.
class FlightController {
 public:
  virtual ~FlightController() = default;

  /// The newest state, or nothing before the first one arrived. `state.time` says how old it is.
  [[nodiscard]] virtual std::optional<VehicleState> state(Instant now) = 0;

  /// From `now` on, until the next one: to fly a heading, airspeed and height, or to be where a
  /// point is that is there at `now` and moves on. A demand that the aircraft cannot be flown by
  /// has no effect: a position, of a fixed wing; a heading, of a simulated multirotor. (An
  /// ArduPilot copter is flown by either.)
  virtual void command(const Demand& demand, Instant now) = 0;

  /// As of the newest state(); unknown where nobody has said so.
  [[nodiscard]] virtual Airborne airborne() const { return Airborne::unknown; }
};

}  // namespace skein::hal
