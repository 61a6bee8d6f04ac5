// SPDX-License-Identifier: Apache-2.0
#include "fence_way.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "flight.hpp"
#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"

namespace skein::mission {
namespace {
using namespace std::chrono_literals;

constexpr double kRadius_m = 60.0;
const WayRules kRules{{}, kRadius_m};

Fence square(double half_m) {
  return {{{-half_m, -half_m}, {half_m, -half_m}, {half_m, half_m}, {-half_m, half_m}}, 150.0};
}

/// A star around the origin: some of its corners point inwards.
Fence random_fence(Random& random, bool convex) {
  Fence fence;
  const int corners = 3 + static_cast<int>(random.uniform(1.0, 7.0));
  for (int i = 0; i < corners; ++i) {
    const double reach_m = convex ? 1500.0 : random.uniform(800.0, 2000.0);
    const double at = convex ? random.uniform(0.1, 0.9) : 0.5;
    fence.corners.push_back(reach_m * unit_vector((i + at) * kTwoPi / corners));
  }
  return fence;
}

Vec2 random_place(const Fence& fence, Random& random, double from_m, double to_m) {
  while (true) {
    const Vec2 place{random.uniform(-2000.0, 2000.0), random.uniform(-2000.0, 2000.0)};
    const double inside_m = fence.inside_m(place);
    if (inside_m > from_m && inside_m < to_m) return place;
  }
}

/// There is a circle within the fence on which it can be flown over.
bool has_room(const Fence& fence, const Vec2& point, double radius_m) {
  for (int i = 0; i < 360; ++i) {
    if (fence.inside_m(point + radius_m * unit_vector(radians(i))) >= radius_m) return true;
  }
  return false;
}

VehicleSpec plane() {
  VehicleSpec spec;
  spec.id = VehicleId{1};
  spec.cruise_speed_mps = 25.0;
  spec.turn_radius_m = kRadius_m;
  return spec;
}

/// Of the plan, a lap of its orbit included.
double least_inside_m(const Fence& fence, const TimedPath& timed) {
  double least_m = std::numeric_limits<double>::infinity();
  const double lap_m = kTwoPi / std::abs(timed.tail_curvature_per_m);
  for (double at_m = 0.0; at_m < timed.path.length_m() + lap_m; at_m += 2.0) {
    least_m = std::min(least_m, fence.inside_m(timed.pose_at_distance(at_m).position()));
  }
  return least_m;
}

double nearest_m(const TimedPath& timed, const Vec2& point) {
  double nearest_m = std::numeric_limits<double>::infinity();
  for (double at_m = 0.0; at_m < timed.path.length_m(); at_m += 2.0) {
    nearest_m = std::min(nearest_m, (timed.pose_at_distance(at_m).position() - point).norm());
  }
  return nearest_m;
}

TEST(FenceWay, IsTheShortestWhereThatStaysInside) {
  const Pose2 from{0.0, 0.0, 0.0};
  const Pose2 to{300.0, 100.0, 1.0};
  const auto free = way_within({}, kRules, from, to, {});
  const auto fenced = way_within(square(600.0), kRules, from, to, {});
  ASSERT_TRUE(free && fenced);
  EXPECT_EQ(free->path.length_m(), fenced->path.length_m());
  EXPECT_EQ(fenced->room_m, kFenceRoom_m);
}

TEST(FenceWay, AtAnEdgeItTurnsToTheOtherSide) {
  const Fence fence = square(600.0);
  // Along the northern edge, and back to a place behind: the shorter turn is out over the edge.
  const Pose2 from{0.0, 570.0, 0.0};
  const auto way = way_within(fence, kRules, from, {-500.0, 590.0, kPi}, {});
  ASSERT_TRUE(way);
  EXPECT_GE(way->room_m, 10.0 - 1e-3);
  EXPECT_GE(fence_room_m(fence, way->end, kRadius_m), 0.0) << "and goes on from there";
}

TEST(FenceWay, FromOutsideItComesInWithoutGoingFurtherOut) {
  const Fence fence = square(600.0);
  const auto way = way_within(fence, kRules, {650.0, 0.0, kPi / 2.0}, {0.0, 0.0, kPi}, {});
  ASSERT_TRUE(way);
  EXPECT_GE(way->room_m, -51.0);
  EXPECT_LT(way->end.position().norm(), 1.0);
}

TEST(FenceWay, LegsLeadAroundCorners) {
  // An L: from one arm to the other.
  const Fence fence{{{0, 0}, {2000, 0}, {2000, 500}, {500, 500}, {500, 2000}, {0, 2000}}, 150.0};
  const auto corners = corners_between(fence, {1800.0, 250.0}, {250.0, 1800.0});
  ASSERT_EQ(corners.size(), 1U);
  EXPECT_LT((corners[0] - Vec2{500.0, 500.0}).norm(), 21.0);
  EXPECT_TRUE(corners_between(fence, {1800.0, 250.0}, {100.0, 250.0}).empty());
  EXPECT_TRUE(corners_between({}, {1800.0, 250.0}, {250.0, 1800.0}).empty());
}

class RandomFences : public testing::TestWithParam<bool> {};

TEST_P(RandomFences, SearchesHoldsAndWaysHomeStayInside) {
  Random random{GetParam() ? 11U : 12U};
  int near_edges = 0;
  int points = 0;
  int missed = 0;
  for (int run = 0; run < 75; ++run) {
    const Fence fence = random_fence(random, GetParam());
    std::vector<Vec2> search;
    for (int i = 0; i < 40 && search.size() < 6; ++i) {
      const Vec2 point = random_place(fence, random, 2.0, 60.0);
      if (has_room(fence, point, kRadius_m)) search.push_back(point);
    }
    const Vec2 home = random_place(fence, random, 2.0 * kRadius_m + kFenceRoom_m, 1e4);
    Flight flight{plane(), {}, search};
    flight.set_fence(fence);
    flight.start({home.x(), home.y(), random.uniform(-kPi, kPi)}, {}, 1e6, Instant{});
    const TimedPath searched = flight.plan().timed;
    EXPECT_GE(least_inside_m(fence, searched), -0.5) << run;
    near_edges += least_inside_m(fence, searched) < kFenceRoom_m ? 1 : 0;
    for (const Vec2& point : search) missed += nearest_m(searched, point) > 2.0 ? 1 : 0;
    points += static_cast<int>(search.size());
    // Whenever it is held or sent home.
    for (int i = 0; i < 4; ++i) {
      Flight other = flight;
      const Instant now =
          at_seconds(random.uniform(0.0, to_seconds(searched.end_time() - Instant{})));
      if (i % 2 == 0) {
        other.hold({}, now);
        EXPECT_GE(least_inside_m(fence, other.plan().timed), -0.5) << run << " held";
      } else {
        other.fly_home({}, now);
        EXPECT_GE(least_inside_m(fence, other.plan().timed), -0.5) << run << " sent home";
      }
    }
  }
  EXPECT_GT(near_edges, 60);
  EXPECT_GT(points, 400);
  EXPECT_LE(missed, GetParam() ? 0 : points / 50) << "of " << points;
}

INSTANTIATE_TEST_SUITE_P(Shapes, RandomFences, testing::Bool());

}  // namespace
}  // namespace skein::mission
