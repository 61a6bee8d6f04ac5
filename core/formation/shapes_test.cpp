// SPDX-License-Identifier: Apache-2.0
#include "skein/formation/shapes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "skein/base/angles.hpp"
#include "skein/base/geometry.hpp"
#include "skein/base/random.hpp"

namespace skein::formation {
namespace {

using ::testing::HasSubstr;

ShapeSpec shape_of(ShapeKind kind, double spacing_m = 3.0) {
  ShapeSpec shape;
  shape.kind = kind;
  shape.spacing_m = spacing_m;
  return shape;
}

ShapeSpec free_of(std::vector<Vec3> points, bool closed, double spacing_m = 3.0) {
  ShapeSpec shape = shape_of(ShapeKind::free, spacing_m);
  shape.points = std::move(points);
  shape.closed = closed;
  return shape;
}

std::vector<Vec3> good_places(const ShapeSpec& shape, std::size_t n) {
  const auto result = places(shape, n);
  EXPECT_TRUE(result.ok()) << to_string(shape.kind) << ", n = " << n;
  return result.ok() ? *result : std::vector<Vec3>{};
}

/// Offsets from the first place, along and across the track.
std::vector<Vec2> from_leader(const std::vector<Vec3>& places, double heading_rad = 0.0) {
  std::vector<Vec2> out;
  for (const Vec3& place : places) {
    const Vec2 d = (place - places.front()).head<2>();
    out.emplace_back(d.dot(unit_vector(heading_rad)), d.dot(left_of(unit_vector(heading_rad))));
  }
  return out;
}

double least_distance(const std::vector<Vec3>& places) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      least = std::min(least, (places[i] - places[j]).norm());
    }
  }
  return least;
}

void expect_offsets(const ShapeSpec& shape, const std::vector<Vec2>& expected) {
  const auto found = from_leader(good_places(shape, expected.size()));
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_LT((found.at(i) - expected[i]).norm(), 1e-12)
        << to_string(shape.kind) << " " << i << ": " << found[i].transpose();
  }
}

TEST(Shapes, HaveTheOffsetsOfThePaper) {
  expect_offsets(shape_of(ShapeKind::line_abreast), {{0, 0}, {0, 3}, {0, -3}, {0, 6}, {0, -6}});
  expect_offsets(shape_of(ShapeKind::column), {{0, 0}, {-3, 0}, {-6, 0}, {-9, 0}, {-12, 0}});
  const double step = 3.0 / std::numbers::sqrt2;
  expect_offsets(shape_of(ShapeKind::echelon), {{0, 0}, {-step, -step}, {-2 * step, -2 * step}});
  const double aside = 3.0 * kPi / 4.0;
  expect_offsets(shape_of(ShapeKind::wedge), {{0, 0},
                                              {-6, aside},
                                              {-6, -aside},
                                              {-12, 2 * aside},
                                              {-12, -2 * aside},
                                              {-12, 0},
                                              {-18, 3 * aside}});
}

TEST(Shapes, FiveMakeAPentagonAroundItsCentre) {
  const auto found = good_places(shape_of(ShapeKind::pentagon), 5);
  for (const Vec3& place : found) EXPECT_NEAR(place.norm(), 3.0, 1e-12);
  EXPECT_NEAR(found[0].x(), 3.0, 1e-12);
  EXPECT_NEAR(least_distance(found), 6.0 * std::sin(kPi / 5.0), 1e-12);
}

TEST(Shapes, EachSideOfAFullPentagonIsEvenlyFilled) {
  const auto found = good_places(shape_of(ShapeKind::pentagon), 15);  // rings of 5 and 10
  for (std::size_t i = 5; i < 15; ++i) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t j = 5; j < 15; ++j) {
      if (i != j) nearest = std::min(nearest, (found[i] - found[j]).norm());
    }
    EXPECT_NEAR(nearest, 6.0 * std::sin(kPi / 5.0), 1e-12);
  }
}

TEST(Shapes, FollowHeadingAndCentre) {
  ShapeSpec shape = shape_of(ShapeKind::column);
  shape.heading_rad = kPi / 2.0;  // north
  shape.centre = {100.0, 200.0, 30.0};
  const auto found = good_places(shape, 2);
  EXPECT_LT((found[0] - Vec3(100.0, 201.5, 30.0)).norm(), 1e-12);
  EXPECT_LT((found[1] - Vec3(100.0, 198.5, 30.0)).norm(), 1e-12);
}

std::vector<Vec3> random_outline(Random& random) {
  std::vector<Vec3> points;
  const std::size_t count = 3 + random.index(20);
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = kTwoPi * static_cast<double>(i) / static_cast<double>(count);
    const Vec2 at = random.uniform(5.0, 20.0) * unit_vector(angle);
    points.emplace_back(at.x(), at.y(), random.uniform(-1.0, 1.0));
  }
  return points;
}

TEST(Shapes, KeepTheirSpacingAndTheirCentre) {
  Random random{1};
  for (std::size_t n = 1; n <= 300; ++n) {
    for (std::size_t kind = 0; kind < static_cast<std::size_t>(ShapeKind::count); ++kind) {
      ShapeSpec shape = shape_of(static_cast<ShapeKind>(kind), random.uniform(0.5, 20.0));
      shape.heading_rad = random.uniform(-10.0, 10.0);
      shape.centre = {random.uniform(-1e3, 1e3), random.uniform(-1e3, 1e3), 50.0};
      shape.points = random_outline(random);
      shape.closed = random.chance(0.5);
      const auto found = places(shape, n);
      if (!found && shape.kind == ShapeKind::free) continue;  // an outline drawn too near to itself
      ASSERT_TRUE(found.ok()) << found.error().message;
      ASSERT_EQ(found->size(), n);
      Vec3 mean = Vec3::Zero();
      for (const Vec3& place : *found) mean += place / static_cast<double>(n);
      EXPECT_LT((mean - shape.centre).norm(), 1e-9);
      EXPECT_GE(least_distance(*found), shape.spacing_m - 1e-9)
          << to_string(shape.kind) << ", n = " << n;
    }
  }
}

