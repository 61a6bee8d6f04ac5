// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace skein {

/// An autopilot sets a copter down by itself, by its LAND, from here above the ground on: an
/// ArduCopter in GUIDED overshoots a point that sinks, by 2.5 m where it stops at once.
inline constexpr double kSetDownFrom_m = 3.0;
/// From here on its way down is slowed.
inline constexpr double kSlowedFrom_m = 2.0 * kSetDownFrom_m;

/// A height, its rate of change and that one's, all up.
struct Climb {
  double height_m = 0.0;
  double rate_mps = 0.0;
  double acceleration_mps2 = 0.0;
};

/// Where a copter is led whose point sinks, by where that is above the ground: as the point down to
/// `bend_m`, from there slower, and when the point is on the ground at rest in half of that. A
/// parabola of the point's height, which meets it without a step in the rate. A point that stops
/// above the ground, lower than the bend, is not quite reached: it is by bend / 8 at half of it.
/// Precondition: bend_m > 0, the height from which the point sinks at most.
[[nodiscard]] constexpr Climb led_down(const Climb& point, double bend_m = kSlowedFrom_m) {
  if (point.height_m >= bend_m) return point;
  const double above_m = point.height_m > 0.0 ? point.height_m : 0.0;
  const double slope = above_m / bend_m;
  return {0.5 * bend_m + 0.5 * slope * above_m, slope * point.rate_mps,
          slope * point.acceleration_mps2 + point.rate_mps * point.rate_mps / bend_m};
}

}  // namespace skein
