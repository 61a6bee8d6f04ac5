// SPDX-License-Identifier: Apache-2.0
#include "skein/models/rigid_body.hpp"

#include <Eigen/LU>

#include "skein/base/assert.hpp"

namespace skein::models {

MassProperties::MassProperties(double mass_kg, const Eigen::Matrix3d& inertia_kgm2)
    : mass_kg_{mass_kg}, inertia_{inertia_kgm2}, inverse_{inertia_kgm2.inverse()} {
  SKEIN_ASSERT(mass_kg > 0.0);
  SKEIN_ASSERT(inertia_kgm2.isApprox(inertia_kgm2.transpose()));
  // Sylvester's criterion.
  const double of_two = inertia_kgm2.topLeftCorner<2, 2>().determinant();
  SKEIN_ASSERT(inertia_kgm2(0, 0) > 0.0 && of_two > 0.0 && inertia_kgm2.determinant() > 0.0);
}

RigidBodyVector to_vector(const RigidBodyState& state) {
  RigidBodyVector x;
  x << state.position_m, state.velocity_mps, state.attitude.w(), state.attitude.vec(),
      state.rates_radps;
  return x;
}

RigidBodyState from_vector(const RigidBodyVector& x) {
  return {.position_m = x.segment<3>(0),
          .velocity_mps = x.segment<3>(3),
          .attitude = Eigen::Quaterniond{x[6], x[7], x[8], x[9]},
          .rates_radps = x.segment<3>(10)};
}

RigidBodyVector rigid_body_derivative(const RigidBodyState& state, const Wrench& wrench,
                                      const MassProperties& mass, double gravity_mps2) {
  const Vec3& w = state.rates_radps;
  const Eigen::Matrix3d to_ned = state.attitude.toRotationMatrix();
  const Vec3 gravity = gravity_mps2 * to_ned.row(2).transpose();
  const Vec3 acceleration = wrench.force_n / mass.mass_kg() + gravity - w.cross(state.velocity_mps);
  const Vec3 momentum = mass.inertia_kgm2() * w;
  const Vec3 angular = mass.inverse_inertia() * (wrench.moment_nm - w.cross(momentum));
  const double q0 = state.attitude.w();
  const Vec3 q = state.attitude.vec();
  RigidBodyVector rate;
  rate << to_ned * state.velocity_mps, acceleration, -0.5 * q.dot(w), 0.5 * (q0 * w + q.cross(w)),
      angular;
  return rate;
}

double energy(const RigidBodyState& state, const MassProperties& mass, double gravity_mps2) {
  const Vec3& w = state.rates_radps;
  return 0.5 * mass.mass_kg() * state.velocity_mps.squaredNorm() +
         0.5 * w.dot(mass.inertia_kgm2() * w) -
         mass.mass_kg() * gravity_mps2 * state.position_m.z();
}

Vec3 angular_momentum(const RigidBodyState& state, const MassProperties& mass) {
  return state.attitude * (mass.inertia_kgm2() * state.rates_radps);
}

}  // namespace skein::models
