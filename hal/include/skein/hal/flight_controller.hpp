// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "skein/base/time.hpp"
#include "skein/domain/vehicle.hpp"

namespace skein::hal {

/// A flight controller, as the control thread sees it. Both calls are made from that one thread at
/// the control rate; neither blocks, allocates or locks.
class FlightController {
 public:
  virtual ~FlightController() = default;

  /// The newest state, or nothing before the first one arrived. `state.time` says how old it is.
  [[nodiscard]] virtual std::optional<VehicleState> state(Instant now) = 0;

  /// Asks for a heading, airspeed and height from `now` on; the last one stands until the next.
  virtual void command(const Setpoint& setpoint, Instant now) = 0;
};

}  // namespace skein::hal
