// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "skein/base/attitude.hpp"
#include "skein/base/frames.hpp"

namespace skein::models {

/// Six degrees of freedom over a flat earth that does not turn.
struct RigidBodyState {
  Vec3 position_m = Vec3::Zero();                                ///< NED
  Vec3 velocity_mps = Vec3::Zero();                              ///< over the ground, in body axes
  Eigen::Quaterniond attitude = Eigen::Quaterniond::Identity();  ///< body to NED, unit
  Vec3 rates_radps = Vec3::Zero();                               ///< p, q, r, in body axes

  [[nodiscard]] Vec3 velocity_ned_mps() const { return attitude * velocity_mps; }
};

/// Force and moment about the centre of mass, in body axes.
struct Wrench {
  Vec3 force_n = Vec3::Zero();
  Vec3 moment_nm = Vec3::Zero();

  Wrench& operator+=(const Wrench& other) {
    force_n += other.force_n;
    moment_nm += other.moment_nm;
    return *this;
  }
};

/// Mass, and the inertia about the centre of mass in body axes.
class MassProperties {
 public:
  /// Precondition: mass positive, inertia symmetric and positive definite.
  MassProperties(double mass_kg, const Eigen::Matrix3d& inertia_kgm2);

  [[nodiscard]] double mass_kg() const { return mass_kg_; }
  [[nodiscard]] const Eigen::Matrix3d& inertia_kgm2() const { return inertia_; }
  [[nodiscard]] const Eigen::Matrix3d& inverse_inertia() const { return inverse_; }

 private:
  double mass_kg_;
  Eigen::Matrix3d inertia_;
  Eigen::Matrix3d inverse_;
};

/// A RigidBodyState, or its derivative, as one vector: position, velocity, attitude (w, x, y, z),
/// rates. What a vehicle has besides (motors, servos) follows.
inline constexpr int kRigidBodySize = 13;
using RigidBodyVector = Eigen::Matrix<double, kRigidBodySize, 1>;

[[nodiscard]] RigidBodyVector to_vector(const RigidBodyState& state);
/// The attitude is taken as it is, not normalised.
[[nodiscard]] RigidBodyState from_vector(const RigidBodyVector& vector);

/// The equations of motion (Beard and McLain, "Small Unmanned Aircraft", 2012, eq. 3.14-3.17, with
/// the quaternion form of their appendix B): `wrench` is all but gravity, which pulls down with
/// `gravity_mps2`.
[[nodiscard]] RigidBodyVector rigid_body_derivative(const RigidBodyState& state,
                                                    const Wrench& wrench,
                                                    const MassProperties& mass,
                                                    double gravity_mps2 = kGravity_mps2);

/// Kinetic and potential energy, J; height counts from down = 0.
[[nodiscard]] double energy(const RigidBodyState& state, const MassProperties& mass,
                            double gravity_mps2 = kGravity_mps2);
/// Angular momentum about the centre of mass, NED, N m s.
[[nodiscard]] Vec3 angular_momentum(const RigidBodyState& state, const MassProperties& mass);

/// Between the mission frame and NED about the same origin.
[[nodiscard]] inline Vec3 ned_from(const Position<MissionEnu>& p) { return {p.y(), p.x(), -p.z()}; }
[[nodiscard]] inline Position<MissionEnu> enu_from(const Vec3& ned) {
  return {ned.y(), ned.x(), -ned.z()};
}

}  // namespace skein::models
