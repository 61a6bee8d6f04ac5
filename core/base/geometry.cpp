// SPDX-License-Identifier: Apache-2.0
#include "skein/base/geometry.hpp"

#include <algorithm>

#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"

namespace skein {
namespace {
/// sin(x) / x, without the cancellation at 0.
double sinc(double x) { return std::abs(x) < 1e-4 ? 1.0 - x * x / 6.0 : std::sin(x) / x; }
}  // namespace

Pose2 advance(const Pose2& from, double curvature_per_m, double distance_m) {
  // The chord of an arc: length d sinc(turn / 2), in the direction heading + turn / 2.
  const double turn = curvature_per_m * distance_m;
  const double chord = distance_m * sinc(turn / 2.0);
  const double direction = from.heading_rad + turn / 2.0;
  return {from.x_m + chord * std::cos(direction), from.y_m + chord * std::sin(direction),
          wrap_pi(from.heading_rad + turn)};
}

double distance_to_segment(const Vec2& point, const Vec2& a, const Vec2& b) {
  const Vec2 way = b - a;
  const double length2 = way.squaredNorm();
  const double share = length2 > 0.0 ? std::clamp((point - a).dot(way) / length2, 0.0, 1.0) : 0.0;
  return (point - a - share * way).norm();
}

double distance_to_piece(const Vec2& point, const Pose2& from, double curvature_per_m,
                         double length_m) {
  SKEIN_ASSERT(length_m >= 0.0);
  const Vec2 forward = unit_vector(from.heading_rad);
  const Vec2 offset = point - from.position();
  if (std::abs(curvature_per_m) < 1e-9) {
    const double along = std::clamp(forward.dot(offset), 0.0, length_m);
    return (offset - along * forward).norm();
  }
  const double radius = 1.0 / curvature_per_m;  // signed
  const Vec2 centre = from.position() + radius * left_of(forward);
  const Vec2 spoke = point - centre;
  // Angle from the start of the arc to the point's direction, counted in the sense of the turn.
  const Vec2 start_spoke = from.position() - centre;
  const double ccw = std::atan2(cross(start_spoke, spoke), start_spoke.dot(spoke));
  const double turn = wrap_two_pi(curvature_per_m > 0.0 ? ccw : -ccw);
  if (turn <= length_m * std::abs(curvature_per_m)) {
    return std::abs(spoke.norm() - std::abs(radius));
  }
  const Vec2 end = advance(from, curvature_per_m, length_m).position();
  return std::min(offset.norm(), (point - end).norm());
}

}  // namespace skein
