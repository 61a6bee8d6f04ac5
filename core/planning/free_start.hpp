// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/base/geometry.hpp"

namespace skein::planning {

/// Where a circle is joined that may be begun anywhere.
struct FreeStart {
  double start_rad = 0.0;  ///< from the centre
  double length_m = 0.0;   ///< the shortest Dubins path there
  double least_m = 0.0;    ///< no start of the circle has a shorter one
};
/// What length_m may be above the least of all starts, where that is not known to rounding.
inline constexpr double kFreeStartSlack_m = 0.01;

/// The start of the circle, flown counter-clockwise (`turn` +1) or clockwise (-1), that is reached
/// soonest. Of who is 4 turn radii off the circle it is known: a path is then an arc, a line and an
/// arc, and the line of the shortest one aims at the centre, by the transversality condition of
/// Pontryagin's principle (as Manyam et al. 2022, Shortest Dubins path to a circle). Nearer starts
/// are bisected: joining the circle earlier and following it is a path too, so that of two starts
/// the length to the earlier is less by no more than the arc between them.
/// Under a microsecond, and some ten where it is near. Precondition: circle_radius_m >= radius_m.
[[nodiscard]] FreeStart shortest_to_circle(const Pose2& from, double radius_m, const Vec2& centre,
                                           double circle_radius_m, int turn);

}  // namespace skein::planning
