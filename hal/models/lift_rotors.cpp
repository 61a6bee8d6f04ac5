// SPDX-License-Identifier: Apache-2.0
#include "skein/models/lift_rotors.hpp"

namespace skein::models {

Wrench lift_wrench(const LiftRotorParams& params, const RotorShares& shares) {
  const double forward = params.arm_forward_m;
  const double right = params.arm_right_m;
  const std::array<Vec3, kLiftRotors> places{Vec3{forward, right, 0.0}, Vec3{-forward, -right, 0.0},
                                             Vec3{forward, -right, 0.0},
                                             Vec3{-forward, right, 0.0}};
  // Their drag turns the body against them.
  constexpr std::array<double, kLiftRotors> kYaw{1.0, 1.0, -1.0, -1.0};
  Wrench sum;
  for (std::size_t i = 0; i < kLiftRotors; ++i) {
    const double thrust = shares[i] * params.thrust_max_n;
    const Vec3 force{0.0, 0.0, -thrust};
    sum += {.force_n = force, .moment_nm = places[i].cross(force)};
    sum.moment_nm.z() += kYaw[i] * params.torque_per_lift_m * thrust;
  }
  return sum;
}

}  // namespace skein::models
