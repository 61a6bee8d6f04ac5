// SPDX-License-Identifier: Apache-2.0
#include "skein/autopilot/guidance.hpp"

#include <algorithm>
#include <cmath>

#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"

namespace skein::autopilot {
namespace {

/// Below this the course of a nearly hovering vehicle means nothing.
double groundspeed(const Estimate& estimate) { return std::max(estimate.groundspeed_mps(), 5.0); }

/// A bank turns the velocity over the ground by its component across it, which is less where the
/// nose does not point along the course.
double crab_factor(const Estimate& estimate) {
  const double crab = euler_angles(estimate.attitude).yaw_rad - estimate.course_rad();
  return 1.0 / std::max(std::cos(crab), 0.5);
}

}  // namespace

double steer_to_course(const Estimate& estimate, double course_rad, double gain_per_s) {
  const double error = wrap_pi(course_rad - estimate.course_rad());
  return groundspeed(estimate) * gain_per_s * error * crab_factor(estimate);
}

double steer_to_heading(const Estimate& estimate, double heading_rad, double gain_per_s) {
  const double error = wrap_pi(heading_rad - euler_angles(estimate.attitude).yaw_rad);
  // The nose turns at g tan(bank) / airspeed, whatever the wind.
  return estimate.airspeed_mps * gain_per_s * error;
}

double steer_to_orbit(const Estimate& estimate, const Orbit& orbit, double gain_per_s) {
  SKEIN_ASSERT(orbit.radius_m > 0.0);
  const Vec2 out = estimate.position_m.head<2>() - orbit.centre_m;
  const double distance = out.norm();
  const double way = orbit.clockwise ? 1.0 : -1.0;
  const double speed = groundspeed(estimate);
  // Steeper for wide circles: the same metres off are met at the same angle.
  const double sharpness = gain_per_s * orbit.radius_m / (3.0 * speed);
  const double off = std::clamp((distance - orbit.radius_m) / orbit.radius_m, -1.0, 10.0);
  const double course =
      std::atan2(out.y(), out.x()) + way * (kPi / 2.0 + std::atan(sharpness * off));
  // Near the circle its own curvature is flown ahead of any error.
  const double near = std::clamp(2.0 - std::abs(sharpness * off), 0.0, 1.0);
  return steer_to_course(estimate, course, gain_per_s) +
         way * near * speed * speed / std::max(distance, 0.5 * orbit.radius_m) *
             crab_factor(estimate);
}

double steer_to_line(const Estimate& estimate, const Vec2& from_m, const Vec2& to_m,
                     double gain_per_s) {
  const Vec2 along = to_m - from_m;
  SKEIN_ASSERT(along.norm() > 0.0);
  const Vec2 unit = along.normalized();
  // (north, east): the cross product is positive to the right.
  const double right = cross(unit, Vec2{estimate.position_m.head<2>() - from_m});
  constexpr double kEntry = kPi / 3.0;
  const double per_m = gain_per_s / (3.0 * groundspeed(estimate));
  const double course = std::atan2(unit.y(), unit.x()) -
                        kEntry * 2.0 / kPi * std::atan(per_m * right * kPi / (2.0 * kEntry));
  return steer_to_course(estimate, course, gain_per_s);
}

double ground_steering_rad(const Estimate& estimate, double heading_rad, double limit_rad) {
  const double error = wrap_pi(heading_rad - euler_angles(estimate.attitude).yaw_rad);
  return std::clamp(-1.5 * error + 0.6 * estimate.rates_radps.z(), -limit_rad, limit_rad);
}

double progress_on_line(const Estimate& estimate, const Vec2& from_m, const Vec2& to_m) {
  const Vec2 along = to_m - from_m;
  return (estimate.position_m.head<2>() - from_m).dot(along) / along.squaredNorm();
}

}  // namespace skein::autopilot
