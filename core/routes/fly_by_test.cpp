// SPDX-License-Identifier: Apache-2.0
#include "skein/routes/fly_by.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"

namespace skein::routes {
namespace {

TEST(FlyBy, ARightAngleSavesTwoRadiiLessAQuarterCircle) {
  const std::array<Vec2, 3> corner = {Vec2{0, 0}, Vec2{100, 0}, Vec2{100, 50}};
  EXPECT_NEAR(turn_at(corner[0], corner[1], corner[2]), kPi / 2.0, 1e-15);
  EXPECT_NEAR(fly_by_length_m(corner, 10.0), 150.0 - 20.0 + 10.0 * kPi / 2.0, 1e-12);
  EXPECT_DOUBLE_EQ(fly_by_length_m(corner, 0.0), 150.0);
  EXPECT_NEAR(turns_fit_m(corner, 10.0), 40.0, 1e-12);
  EXPECT_NEAR(turns_fit_m(corner, 60.0), -10.0, 1e-12);
}

TEST(FlyBy, ThePathHasTheLengthOfEquationOneAndEndsAtTheLastWaypoint) {
  Random random{1};
  int flown = 0;
  for (int k = 0; k < 500; ++k) {
    std::vector<Vec2> points;
    for (int i = 0; i < 6; ++i) points.emplace_back(random.uniform(0, 1e3), random.uniform(0, 1e3));
    const double radius = random.uniform(1.0, 40.0);
    const auto path = fly_by_path(points, radius);
    ASSERT_EQ(path.ok(), turns_fit_m(points, radius) >= 0.0);
    if (!path) continue;
    ++flown;
    EXPECT_NEAR(path->length_m(), fly_by_length_m(points, radius), 1e-9);
    EXPECT_NEAR((path->end().position() - points.back()).norm(), 0.0, 1e-8);
    EXPECT_NEAR(path->curvature_max_per_m(), 1.0 / radius, 1e-15);
  }
  EXPECT_GT(flown, 50);
}

TEST(FlyBy, SaysWhichTurnsDoNotFit) {
  const std::array<Vec2, 4> zigzag = {Vec2{0, 0}, Vec2{100, 0}, Vec2{100, 10}, Vec2{0, 10}};
  const auto path = fly_by_path(zigzag, 20.0);
  ASSERT_FALSE(path.ok());
  EXPECT_NE(path.error().message.find("waypoints 1 and 2"), std::string::npos);
  EXPECT_FALSE(fly_by_path(std::array{Vec2{0, 0}, Vec2{0, 0}}, 1.0).ok());
  EXPECT_FALSE(fly_by_path(std::array{Vec2{0, 0}}, 1.0).ok());
}

}  // namespace
}  // namespace skein::routes
