// SPDX-License-Identifier: Apache-2.0
#include "skein/models/ground_contact.hpp"

#include <algorithm>
#include <cmath>

namespace skein::models {
namespace {

Vec3 arm(const GroundContactParams::Point& point) { return {point.x_m, point.y_m, point.z_m}; }

double depth(const GroundContactParams& params, const RigidBodyState& state, const Vec3& down,
             const Vec3& arm_m) {
  return state.position_m.z() + down.dot(arm_m) - params.ground_down_m;
}

}  // namespace

Wrench ground_wrench(const GroundContactParams& params, const RigidBodyState& state) {
  Wrench sum;
  const Eigen::Matrix3d to_ned = state.attitude.toRotationMatrix();
  const Vec3 down = to_ned.row(2).transpose();  // in body axes
  // Rolling is along the ground, whatever the pitch.
  const Vec3 along = (Vec3::UnitX() - down.x() * down).normalized();
  const Vec3 across = down.cross(along);
  for (const auto& point : params.points) {
    const Vec3 r = arm(point);
    const double depth_m = depth(params, state, down, r);
    if (depth_m <= 0.0) continue;
    const Vec3 velocity = state.velocity_mps + state.rates_radps.cross(r);
    const double normal = std::max(
        0.0, params.stiffness_n_per_m * depth_m + params.damping_ns_per_m * velocity.dot(down));
    const double v_along = velocity.dot(along);
    const double v_across = velocity.dot(across);
    const double slip =
        std::sqrt(v_along * v_along + v_across * v_across + params.slip_mps * params.slip_mps);
    const Vec3 force = -normal * down - (normal * params.friction_along * v_along / slip) * along -
                       (normal * params.friction_across * v_across / slip) * across;
    sum += {.force_n = force, .moment_nm = r.cross(force)};
  }
  return sum;
}

bool touches_ground(const GroundContactParams& params, const RigidBodyState& state) {
  const Vec3 down = state.attitude.toRotationMatrix().row(2).transpose();
  return std::any_of(params.points.begin(), params.points.end(), [&](const auto& point) {
    return depth(params, state, down, arm(point)) > 0.0;
  });
}

}  // namespace skein::models