TEST(Shapes, NamedOnesFillFromTheLeaderOn) {
  // A vehicle more leaves the others where they were, but for the mean, wherever a row or ring of
  // its own begins or a line goes on.
  for (const ShapeKind kind :
       {ShapeKind::line_abreast, ShapeKind::column, ShapeKind::echelon, ShapeKind::wedge}) {
    const auto many = from_leader(good_places(shape_of(kind), 300));
    for (const std::size_t n : {1U, 2U, 7U, 40U, 299U}) {
      const auto few = from_leader(good_places(shape_of(kind), n));
      for (std::size_t i = 0; i < n; ++i) {
        EXPECT_LT((few[i] - many[i]).norm(), 1e-9) << to_string(kind) << " " << n << " " << i;
      }
    }
  }
}

TEST(FreeShape, StandsAtItsPointsWhenThereIsOneForEach) {
  const std::vector<Vec3> square{{0, 0, 0}, {0, 8, 0}, {-8, 8, 0}, {-8, 0, 2}};
  const auto found = good_places(free_of(square, true), 4);
  const Vec3 mean{-4.0, 4.0, 0.5};
  EXPECT_LT((found[0] - (square[0] - mean)).norm(), 1e-12);
  EXPECT_LT((found[1] - (square[1] - mean)).norm(), 1e-12);  // to both sides of the first
  EXPECT_LT((found[2] - (square[3] - mean)).norm(), 1e-12);
  EXPECT_LT((found[3] - (square[2] - mean)).norm(), 1e-12);
}

TEST(FreeShape, SpreadsMoreOrFewerAlongItsOutline) {
  const std::vector<Vec3> square{{0, 0, 0}, {0, 8, 0}, {-8, 8, 0}, {-8, 0, 0}};
  const auto eight = good_places(free_of(square, true), 8);
  EXPECT_NEAR(least_distance(eight), 4.0, 1e-12);
  const auto two = from_leader(good_places(free_of(square, true), 2));
  EXPECT_LT((two[1] - Vec2(-8, 8)).norm(), 1e-12);
  const auto open = from_leader(good_places(free_of(square, false), 2));
  EXPECT_LT((open[1] - Vec2(-8, 0)).norm(), 1e-12);
  const auto seven = from_leader(good_places(free_of(square, false), 7));
  EXPECT_LT((seven[1] - Vec2(0, 4)).norm(), 1e-12);
  EXPECT_LT((seven[6] - Vec2(-8, 0)).norm(), 1e-12);
}

TEST(FreeShape, GrowsWhereItsPlacesComeTooNearAndIsNeverMadeSmaller) {
  const std::vector<Vec3> square{{0, 0, 0}, {0, 8, 0}, {-8, 8, 0}, {-8, 0, 0}};
  EXPECT_NEAR(least_distance(good_places(free_of(square, true, 20.0), 4)), 20.0, 1e-9);
  EXPECT_NEAR(least_distance(good_places(free_of(square, true, 1.0), 4)), 8.0, 1e-12);
}

TEST(FreeShape, IsRefusedWhereGrowingDoesNotHelp) {
  const auto error = [](const ShapeSpec& shape, std::size_t n) {
    const auto result = places(shape, n);
    return result.ok() ? std::string{"no error"} : result.error().message;
  };
  EXPECT_THAT(error(free_of({}, true), 3), HasSubstr("has 1 to 1000 points, not 0"));
  EXPECT_THAT(error(free_of({{0, 0, 0}}, true), 3), HasSubstr("one point has room for one"));
  EXPECT_EQ(good_places(free_of({{4, 5, 6}}, true), 1).front(), Vec3(0, 0, 0));
  EXPECT_THAT(error(free_of({{0, 0, 0}, {9, 0, 0}}, true), 4), HasSubstr("say that it is open"));
  EXPECT_EQ(good_places(free_of({{0, 0, 0}, {9, 0, 0}}, false), 4).size(), 4U);
  EXPECT_THAT(error(free_of({{1, 1, 0}, {1, 1, 0}}, false), 2), HasSubstr("two of 2 places"));
  EXPECT_THAT(error(free_of({{1, 1, 0}, {1, 1, 0}}, true), 5), HasSubstr("two of 5 places"));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(error(free_of({{0, 0, 0}, {nan, 0, 0}}, true), 2), HasSubstr("beyond 1000 km"));
}

TEST(Shapes, RefuseNumbersOutOfRange) {
  ShapeSpec shape = shape_of(ShapeKind::wedge);
  EXPECT_FALSE(places(shape, 0).ok());
  EXPECT_TRUE(places(shape, kPlacesMax).ok());
  EXPECT_FALSE(places(shape, kPlacesMax + 1).ok());
  shape.spacing_m = 0.0;
  EXPECT_THAT(places(shape, 3).error().message, HasSubstr("spacing"));
  shape.spacing_m = 3.0;
  shape.heading_rad = std::numeric_limits<double>::infinity();
  EXPECT_THAT(places(shape, 3).error().message, HasSubstr("heading"));
}

}  // namespace
}  // namespace skein::formation
