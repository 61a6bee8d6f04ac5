// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace skein {

/// A point or vector of the mission frame's horizontal plane: (east, north), metres.
using Vec2 = Eigen::Vector2d;

/// A planar pose in the mission frame. Heading: radians from east, counter-clockwise.
struct Pose2 {
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;

  [[nodiscard]] Vec2 position() const { return {x_m, y_m}; }
};

[[nodiscard]] inline Vec2 unit_vector(double heading_rad) {
  return {std::cos(heading_rad), std::sin(heading_rad)};
}
/// The vector turned a quarter counter-clockwise.
[[nodiscard]] inline Vec2 left_of(const Vec2& v) { return {-v.y(), v.x()}; }
/// z of the cross product: positive when b lies counter-clockwise of a.
[[nodiscard]] inline double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// The pose after `distance_m` along a line (curvature 0) or circle (1/m, positive turns left).
/// Exact for any distance, also negative; well-conditioned as the curvature goes to 0.
[[nodiscard]] Pose2 advance(const Pose2& from, double curvature_per_m, double distance_m);

/// The least distance from `point` to the straight way from `a` to `b`, which may be the same.
[[nodiscard]] double distance_to_segment(const Vec2& point, const Vec2& a, const Vec2& b);

/// The least distance from `point` to the piece of line or circle that starts at `from`.
/// Precondition: length_m >= 0.
[[nodiscard]] double distance_to_piece(const Vec2& point, const Pose2& from, double curvature_per_m,
                                       double length_m);

}  // namespace skein
