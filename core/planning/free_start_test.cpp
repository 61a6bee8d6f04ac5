// SPDX-License-Identifier: Apache-2.0
#include "free_start.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"
#include "skein/planning/dubins.hpp"

namespace skein::planning {
namespace {

constexpr double kRadius_m = 165.0;

double length_to(const Pose2& from, const Vec2& centre, double circle_m, double start_rad,
                 int turn) {
  const Vec2 entry = centre + circle_m * unit_vector(start_rad);
  return shortest_dubins_length(from, {entry.x(), entry.y(), wrap_pi(start_rad + turn * kPi / 2.0)},
                                kRadius_m);
}

/// Every twentieth of a degree, far and near, circles as tight as the turn and wide ones.
TEST(FreeStart, NoOtherIsReachedSooner) {
  Random random{31};
  int near = 0;
  for (int i = 0; i < 120; ++i) {
    const double size_m = i % 2 == 0 ? 4000.0 : 1000.0;
    const Vec2 centre{300.0, -200.0};
    const Pose2 from{centre.x() + random.uniform(-size_m, size_m),
                     centre.y() + random.uniform(-size_m, size_m), random.uniform(-kPi, kPi)};
    const double circle_m = i % 5 == 0 ? kRadius_m : random.uniform(kRadius_m, 600.0);
    const int turn = i % 3 == 0 ? -1 : 1;
    const FreeStart best = shortest_to_circle(from, kRadius_m, centre, circle_m, turn);
    EXPECT_NEAR(length_to(from, centre, circle_m, best.start_rad, turn), best.length_m, 1e-6) << i;
    EXPECT_LE(best.length_m - best.least_m, kFreeStartSlack_m + 1e-12);
    near += best.least_m < best.length_m ? 1 : 0;
    double least_m = INFINITY;
    for (int k = 0; k < 7200; ++k) {
      least_m = std::min(least_m, length_to(from, centre, circle_m, k * kTwoPi / 7200.0, turn));
    }
    EXPECT_GE(least_m, best.least_m - 1e-6) << i << ": " << turn << ", " << circle_m;
  }
  EXPECT_GE(near, 20);
  EXPECT_LE(near, 100);
}

}  // namespace
}  // namespace skein::planning
