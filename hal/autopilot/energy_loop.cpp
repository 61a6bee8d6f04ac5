// SPDX-License-Identifier: Apache-2.0
#include "skein/autopilot/energy_loop.hpp"

#include <algorithm>
#include <cmath>

#include "skein/base/assert.hpp"

namespace skein::autopilot {
namespace {

/// Of the accelerometer along the path: TECS_SPD_OMEGA 2 rad/s.
constexpr double kAccelerationFilter_s = 0.5;

double within(double value, double limit) { return std::clamp(value, -limit, limit); }

}  // namespace

EnergyLoop::State EnergyLoop::begun(const Estimate& estimate, const EnergyLimits& limits) const {
  State s;
  s.height_m = estimate.height_m();
  s.airspeed_mps = std::max(estimate.airspeed_mps, limits.airspeed_least_mps);
  s.asked_mps = s.airspeed_mps;
  s.pitch_power = limits.pitch_trim_rad * kGravity_mps2 * s.airspeed_mps;
  s.pitch_rad = limits.pitch_trim_rad;
  s.throttle = limits.throttle_level;
  return s;
}

PitchAndThrottle EnergyLoop::step(const Estimate& estimate, double height_m, double airspeed_mps,
                                  const EnergyLimits& limits, double seconds) {
  SKEIN_ASSERT(seconds > 0.0);
  if (!state_) state_ = begun(estimate, limits);
  State& s = *state_;
  const double v = std::max(estimate.airspeed_mps, limits.airspeed_least_mps);

  const double climb_wanted =
      within((height_m - s.height_m) / t_.height_lag_s, t_.height_rate_max_mps);
  s.height_m += climb_wanted * seconds;
  s.asked_mps += std::min(seconds / t_.airspeed_lag_s, 1.0) * (airspeed_mps - s.asked_mps);
  const double acceleration_wanted =
      std::clamp((s.asked_mps - s.airspeed_mps) / seconds, -t_.slower_mps2, t_.faster_power / v);
  s.airspeed_mps += acceleration_wanted * seconds;
  const double pitch = euler_angles(estimate.attitude).pitch_rad;
  s.acceleration_mps2 +=
      seconds / kAccelerationFilter_s *
      (estimate.specific_force_mps2.x() - kGravity_mps2 * std::sin(pitch) - s.acceleration_mps2);

  const double height_error = kGravity_mps2 * (s.height_m - estimate.height_m());
  const double speed_error = 0.5 * (s.airspeed_mps * s.airspeed_mps - v * v);
  const double height_power = kGravity_mps2 * climb_wanted;
  const double speed_power = v * acceleration_wanted;
  const double height_power_error = height_power - kGravity_mps2 * estimate.climb_mps();
  const double speed_power_error = speed_power - v * s.acceleration_mps2;

  const double per_power = 1.0 / t_.power_range;
  const double sum_error = height_error + speed_error;
  const double throttle_wanted =
      limits.throttle_level + s.throttle_integral +
      per_power * (height_power + speed_power +
                   (sum_error + t_.throttle_damping * (height_power_error + speed_power_error)) /
                       t_.time_s);
  const double throttle = std::clamp(throttle_wanted, 0.0, limits.throttle_max);
  if ((throttle_wanted - throttle) * sum_error <= 0.0) {
    s.throttle_integral = within(s.throttle_integral + t_.throttle_integral_per_s * per_power /
                                                           t_.time_s * sum_error * seconds,
                                 0.5);
  }
  s.throttle += within(throttle - s.throttle, t_.throttle_rate_per_s * seconds);

  const double climb_power = height_power + height_error / t_.pitch_time_s + s.pitch_power +
                             t_.pitch_damping * height_power_error;
  const double wanted = climb_power / (v * kGravity_mps2);
  const double limited = std::clamp(wanted, limits.pitch_min_rad, limits.pitch_max_rad);
  if ((wanted - limited) * height_error <= 0.0) {
    s.pitch_power += t_.pitch_integral_per_s * height_error * seconds;
  }
  s.pitch_rad += within(limited - s.pitch_rad, t_.vertical_acceleration_mps2 / v * seconds);
  return {.pitch_rad = s.pitch_rad, .throttle = s.throttle};
}

}  // namespace skein::autopilot
