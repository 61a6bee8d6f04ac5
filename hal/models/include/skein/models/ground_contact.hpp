// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/base/static_vector.hpp"
#include "skein/models/rigid_body.hpp"

namespace skein::models {

/// Wheels or feet on level ground: springs with dampers, and friction that grows to Coulomb's limit
/// with the slip (regularised at `slip_mps`, so a parked vehicle creeps by millimetres a second).
struct GroundContactParams {
  struct Point {
    double x_m = 0.0;  ///< body axes
    double y_m = 0.0;
    double z_m = 0.0;
  };
  StaticVector<Point, 8> points;
  double stiffness_n_per_m = 0.0;  ///< of each point
  double damping_ns_per_m = 0.0;   ///< of each point; never pulls
  double friction_along = 0.0;     ///< coefficient along the body's x axis: rolling, for wheels
  double friction_across = 0.0;
  double slip_mps = 0.1;
  double ground_down_m = 0.0;  ///< NED
};

[[nodiscard]] Wrench ground_wrench(const GroundContactParams& params, const RigidBodyState& state);
[[nodiscard]] bool touches_ground(const GroundContactParams& params, const RigidBodyState& state);

}  // namespace skein::models
