// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "skein/base/geometry.hpp"
#include "skein/base/result.hpp"

namespace skein::planning {

/// Of one polygon.
inline constexpr std::size_t kCoverCirclesMax = 16;

struct Circle {
  Vec2 centre{0.0, 0.0};
  double radius_m = 0.0;
};

struct CircleCover {
  std::vector<Circle> circles;
  double polygon_m2 = 0.0;
  double circles_m2 = 0.0;  ///< of their union, to a thousandth or so
  /// What is shut out besides the polygon, as a share of it.
  [[nodiscard]] double more() const { return circles_m2 / polygon_m2 - 1.0; }
};

/// Circles whose union holds the polygon, and little besides: the polygon is cut by grids along its
/// edges, and each piece has its smallest circle; of all grids the one that shuts out least counts,
/// where another circle must pay for itself. Fails where the outline is none (why_no_area()).
[[nodiscard]] Result<CircleCover> cover_with_circles(std::span<const Vec2> corners);

}  // namespace skein::planning
