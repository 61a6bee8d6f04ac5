// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>

namespace skein {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// The same angle in (-pi, pi].
[[nodiscard]] inline double wrap_pi(double rad) {
  if (rad > -kPi && rad <= kPi) return rad;  // as remainder would, and much faster
  const double r = std::remainder(rad, kTwoPi);
  return r <= -kPi ? r + kTwoPi : r;
}

/// The same angle in [0, 2 pi).
[[nodiscard]] inline double wrap_two_pi(double rad) {
  const double r = std::fmod(rad, kTwoPi);
  const double up = r < 0.0 ? r + kTwoPi : r;
  return up < kTwoPi ? up : 0.0;  // -1e-17 + 2 pi rounds to 2 pi
}

[[nodiscard]] constexpr double radians(double deg) { return deg * kPi / 180.0; }
[[nodiscard]] constexpr double degrees(double rad) { return rad * 180.0 / kPi; }

/// Inside the program a heading is mathematical: radians from east, counter-clockwise. What people
/// read and type is compass degrees: from north, clockwise; autopilots have the same in radians,
/// which is called yaw here. These are the only conversions.
[[nodiscard]] inline double heading_from_compass_deg(double compass_deg) {
  return wrap_pi(radians(90.0 - compass_deg));
}
/// In [0, 360).
[[nodiscard]] inline double compass_deg_from_heading(double heading_rad) {
  return degrees(wrap_two_pi(kPi / 2.0 - heading_rad));
}
/// In (-pi, pi].
[[nodiscard]] inline double yaw_from_heading(double heading_rad) {
  return wrap_pi(kPi / 2.0 - heading_rad);
}
[[nodiscard]] inline double heading_from_yaw(double yaw_rad) {
  return wrap_pi(kPi / 2.0 - yaw_rad);
}

}  // namespace skein
