// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/domain/vehicle.hpp"
#include "skein/mavlink/enums.hpp"
#include "skein/mavlink/messages.hpp"

namespace skein::ardupilot {

/// Setpoints in the words of the autopilot. Pure.

/// The bank that turns a fixed wing from its heading to the setpoint's with the vehicle's heading
/// gain, in a coordinated turn within its turn radius: tan(bank) = airspeed * rate / g (Beard and
/// McLain, eq. 9.14). rad, positive to the right.
[[nodiscard]] double bank_for(const VehicleSpec& vehicle, const Setpoint& setpoint,
                              const VehicleState& state);

/// Roll alone; height and airspeed stay with the autopilot.
[[nodiscard]] mavlink::SetAttitudeTarget roll_target(double bank_rad);

/// Velocity over the ground, of an aircraft that hovers.
[[nodiscard]] mavlink::SetPositionTargetLocalNed velocity_target(const Setpoint& setpoint,
                                                                 const VehicleState& state);

}  // namespace skein::ardupilot
