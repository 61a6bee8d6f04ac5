// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/autopilot/estimate.hpp"
#include "skein/base/geometry.hpp"

namespace skein::autopilot {

/// Lateral accelerations that steer a fixed wing, m/s^2, positive to the right. Angles are from
/// north, clockwise; points are (north, east). Pure functions.

/// Towards a course over the ground, the short way round: `gain_per_s` times the error as turn
/// rate.
[[nodiscard]] double steer_to_course(const Estimate& estimate, double course_rad,
                                     double gain_per_s);
/// Towards a heading of the nose.
[[nodiscard]] double steer_to_heading(const Estimate& estimate, double heading_rad,
                                      double gain_per_s);

struct Orbit {
  Vec2 centre_m{0.0, 0.0};
  double radius_m = 0.0;  ///< > 0
  bool clockwise = true;
};
/// Onto a circle and round it: the vector field of Beard and McLain, eq. 10.13, with the circle's
/// own acceleration ahead, so that wind leaves no lasting error.
[[nodiscard]] double steer_to_orbit(const Estimate& estimate, const Orbit& orbit,
                                    double gain_per_s);

/// Onto the line from one point through another and along it (Beard and McLain, eq. 10.8).
/// Precondition: the points differ.
[[nodiscard]] double steer_to_line(const Estimate& estimate, const Vec2& from_m, const Vec2& to_m,
                                   double gain_per_s);
/// Rudder that keeps the nose on the wheels, damped.
[[nodiscard]] double ground_steering_rad(const Estimate& estimate, double heading_rad,
                                         double limit_rad);
/// How far along that line the vehicle is: 0 at `from`, 1 at `to`.
[[nodiscard]] double progress_on_line(const Estimate& estimate, const Vec2& from_m,
                                      const Vec2& to_m);

}  // namespace skein::autopilot
