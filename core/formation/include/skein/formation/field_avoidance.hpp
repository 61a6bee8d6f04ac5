// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "skein/base/attitude.hpp"
#include "skein/base/ids.hpp"
#include "skein/formation/limits.hpp"

/// The avoidance of Zheng (2020), "unequal principle", eq. (6)-(10): as published, to compare with.
/// It proves nothing: it has minima where vehicles stand still, and a push that comes too late for
/// their acceleration. Good for five; 32 that swap sides come too near (docs/formation.md).
namespace skein::formation {

/// The defaults bring five through, of all that were tried with the standard MotionLimits.
struct FieldParams {
  double range_m = 6.0;     ///< rho_0: nearer than this, vehicles meet; > 0
  double gain = 2000.0;     ///< eta, such that the force is a velocity; >= 0
  double goal_power = 1.0;  ///< n of |X - X_goal|^n: no push at the goal itself; > 0
  /// Of the vehicle with the longest way. The field cannot know that braking takes time, so who is
  /// too fast to stop within the range comes too near.
  double speed_mps = 2.0;
};

/// Mission frame.
struct FieldSelf {
  VehicleId id;
  Vec3 position_m = Vec3::Zero();
  Vec3 velocity_mps = Vec3::Zero();  ///< commanded before
  Vec3 goal_m = Vec3::Zero();
  /// D_i / D_j of eq. (8): own way to the goal over that of the vehicle that has the longest, so
  /// that all arrive together; in (0, 1].
  double arrival_share = 1.0;
};

/// As its last message says.
struct FieldNeighbour {
  VehicleId id;
  Vec3 position_m = Vec3::Zero();
  Vec3 velocity_mps = Vec3::Zero();
  double age_s = 0.0;    ///< of that message; it is taken to have flown on as it did
  bool at_goal = false;  ///< it stays there, and all others give way
};

/// U = eta / 2 (1/rho - 1/rho_0)^2 D^n, with rho the distance to the neighbour and D that to the
/// goal; 0 from rho_0 on.
[[nodiscard]] double field_potential(const FieldParams& params, const Vec3& position_m,
                                     const Vec3& goal_m, const Vec3& neighbour_m);
/// -grad U, both terms: away from the neighbour, and towards the goal.
[[nodiscard]] Vec3 field_force(const FieldParams& params, const Vec3& position_m,
                               const Vec3& goal_m, const Vec3& neighbour_m);

/// The velocity to fly for the next `period_s`: towards the goal, at arrival_share of speed_mps
/// and slowing down before it, pushed by the neighbours that go first: those at their goal
/// and those of a higher id. Speed and its change keep to the limits; jerk does not. O(neighbours).
[[nodiscard]] Vec3 field_velocity(const FieldParams& params, const MotionLimits& limits,
                                  const FieldSelf& self, std::span<const FieldNeighbour> neighbours,
                                  double period_s);

}  // namespace skein::formation
