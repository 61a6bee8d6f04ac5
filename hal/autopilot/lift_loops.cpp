// SPDX-License-Identifier: Apache-2.0
#include "skein/autopilot/lift_loops.hpp"

#include <algorithm>
#include <cmath>

#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"
#include "skein/base/shortened.hpp"

namespace skein::autopilot {
namespace {

/// Speed towards a place `distance_m` away: proportional when near, and farther off such that the
/// deceleration is not exceeded.
double closing_speed(double distance_m, double gain_per_s, double deceleration_mps2) {
  const double linear_m = deceleration_mps2 / (gain_per_s * gain_per_s);
  if (distance_m < linear_m) return gain_per_s * distance_m;
  return std::sqrt(2.0 * deceleration_mps2 * (distance_m - 0.5 * linear_m));
}

/// The attitude whose body down axis is `down` (unit, NED) and whose nose is over `yaw_rad`.
Eigen::Quaterniond attitude_with(const Vec3& down, double yaw_rad) {
  const Vec3 right = down.cross(Vec3{std::cos(yaw_rad), std::sin(yaw_rad), 0.0}).normalized();
  Eigen::Matrix3d to_ned;
  to_ned << right.cross(down), right, down;
  return Eigen::Quaterniond{to_ned};
}

}  // namespace

LiftDemand LiftLoops::fly(const Estimate& estimate, const MotionDemand& demand, double seconds) {
  SKEIN_ASSERT(seconds > 0.0);
  const LiftTuning& t = tuning_;
  Vec3 velocity = demand.velocity_mps;
  if (demand.horizontal_m) {
    const Vec2 off = *demand.horizontal_m - estimate.position_m.head<2>();
    const double distance = off.norm();
    if (distance > 0.0) {
      const double speed =
          std::min(closing_speed(distance, t.position_gain_per_s, 0.5 * t.acceleration_max_mps2),
                   demand.speed_max_mps.value_or(t.speed_max_mps));
      velocity.head<2>() += off * (speed / distance);
    }
  }
  if (demand.down_m) {
    const double off = *demand.down_m - estimate.position_m.z();
    velocity.z() += std::copysign(closing_speed(std::abs(off), t.position_gain_per_s, 1.5), off);
  }
  velocity.head<2>() = shortened(Vec2{velocity.head<2>()}, t.speed_max_mps);
  velocity.z() = std::clamp(velocity.z(), -t.climb_max_mps, t.sink_max_mps);

  const Vec3 error = velocity - estimate.velocity_mps;
  Vec3 acceleration = demand.acceleration_mps2 + t.velocity_gain_per_s * error + velocity_integral_;
  const Vec2 horizontal = acceleration.head<2>();
  acceleration.head<2>() = shortened(horizontal, t.acceleration_max_mps2);
  acceleration.z() = std::clamp(acceleration.z(), -6.0, 6.0);
  // Integrates what the limits let through.
  Vec3 integral = velocity_integral_ + t.velocity_integral_per_s2 * seconds * error;
  if (horizontal.norm() > t.acceleration_max_mps2)
    integral.head<2>() = velocity_integral_.head<2>();
  velocity_integral_.head<2>() = shortened(Vec2{integral.head<2>()}, 3.0);
  velocity_integral_.z() = std::clamp(integral.z(), -4.0, 6.0);

  Vec3 thrust = acceleration - kGravity_mps2 * Vec3::UnitZ();  // per mass
  const double sideways = std::max(-thrust.z(), 0.5) * std::tan(t.tilt_max_rad);
  thrust.head<2>() = shortened(Vec2{thrust.head<2>()}, sideways);
  thrust.z() = std::min(thrust.z(), -0.5);  // up, always: it shall not turn over
  const Vec3 down = -thrust.normalized();
  const Vec3 body_down = estimate.attitude * Vec3::UnitZ();
  const double thrust_n = t.mass_kg * std::max(0.0, -thrust.dot(body_down));
  return turn_to(estimate, attitude_with(down, demand.yaw_rad), demand.yaw_rate_radps, thrust_n,
                 seconds);
}

LiftDemand LiftLoops::hold_attitude(const Estimate& estimate, double roll_rad, double pitch_rad,
                                    double yaw_rad, double yaw_rate_radps, double thrust_n,
                                    double seconds) {
  SKEIN_ASSERT(seconds > 0.0);
  const double tilt = tuning_.tilt_max_rad;
  return turn_to(estimate,
                 attitude_from({.roll_rad = std::clamp(roll_rad, -tilt, tilt),
                                .pitch_rad = std::clamp(pitch_rad, -tilt, tilt),
                                .yaw_rad = yaw_rad}),
                 yaw_rate_radps, thrust_n, seconds);
}

LiftDemand LiftLoops::turn_to(const Estimate& estimate, const Eigen::Quaterniond& wanted,
                              double yaw_rate_radps, double thrust_n, double seconds) {
  const LiftTuning& t = tuning_;
  // First the thrust's direction the short way, then the turn about it.
  const Vec3 down_now = Vec3::UnitZ();
  const Vec3 down_wanted = estimate.attitude.conjugate() * (wanted * Vec3::UnitZ());
  const Eigen::Quaterniond tilt = Eigen::Quaterniond::FromTwoVectors(down_now, down_wanted);
  const Eigen::Quaterniond twist = (estimate.attitude * tilt).conjugate() * wanted;
  const double yaw_error = 2.0 * std::atan2(twist.z(), twist.w());
  Vec3 rate = 2.0 * tilt.vec().cwiseProduct(t.angle_gain_per_s);
  rate.z() = t.angle_gain_per_s.z() * wrap_pi(yaw_error) + yaw_rate_radps;
  rate.head<2>() = shortened(Vec2{rate.head<2>()}, t.tilt_rate_max_radps);
  rate.z() = std::clamp(rate.z(), -t.yaw_rate_max_radps, t.yaw_rate_max_radps);

  const Vec3& w = estimate.rates_radps;
  const Vec3 error = rate - w;
  const Vec3 angular = t.rate_gain_per_s.cwiseProduct(error) + rate_integral_;
  // On the ground the rates cannot follow: there the integral waits.
  if (thrust_n > 0.3 * t.mass_kg * kGravity_mps2) {
    rate_integral_ += seconds * t.rate_integral_per_s2.cwiseProduct(error);
    rate_integral_ = rate_integral_.cwiseMax(-10.0).cwiseMin(10.0);
  }
  const Vec3 moment =
      t.inertia_kgm2.cwiseProduct(angular) + w.cross(Vec3{t.inertia_kgm2.cwiseProduct(w)});
  return {thrust_n, moment};
}

}  // namespace skein::autopilot
