// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/base/frames.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/mavlink/enums.hpp"
#include "skein/mavlink/messages.hpp"

namespace skein::ardupilot {

/// Setpoints in the words of the autopilot. Pure.

/// The bank that turns a fixed wing from its heading to the setpoint's with the vehicle's heading
/// gain, within its turn radius: tan(bank) = airspeed * rate / (g * ability), where `ability` is
/// what it turns by at a bank against a coordinated turn (TurnAbility; Beard and McLain, eq. 9.14).
/// rad, positive to the right.
[[nodiscard]] double bank_for(const VehicleSpec& vehicle, const Setpoint& setpoint,
                              const VehicleState& state, double ability);

/// Roll alone; height and airspeed stay with the autopilot.
[[nodiscard]] mavlink::SetAttitudeTarget roll_target(double bank_rad);

/// Velocity over the ground, of an aircraft that hovers.
[[nodiscard]] mavlink::SetPositionTargetLocalNed velocity_target(const Setpoint& setpoint,
                                                                 const VehicleState& state);

/// The point of a copter's setpoint, with its acceleration and a velocity that asks for that: its
/// own, and what its change takes in the copter's velocity loop. It goes by latitude,
/// longitude and height above the sea: a local position counts from where the autopilot's filter
/// began, which the mission does not know.
[[nodiscard]] mavlink::SetPositionTargetGlobalInt point_target(const PositionSetpoint& setpoint,
                                                               const MissionOrigin& origin,
                                                               double geoid_height_m);

}  // namespace skein::ardupilot
