// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "skein/models/rigid_body.hpp"

namespace skein::models {

inline constexpr std::size_t kLiftRotors = 4;
/// What each gives, [0, 1] of its greatest thrust: front right, back left, front left, back right.
/// The first two turn counter-clockwise seen from above, as an X of ArduPilot's.
using RotorShares = std::array<double, kLiftRotors>;

/// The rotors that lift a quadplane along its body's up axis; they stand still in fast flight, and
/// what air they brake then is in the airframe's drag.
struct LiftRotorParams {
  double arm_forward_m = 0.0;
  double arm_right_m = 0.0;
  double thrust_max_n = 0.0;  ///< of each
  double torque_per_lift_m = 0.0;
  double time_s = 0.05;  ///< motor lag, > 0
};

[[nodiscard]] Wrench lift_wrench(const LiftRotorParams& params, const RotorShares& shares);

}  // namespace skein::models
