// SPDX-License-Identifier: Apache-2.0
// Plans of search areas before a judge that shares nothing with the planner but the geometry of
// paths: it looks at every point of a fine grid, and at every half metre of every route.
#include "skein/planning/area_search.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"

namespace skein::planning {
namespace {

using ::testing::HasSubstr;

constexpr double kStep_m = 0.5;

bool in_polygon(const std::vector<Vec2>& corners, const Vec2& p) {
  double angle = 0.0;  // how often the outline goes around it
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec2 a = corners[i] - p;
    const Vec2 b = corners[(i + 1) % corners.size()] - p;
    angle += std::atan2(cross(a, b), a.dot(b));
  }
  return std::abs(angle) > kPi;
}

struct Judged {
  double covered = 0.0;
  std::string wrong;
};

Judged judge(const AreaProblem& problem, const AreaPlan& plan) {
  Judged judged;
  struct Piece {
    Pose2 from;
    double curvature = 0.0, length_m = 0.0;
  };
  std::vector<Piece> pieces;
  for (const SearchRoute& route : plan.routes) {
    const auto searcher = std::ranges::find_if(
        problem.searchers, [&](const auto& s) { return s.id == route.vehicle; });
    if (searcher == problem.searchers.end()) return {0.0, "somebody else"};
    Pose2 at = searcher->from;
    double length_m = 0.0;
    for (const Path& leg : route.legs) {
      if ((leg.start.position() - at.position()).norm() > 1e-3 ||
          std::abs(wrap_pi(leg.start.heading_rad - at.heading_rad)) > 1e-4) {
        judged.wrong = "a leg begins elsewhere";
      }
      if (leg.curvature_max_per_m() > 1.0 / searcher->radius_m + 1e-9) judged.wrong = "too tight";
      Pose2 from = leg.start;
      for (const Segment& segment : leg.segments) {
        pieces.push_back({from, segment.curvature_per_m, segment.length_m});
        from = advance(from, segment.curvature_per_m, segment.length_m);
      }
      for (double s = 0.0; s < leg.length_m(); s += kStep_m) {
        const Vec2 p = leg.pose_at(s).position();
        for (const Hazard& hazard : problem.hazards) {
          if ((p - hazard.centre).norm() < hazard.radius_m - 1e-6) judged.wrong = "into a hazard";
        }
        if (problem.fence.exists() && !in_polygon(problem.fence.corners, p)) {
          judged.wrong = "out of the fence";
        }
      }
      length_m += leg.length_m();
      at = leg.end();
    }
    const double home_m = searcher->home ? (*searcher->home - at.position()).norm() : 0.0;
    if (length_m + home_m > searcher->range_m) judged.wrong = "past the range";
    if (std::abs(length_m / searcher->speed_mps - route.time_s) > 1e-3) judged.wrong = "its time";
  }
  Vec2 low = problem.corners[0], high = low;
  for (const Vec2& corner : problem.corners) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  const double step = problem.sensor_radius_m / 5.0;
  int all = 0, seen = 0;
  for (double x = low.x() + 0.37 * step; x < high.x(); x += step) {
    for (double y = low.y() + 0.61 * step; y < high.y(); y += step) {
      const Vec2 p{x, y};
      if (!in_polygon(problem.corners, p)) continue;
      if (std::ranges::any_of(problem.hazards, [&](const Hazard& h) {
            return (p - h.centre).norm() < h.radius_m;
          })) {
        continue;
      }
      ++all;
      if (std::ranges::any_of(pieces, [&](const Piece& piece) {
            return distance_to_piece(p, piece.from, piece.curvature, piece.length_m) <=
                   problem.sensor_radius_m + 1e-6;
          })) {
        ++seen;
      }
    }
  }
  judged.covered = all == 0 ? 1.0 : static_cast<double>(seen) / all;
  return judged;
}

/// A star about the middle: concave, without crossings.
std::vector<Vec2> random_area(Random& random, double size_m, bool convex) {
  std::vector<Vec2> corners;
  const auto n = static_cast<int>(convex ? 3 + random.index(5) : 4 + random.index(9));
  const double turn = random.uniform(0.0, kTwoPi);
  const double flat = random.uniform(0.4, 1.0);
  for (int i = 0; i < n; ++i) {
    const double angle = kTwoPi * (i + random.uniform(-0.3, 0.3)) / n;
    const double radius = size_m * (convex ? 1.0 : random.uniform(0.35, 1.0));
    const Vec2 at{radius * std::cos(angle), flat * radius * std::sin(angle)};
    corners.emplace_back(unit_vector(turn).dot(at), left_of(unit_vector(turn)).dot(at));
  }
  return corners;
}

AreaProblem random_problem(Random& random, bool convex, bool barred) {
  AreaProblem problem;
  const double size_m = random.uniform(700.0, 3500.0);
  problem.corners = random_area(random, size_m, convex);
  problem.sensor_radius_m = random.uniform(60.0, 150.0);
  problem.spacing_m = 2.0 * problem.sensor_radius_m * 0.95;
  problem.avoidance.margin_m = 15.0;
  const auto vehicles = static_cast<std::uint16_t>(1 + random.index(6));
  for (std::uint16_t i = 1; i <= vehicles; ++i) {
    const Vec2 at{random.uniform(-size_m, size_m), random.uniform(-size_m, size_m)};
    problem.searchers.push_back({{i},
                                 {at.x(), at.y(), random.uniform(-kPi, kPi)},
                                 random.uniform(16.0, 28.0),
                                 random.uniform(30.0, 70.0),
                                 1e6,
                                 at});
  }
  if (!barred) return problem;
  for (std::uint16_t k = 0; k < 4; ++k) {
    const Hazard hazard{{k},
                        {random.uniform(-size_m, size_m), random.uniform(-size_m, size_m)},
                        random.uniform(40.0, 180.0)};
    const bool on_somebody = std::ranges::any_of(problem.searchers, [&](const Searcher& s) {
      return (s.from.position() - hazard.centre).norm() < hazard.radius_m + 200.0;
    });
    if (!on_somebody) problem.hazards.push_back(hazard);
  }
  const double room = 1.3 * size_m + 200.0;
  problem.fence.corners = {{-room, -room}, {room, -room}, {room, room}, {-room, room}};
  return problem;
}

void report(const char* what, std::vector<double> over) {
  std::ranges::sort(over);
  const auto at = [&](double share) {
    return 100.0 *
           (over[static_cast<std::size_t>(share * static_cast<double>(over.size() - 1))] - 1.0);
  };
  std::printf(
      "%s: %zu areas, time to cover above the bound: median %.1f %%, 90 %% below %.1f %%, most "
      "%.1f %%\n",
      what, over.size(), at(0.5), at(0.9), at(1.0));
}

TEST(AreaSearch, RandomAreasAreCoveredWholeAndNearTheBound) {
  std::vector<double> over, over_long;
  for (const bool convex : {true, false}) {
    Random random{convex ? 1U : 2U};
    for (int i = 0; i < 50; ++i) {
      const AreaProblem problem = random_problem(random, convex, false);
      const auto plan = plan_area(problem);
      ASSERT_TRUE(plan.ok()) << i << ": " << plan.error().message;
      const Judged judged = judge(problem, *plan);
      ASSERT_EQ(judged.wrong, "") << i;
      ASSERT_EQ(judged.covered, 1.0) << i;
      ASSERT_EQ(plan->covered, 1.0) << i;
      ASSERT_TRUE(plan->left_out.empty()) << i;
      // What is soon searched is searched mostly by turns.
      if (plan->bound_s > 300.0) over.push_back(plan->time_s / plan->bound_s);
      if (plan->bound_s > 900.0) over_long.push_back(plan->time_s / plan->bound_s);
    }
  }
  report("bound above 5 min", over);
  report("bound above 15 min", over_long);
  std::ranges::sort(over);
  std::ranges::sort(over_long);
  EXPECT_LT(over[over.size() / 2], 1.35);
  EXPECT_LT(over_long[over_long.size() / 2], 1.25);
}

TEST(AreaSearch, AroundHazardsAndInsideOfTheFence) {
  Random random{3};
  double least = 1.0, sum = 0.0;
  for (int i = 0; i < 24; ++i) {
    const AreaProblem problem = random_problem(random, i % 2 == 0, true);
    const auto plan = plan_area(problem);
    ASSERT_TRUE(plan.ok()) << i << ": " << plan.error().message;
    const Judged judged = judge(problem, *plan);
    EXPECT_EQ(judged.wrong, "") << i;
    EXPECT_GE(judged.covered, plan->covered - 0.01) << i;
    least = std::min(least, judged.covered);
    sum += judged.covered;
  }
  std::printf("covered among hazards: mean %.4f, least %.4f\n", sum / 24.0, least);
  EXPECT_GT(sum / 24.0, 0.99);
}

TEST(AreaSearch, WhatTheRangeDoesNotReachIsLeftOut) {
  AreaProblem problem;
  problem.corners = {{0.0, 0.0}, {3000.0, 0.0}, {3000.0, 2000.0}, {0.0, 2000.0}};
  problem.sensor_radius_m = 100.0;
  problem.spacing_m = 180.0;
  problem.searchers = {{{1}, {-200.0, 0.0, 0.0}, 20.0, 50.0, 12'000.0, Vec2{-200.0, 0.0}},
                       {{2}, {-200.0, 300.0, 0.0}, 20.0, 50.0, 12'000.0, Vec2{-200.0, 0.0}}};
  const auto plan = plan_area(problem);
  ASSERT_TRUE(plan.ok());
  const Judged judged = judge(problem, *plan);
  EXPECT_EQ(judged.wrong, "");
  EXPECT_FALSE(plan->left_out.empty());
  EXPECT_GT(plan->covered, 0.3);
  EXPECT_LT(plan->covered, 0.8);
  EXPECT_NEAR(plan->covered, judged.covered, 0.05);
}

TEST(AreaSearch, ASquareFullOfItsFenceIsCoveredButForWhatNoTurnReaches) {
  AreaProblem problem;
  problem.corners = {{0.0, 0.0}, {1500.0, 0.0}, {1500.0, 1000.0}, {0.0, 1000.0}};
  problem.fence.corners = problem.corners;
  problem.sensor_radius_m = 120.0;
  problem.spacing_m = 210.0;
  problem.searchers = {{{1}, {300.0, 300.0, 0.0}, 20.0, 50.0, 1e6, {}},
                       {{2}, {600.0, 300.0, 0.0}, 20.0, 50.0, 1e6, {}}};
  const auto plan = plan_area(problem);
  ASSERT_TRUE(plan.ok());
  const Judged judged = judge(problem, *plan);
  EXPECT_EQ(judged.wrong, "");
  EXPECT_GT(judged.covered, 0.99);
  std::printf("fence at the area's edge: covered %.4f, %.0f s, bound %.0f s\n", judged.covered,
              plan->time_s, plan->bound_s);
}

TEST(AreaSearch, RefusesWhatIsNoAreaAndWhatIsTooLarge) {
  AreaProblem problem;
  problem.sensor_radius_m = 10.0;
  problem.spacing_m = 18.0;
  problem.searchers = {{{1}, {}, 20.0, 50.0, 1e6, {}}};
  problem.corners = {{0.0, 0.0}, {10.0, 0.0}};
  EXPECT_THAT(plan_area(problem).error().message, HasSubstr("3 to 32 corners"));
  problem.corners = {{0.0, 0.0}, {100.0, 100.0}, {100.0, 0.0}, {0.0, 100.0}};
  EXPECT_THAT(plan_area(problem).error().message, HasSubstr("crosses"));
  problem.corners = {{0.0, 0.0}, {9000.0, 0.0}, {9000.0, 9000.0}, {0.0, 9000.0}};
  EXPECT_THAT(plan_area(problem).error().message, HasSubstr("draw it smaller"));
  problem.searchers.clear();
  EXPECT_THAT(plan_area(problem).error().message, HasSubstr("nobody"));
}

TEST(AreaSearch, WhatWasNotSeenIsWhatIsLeft) {
  const std::vector<Vec2> corners{{0.0, 0.0}, {1000.0, 0.0}, {1000.0, 360.0}, {0.0, 360.0}};
  AreaCells cells{corners, 100.0, {}};
  const std::vector<Lane> lanes{{{50.0, 90.0, 0.0}, 900.0}, {{950.0, 270.0, kPi}, 900.0}};
  EXPECT_EQ(lanes_left(lanes, cells).size(), 2U);
  cells.see({0.0, 90.0}, {1000.0, 90.0});
  cells.see({1000.0, 270.0}, {500.0, 270.0});
  EXPECT_NEAR(cells.share(), 0.78, 0.06);
  const auto left = lanes_left(lanes, cells);
  ASSERT_EQ(left.size(), 1U);
  EXPECT_NEAR(left[0].end().x_m, 50.0, 40.0);
  EXPECT_NEAR(left[0].start.x_m, 430.0, 60.0);
  cells.see({500.0, 270.0}, {0.0, 270.0});
  EXPECT_EQ(cells.seen(), cells.size());
  EXPECT_TRUE(lanes_left(lanes, cells).empty());
}

}  // namespace
}  // namespace skein::planning
