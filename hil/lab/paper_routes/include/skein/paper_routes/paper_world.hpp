// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "skein/base/geometry.hpp"
#include "skein/base/random.hpp"
#include "skein/routes/route_problem.hpp"

namespace skein::routes {

/// The hazards of Wu 2022, table 4, in a world of 1000 by 1000 (the paper names no unit; ours is
/// the metre). The weights that the table gives for detections have no place in eq. 2.
[[nodiscard]] std::vector<RouteHazard> paper_hazards();

/// The paper's three starts; the first is where the one-vehicle case begins, which it does not say.
[[nodiscard]] std::vector<Vec2> paper_starts();
[[nodiscard]] Vec2 paper_site();

/// One vehicle from that start in the table's world: D = 5, n = 200, plain sum of the costs.
[[nodiscard]] CurveProblem paper_curve(const Vec2& start);

/// Ten hazards anywhere, their kinds, sizes and weights drawn from the ranges of table 4; neither
/// (0, 0) nor (990, 990) lies in one of them.
[[nodiscard]] CurveProblem random_curve(Random random);

/// The three vehicles of fig. 16 and 17: starts (10, 350), (0, 0), (360, 30); approach angles 150,
/// 270 and 390 deg, of the point of entry as seen from the site; last leg 100. The paper gives
/// neither speed, turn radius nor separation: 20 m/s, 20 m and 30 m.
[[nodiscard]] RouteProblem paper_team();

/// A team of that many in a square world with as dense hazards as table 4's (ten in 1000 by 1000
/// m), all of them closed: starts along the left and the lower edge, the site towards the far
/// corner and free of hazards for 300 m around, bearings evenly spread from any first one, 20 m/s,
/// turn radius 20 m, last legs of 150 m, separation 20 m, a range of four times the world's side.
[[nodiscard]] RouteProblem random_team(std::size_t vehicles, std::size_t hazards, Random random);

}  // namespace skein::routes
