// SPDX-License-Identifier: Apache-2.0
#include "skein/domain/fence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"

namespace skein {
namespace {

Fence of(std::vector<Vec2> corners) {
  Fence fence;
  fence.corners = std::move(corners);
  return fence;
}

/// An L, of which the inner corner is at (100, 100).
Fence bent() {
  return of(
      {{0.0, 0.0}, {300.0, 0.0}, {300.0, 100.0}, {100.0, 100.0}, {100.0, 300.0}, {0.0, 300.0}});
}

TEST(Fence, TellsHowFarAPointIsInside) {
  const Fence fence = bent();
  EXPECT_DOUBLE_EQ(fence.inside_m({50.0, 200.0}), 50.0);
  EXPECT_DOUBLE_EQ(fence.inside_m({200.0, 30.0}), 30.0);
  EXPECT_DOUBLE_EQ(fence.inside_m({130.0, 140.0}), -30.0);
  EXPECT_NEAR(fence.inside_m({60.0, 60.0}), std::hypot(40.0, 40.0), 1e-9) << "the inner corner";
  EXPECT_DOUBLE_EQ(fence.inside_m({-30.0, -40.0}), -50.0);
}

/// As the winding number has it (Hormann and Agathos 2001), for any polygon without crossings.
TEST(Fence, InsideIsWhereItsEdgesGoAround) {
  Random random{1};
  for (int n = 0; n < 200; ++n) {
    // Corners around a point, at rising angles: never crossed.
    std::vector<Vec2> corners;
    const int count = 3 + static_cast<int>(random.index(8));
    for (int k = 0; k < count; ++k) {
      const double angle = kTwoPi * (k + random.uniform(0.0, 0.9)) / count;
      corners.push_back(random.uniform(50.0, 200.0) * unit_vector(angle));
    }
    if (random.chance(0.5)) std::reverse(corners.begin(), corners.end());
    const Fence fence = of(corners);
    for (int i = 0; i < 50; ++i) {
      const Vec2 point{random.uniform(-220.0, 220.0), random.uniform(-220.0, 220.0)};
      double around = 0.0;
      for (std::size_t k = 0; k < corners.size(); ++k) {
        const Vec2 a = corners[k] - point;
        const Vec2 b = corners[(k + 1) % corners.size()] - point;
        around += std::atan2(cross(a, b), a.dot(b));
      }
      ASSERT_EQ(fence.inside_m(point) > 0.0, std::abs(around) > kPi) << n << ", " << i;
    }
  }
}

TEST(Fence, HoldsPathsThatNowhereLeaveIt) {
  const Fence fence = bent();
  Path path{{50.0, 250.0, -kPi / 2.0}, {}};
  ASSERT_TRUE(path.append(Segment{0.0, 200.0}));
  EXPECT_TRUE(fence.holds(path)) << "down one arm";
  Path turned = path;
  ASSERT_TRUE(turned.append(Segment{1.0 / 40.0, 40.0 * kPi / 2.0}));
  ASSERT_TRUE(turned.append(Segment{0.0, 150.0}));
  EXPECT_TRUE(fence.holds(turned)) << "and along the other";
  Path wide = path;
  ASSERT_TRUE(wide.append(Segment{1.0 / 60.0, 60.0 * kPi / 2.0}));
  EXPECT_FALSE(fence.holds(wide)) << "a wider turn";
  Path straight{{50.0, 250.0, std::atan2(-200.0, 200.0)}, {}};
  ASSERT_TRUE(straight.append(Segment{0.0, std::hypot(200.0, 200.0)}));
  EXPECT_FALSE(fence.holds(straight)) << "ends inside, and cuts the corner";
  EXPECT_TRUE(Fence{}.holds(straight)) << "no fence";
}

TEST(Fence, APathAcrossANotchLeavesIt) {
  // 4 m wide where the path crosses it, which begins and ends 20 m from the nearest edge.
  const Fence fence = of({{0.0, 0.0},
                          {200.0, 0.0},
                          {200.0, 100.0},
                          {104.0, 100.0},
                          {100.0, 20.0},
                          {96.0, 100.0},
                          {0.0, 100.0}});
  for (double east_m = 20.0; east_m < 60.0; east_m += 1.0) {
    Path path{{east_m, 60.0, 0.0}, {}};
    ASSERT_TRUE(path.append(Segment{0.0, 180.0 - east_m}));
    EXPECT_FALSE(fence.holds(path)) << "from " << east_m;
  }
}

TEST(Fence, OnlySimplePolygonsMakeOne) {
  EXPECT_TRUE(is_simple_polygon({{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}}));
  EXPECT_TRUE(is_simple_polygon(bent().corners));
  EXPECT_FALSE(is_simple_polygon({{0.0, 0.0}, {1.0, 1.0}, {1.0, 0.0}, {0.0, 1.0}})) << "crossed";
  EXPECT_FALSE(is_simple_polygon({{0.0, 0.0}, {1.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}})) << "twice";
  EXPECT_FALSE(is_simple_polygon({{0.0, 0.0}, {2.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}})) << "a spike";
  EXPECT_FALSE(is_simple_polygon({{0.0, 0.0}, {2.0, 0.0}, {2.0, 2.0}, {1.0, 0.0}, {0.0, 2.0}}))
      << "touches itself";
}

TEST(Fence, DigestsTellFencesApart) {
  const Fence fence = bent();
  EXPECT_EQ(digest_of({}), 0U);
  EXPECT_EQ(digest_of(fence), digest_of(bent()));
  Fence other = fence;
  other.corners[2].x() += 0.001;
  EXPECT_NE(digest_of(other), digest_of(fence));
  other = fence;
  other.height_max_m += 1.0;
  EXPECT_NE(digest_of(other), digest_of(fence));
  std::swap(other.corners[0], other.corners[1]);
  EXPECT_TRUE(why_no_fence(other));
  EXPECT_FALSE(why_no_fence(fence));
  other = fence;
  other.corners[0].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(why_no_fence(other));
  EXPECT_TRUE(why_no_fence({}));
}

}  // namespace
}  // namespace skein
