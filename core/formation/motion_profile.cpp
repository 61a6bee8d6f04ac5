// SPDX-License-Identifier: Apache-2.0
#include "skein/formation/motion_profile.hpp"

#include <algorithm>
#include <cmath>

#include "skein/base/assert.hpp"

namespace skein::formation {

MotionProfile::MotionProfile(double length_m, const MotionLimits& limits)
    : length_m_{length_m}, jerk_mps3_{limits.jerk_mps3} {
  const double a = limits.acceleration_mps2;
  const double j = limits.jerk_mps3;
  SKEIN_ASSERT(length_m >= 0.0 && limits.speed_mps > 0.0 && a > 0.0 && j > 0.0);
  if (length_m == 0.0) return;
  // Rising to a speed and falling again takes that speed times the time of one of them.
  const auto rise = [a, j](double v) {
    return v * j >= a * a ? v / a + a / j : 2.0 * std::sqrt(v / j);
  };
  peak_mps_ = limits.speed_mps;
  if (peak_mps_ * rise(peak_mps_) > length_m) {
    peak_mps_ = a / 2.0 * (std::sqrt(a * a / (j * j) + 4.0 * length_m / a) - a / j);
    if (peak_mps_ * j < a * a) peak_mps_ = std::cbrt(length_m * length_m * j / 4.0);
  }
  rise_s_ = rise(peak_mps_);
  ease_s_ = std::min(a / j, rise_s_ / 2.0);
  cruise_s_ = std::max(0.0, length_m / peak_mps_ - rise_s_);
}

MotionProfile::Point MotionProfile::rising(double t) const {
  const double a = jerk_mps3_ * ease_s_;
  const double eased_speed = a * ease_s_ / 2.0;
  const double eased_distance = eased_speed * ease_s_ / 3.0;
  if (t < ease_s_) {
    return {jerk_mps3_ * t * t * t / 6.0, jerk_mps3_ * t * t / 2.0, jerk_mps3_ * t};
  }
  if (t < rise_s_ - ease_s_) {
    const double u = t - ease_s_;
    return {eased_distance + eased_speed * u + a * u * u / 2.0, eased_speed + a * u, a};
  }
  const double left = rise_s_ - t;
  return {peak_mps_ * rise_s_ / 2.0 - peak_mps_ * left + jerk_mps3_ * left * left * left / 6.0,
          peak_mps_ - jerk_mps3_ * left * left / 2.0, jerk_mps3_ * left};
}

MotionProfile::Point MotionProfile::at(double t) const {
  if (t <= 0.0) return {};
  const double end = duration_s();
  if (t >= end) return {length_m_, 0.0, 0.0};
  if (t < rise_s_) return rising(t);
  if (t <= rise_s_ + cruise_s_) {
    return {peak_mps_ * (rise_s_ / 2.0 + (t - rise_s_)), peak_mps_, 0.0};
  }
  const Point mirrored = rising(end - t);
  return {length_m_ - mirrored.distance_m, mirrored.speed_mps, -mirrored.acceleration_mps2};
}

}  // namespace skein::formation
