// SPDX-License-Identifier: Apache-2.0
#include "skein/autopilot/hexarotor_loops.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"
#include "skein/base/shortened.hpp"

namespace skein::autopilot {
namespace {

constexpr std::size_t kRotors = RotorCommand::kRotors;

double bearing(std::size_t rotor) { return radians(30.0 + 60.0 * static_cast<double>(rotor)); }

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

double RotorCommand::mean() const {
  return std::accumulate(thrust.begin(), thrust.end(), 0.0) / static_cast<double>(kRotors);
}

RotorCommand mix(const HexarotorTuning& tuning, double thrust_n, const Vec3& moment_nm) {
  constexpr auto kCount = static_cast<double>(kRotors);
  const double full = tuning.rotor_thrust_max_n;
  std::array<double, kRotors> tilt{};
  std::array<double, kRotors> yaw{};
  for (std::size_t i = 0; i < kRotors; ++i) {
    // The columns are orthogonal: sin^2 and cos^2 sum to 3 over the rotors.
    tilt[i] = (-std::sin(bearing(i)) * moment_nm.x() + std::cos(bearing(i)) * moment_nm.y()) /
              (0.5 * kCount * tuning.arm_m * full);
    yaw[i] = (i % 2 == 0 ? -1.0 : 1.0) * moment_nm.z() / (kCount * tuning.torque_per_lift_m * full);
  }
  const auto [least, most] = std::minmax_element(tilt.begin(), tilt.end());
  // More than the whole range of a rotor cannot be had.
  const double scale = std::min(1.0, 1.0 / std::max(*most - *least, 1e-9));
  const double mean = std::clamp(thrust_n / (kCount * full), -scale * *least, 1.0 - scale * *most);
  double room = 1.0;  // share of the yaw moment that fits
  for (std::size_t i = 0; i < kRotors; ++i) {
    const double base = mean + scale * tilt[i];
    if (yaw[i] > 0.0) room = std::min(room, std::max(0.0, 1.0 - base) / yaw[i]);
    if (yaw[i] < 0.0) room = std::min(room, std::max(0.0, base) / -yaw[i]);
  }
  RotorCommand command;
  for (std::size_t i = 0; i < kRotors; ++i) {
    command.thrust[i] = std::clamp(mean + scale * tilt[i] + room * yaw[i], 0.0, 1.0);
  }
  return command;
}

double HexarotorLoops::hover_thrust() const {
  return tuning_.mass_kg * kGravity_mps2 /
         (static_cast<double>(kRotors) * tuning_.rotor_thrust_max_n);
}

RotorCommand HexarotorLoops::fly(const Estimate& estimate, const MotionDemand& demand,
                                 double seconds) {
  SKEIN_ASSERT(seconds > 0.0);
  const HexarotorTuning& t = tuning_;
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

RotorCommand HexarotorLoops::hold_attitude(const Estimate& estimate, double roll_rad,
                                           double pitch_rad, double yaw_rad, double yaw_rate_radps,
                                           double thrust, double seconds) {
  SKEIN_ASSERT(seconds > 0.0);
  const double tilt = tuning_.tilt_max_rad;
  const double full = static_cast<double>(kRotors) * tuning_.rotor_thrust_max_n;
  return turn_to(estimate,
                 attitude_from({.roll_rad = std::clamp(roll_rad, -tilt, tilt),
                                .pitch_rad = std::clamp(pitch_rad, -tilt, tilt),
                                .yaw_rad = yaw_rad}),
                 yaw_rate_radps, full * std::clamp(thrust, 0.0, 1.0), seconds);
}

RotorCommand HexarotorLoops::turn_to(const Estimate& estimate, const Eigen::Quaterniond& wanted,
                                     double yaw_rate_radps, double thrust_n, double seconds) {
  const HexarotorTuning& t = tuning_;
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
  return mix(t, thrust_n, moment);
}

}  // namespace skein::autopilot
