// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/circle_cover.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"
#include "skein/domain/fence.hpp"

namespace skein::planning {
namespace {

TEST(CircleCover, HoldsEveryPointOfRandomPolygonsAndLittleBesides) {
  Random random{7};
  std::vector<double> more;
  std::size_t most = 0;
  for (int i = 0; i < 60; ++i) {
    std::vector<Vec2> corners;
    const auto n = static_cast<int>(3 + random.index(9));
    for (int k = 0; k < n; ++k) {
      const double angle = kTwoPi * (k + random.uniform(-0.3, 0.3)) / n;
      corners.push_back(random.uniform(150.0, 600.0) * unit_vector(angle));
    }
    const auto cover = cover_with_circles(corners);
    ASSERT_TRUE(cover.ok()) << i << ": " << cover.error().message;
    ASSERT_LE(cover->circles.size(), kCoverCirclesMax);
    const Fence outline{corners, 0.0};
    for (double x = -600.0; x <= 600.0; x += 4.7) {
      for (double y = -600.0; y <= 600.0; y += 4.7) {
        if (outline.inside_m({x, y}) < 0.0) continue;
        ASSERT_TRUE(std::ranges::any_of(cover->circles,
                                        [&](const Circle& c) {
                                          return (Vec2{x, y} - c.centre).norm() <= c.radius_m;
                                        }))
            << i << " at " << x << ", " << y;
      }
    }
    more.push_back(cover->more());
    most = std::max(most, cover->circles.size());
  }
  std::ranges::sort(more);
  std::printf(
      "circles shut out %.0f %% more than the polygon (median), %.0f %% at most; %zu at most\n",
      100.0 * more[30], 100.0 * more.back(), most);
  EXPECT_LT(more[30], 0.4);
}

TEST(CircleCover, ALongStripTakesARowOfCircles) {
  const auto cover =
      cover_with_circles(std::vector<Vec2>{{0, 0}, {1000, 0}, {1000, 100}, {0, 100}});
  ASSERT_TRUE(cover.ok());
  EXPECT_GE(cover->circles.size(), 6U);
  EXPECT_LT(cover->more(), 0.5);
  EXPECT_FALSE(cover_with_circles(std::vector<Vec2>{{0, 0}, {1, 1}}).ok());
}

}  // namespace
}  // namespace skein::planning
