// SPDX-License-Identifier: Apache-2.0
#include "skein/models/hexarotor.hpp"

#include <algorithm>
#include <cmath>

#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"
#include "skein/models/runge_kutta.hpp"

namespace skein::models {
namespace {

using StateVector = Eigen::Matrix<double, kRigidBodySize + static_cast<int>(kRotors), 1>;

RotorSpeeds speeds_of(const StateVector& x) {
  RotorSpeeds speeds{};
  for (std::size_t i = 0; i < kRotors; ++i) {
    speeds[i] = x[kRigidBodySize + static_cast<Eigen::Index>(i)];
  }
  return speeds;
}

}  // namespace

HexarotorParams firefly() {
  HexarotorParams p;
  p.mass = MassProperties{1.56779, Vec3{0.0347563, 0.0458929, 0.0977}.asDiagonal()};
  for (std::size_t i = 0; i < kRotors; ++i) {
    const double bearing = radians(30.0 + 60.0 * static_cast<double>(i));
    p.rotor_m[i] = 0.215 * Vec3{std::cos(bearing), std::sin(bearing), 0.0};
    p.turning[i] = i % 2 == 0 ? 1.0 : -1.0;
  }
  p.lift_ns2_per_rad2 = 8.54858e-6;
  p.torque_per_lift_m = 0.016;
  p.drag_ns_per_rad_m = 8.06428e-5;
  p.rolling_nms_per_rad_m = 1e-6;
  p.speed_max_radps = 838.0;
  p.time_up_s = 0.0125;
  p.time_down_s = 0.025;
  p.body_drag_n_per_mps2 = 0.02;
  for (std::size_t i = 0; i < 3; ++i) {
    const double bearing = radians(120.0 * static_cast<double>(i));
    p.ground.points.push_back({0.15 * std::cos(bearing), 0.15 * std::sin(bearing), 0.08});
  }
  p.ground.stiffness_n_per_m = 1000.0;
  p.ground.damping_ns_per_m = 25.0;
  p.ground.friction_along = 0.6;
  p.ground.friction_across = 0.6;
  return p;
}

Wrench hexarotor_wrench(const HexarotorParams& params, const RigidBodyState& state,
                        const RotorSpeeds& speeds, const Vec3& wind_ned_mps) {
  const Vec3 air = state.velocity_mps - state.attitude.conjugate() * wind_ned_mps;
  Wrench sum;
  sum.force_n = -params.body_drag_n_per_mps2 * air.norm() * air;
  for (std::size_t i = 0; i < kRotors; ++i) {
    const double w = speeds[i];
    const Vec3& arm = params.rotor_m[i];
    Vec3 in_plane = air + state.rates_radps.cross(arm);
    in_plane.z() = 0.0;
    const double lift = params.lift_ns2_per_rad2 * w * w;
    const Vec3 force = Vec3{0.0, 0.0, -lift} - (params.drag_ns_per_rad_m * w) * in_plane;
    sum.force_n += force;
    sum.moment_nm += arm.cross(force) - (params.rolling_nms_per_rad_m * w) * in_plane;
    sum.moment_nm.z() -= params.turning[i] * params.torque_per_lift_m * lift;
  }
  return sum;
}

double hover_speed_radps(const HexarotorParams& params) {
  return std::sqrt(params.mass.mass_kg() * kGravity_mps2 /
                   (static_cast<double>(kRotors) * params.lift_ns2_per_rad2));
}

Hexarotor::Hexarotor(const HexarotorParams& params, const RigidBodyState& state)
    : params_{params}, state_{state} {
  SKEIN_ASSERT(params.time_up_s > 0.0 && params.time_down_s > 0.0);
}

Wrench Hexarotor::wrench(const RigidBodyState& state, const RotorSpeeds& speeds,
                         const Vec3& wind_ned_mps) const {
  Wrench sum = hexarotor_wrench(params_, state, speeds, wind_ned_mps);
  sum += ground_wrench(params_.ground, state);
  return sum;
}

void Hexarotor::step(const RotorSpeeds& command, const Vec3& wind_ned_mps, double seconds) {
  SKEIN_ASSERT(seconds > 0.0);
  StateVector x;
  x.head<kRigidBodySize>() = to_vector(state_);
  std::array<double, kRotors> goal{};
  std::array<double, kRotors> lag_s{};
  for (std::size_t i = 0; i < kRotors; ++i) {
    goal[i] = std::clamp(command[i], 0.0, params_.speed_max_radps);
    lag_s[i] = goal[i] > speeds_[i] ? params_.time_up_s : params_.time_down_s;
    x[kRigidBodySize + static_cast<Eigen::Index>(i)] = speeds_[i];
  }
  x = runge_kutta_step(x, seconds, [&](const StateVector& at) {
    const RigidBodyState state = from_vector(at.head<kRigidBodySize>());
    const RotorSpeeds now = speeds_of(at);
    StateVector rate;
    rate.head<kRigidBodySize>() =
        rigid_body_derivative(state, wrench(state, now, wind_ned_mps), params_.mass);
    for (std::size_t i = 0; i < kRotors; ++i) {
      rate[kRigidBodySize + static_cast<Eigen::Index>(i)] = (goal[i] - now[i]) / lag_s[i];
    }
    return rate;
  });
  state_ = from_vector(x.head<kRigidBodySize>());
  state_.attitude.normalize();
  speeds_ = speeds_of(x);
}

Vec3 Hexarotor::specific_force(const Vec3& wind_ned_mps) const {
  return wrench(state_, speeds_, wind_ned_mps).force_n / params_.mass.mass_kg();
}

}  // namespace skein::models
