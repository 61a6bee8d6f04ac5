// SPDX-License-Identifier: Apache-2.0
#include "skein/routes/single_route.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>
#include <utility>

#include "skein/paper_routes/paper_world.hpp"

namespace skein::routes {
namespace {

/// The best known of the paper's world, by start; found with 100 times the budget and more.
constexpr std::array kBestKnown = {1.0195, 1.0003, 1.0452};

TEST(SingleRoute, IsWithinOnePercentOfTheBestKnown) {
  for (std::size_t i = 0; i < kBestKnown.size(); ++i) {
    const CurveProblem problem = paper_curve(paper_starts()[i]);
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      const auto route = plan_route(problem, {}, Random{seed});
      ASSERT_TRUE(route.ok());
      EXPECT_LT(route->costs.total, 1.01 * kBestKnown[i]) << i << " " << seed;
      EXPECT_TRUE(route->clear);
      EXPECT_EQ(route->evaluations, 7'500U);
      EXPECT_EQ(route->waypoints.size(), 5U);
      EXPECT_EQ(route->curve.size(), 200U);
    }
  }
}

TEST(SingleRoute, TheSameSeedGivesTheSameRouteAndSmallBudgetsHold) {
  const CurveProblem problem = random_curve(Random{4});
  for (const std::uint64_t budget : {1u, 10u, 500u}) {
    SingleRouteParams params;
    params.evaluations = budget;
    const auto a = plan_route(problem, params, Random{1});
    const auto b = plan_route(problem, params, Random{1});
    ASSERT_TRUE(a.ok() && b.ok());
    EXPECT_EQ(a->evaluations, budget);
    EXPECT_EQ(a->waypoints, b->waypoints);
    EXPECT_EQ(a->costs.total, b->costs.total);
  }
}

/// Worlds where the best way does not look it at first, or only with legs and turns of its own: by
/// the costs of flights, best known of searches with forty times the evaluations.
TEST(SingleRoute, FindsWaysThatDoNotLookBestAtFirst) {
  constexpr std::array<std::pair<std::uint64_t, double>, 4> kWorlds = {
      {{100008, 1.0722}, {100105, 1.1481}, {100226, 1.0701}, {100246, 1.0347}}};
  for (const auto& [world, best_known] : kWorlds) {
    CurveProblem problem = random_curve(Random{world});
    problem.reading = CostReading::of_flights;
    const auto route = plan_route(problem, {}, Random{1});
    ASSERT_TRUE(route.ok());
    EXPECT_LT(route->costs.total, 1.01 * best_known) << world;
    EXPECT_LE(route->evaluations, 7'500U);
    EXPECT_TRUE(route->clear);
  }
}

TEST(SingleRoute, OfFlightsSmallBudgetsHoldAndItCanBeCancelled) {
  CurveProblem problem = random_curve(Random{4});
  problem.reading = CostReading::of_flights;
  for (const std::uint64_t budget : {1u, 300u, 1'100u, 2'000u}) {
    SingleRouteParams params;
    params.evaluations = budget;
    const auto a = plan_route(problem, params, Random{1});
    const auto b = plan_route(problem, params, Random{1});
    ASSERT_EQ(a.ok(), b.ok());
    if (budget == 1 && !a) continue;  // the straight line enters a keep-out
    ASSERT_TRUE(a.ok()) << budget;
    EXPECT_LE(a->evaluations, budget);
    EXPECT_EQ(a->waypoints, b->waypoints);
  }
  SingleRouteParams params;
  std::uint64_t told = 0;
  params.go_on = [&](const SearchProgress& progress) {
    EXPECT_GE(progress.evaluations, told);
    told = progress.evaluations;
    return told < 3'000;
  };
  const auto route = plan_route(problem, params, Random{1});
  ASSERT_TRUE(route.ok());
  EXPECT_TRUE(route->cancelled);
  EXPECT_LT(route->evaluations, 3'500U);
}

TEST(SingleRoute, GoesRoundAWallOfKeepOuts) {
  CurveProblem problem{.start = {0, 500}, .site = {1000, 500}};
  for (int i = 0; i < 5; ++i) {
    problem.hazards.push_back({.kind = HazardKind::keep_out,
                               .centre = {500, 150.0 + 150.0 * i},
                               .radius_m = 80,
                               .peak = 100});
  }
  const auto route = plan_route(problem, {}, Random{1});
  ASSERT_TRUE(route.ok());
  EXPECT_TRUE(route->clear);
  EXPECT_LT(route->costs.length_ratio, 1.6);
}

/// Worlds where the way leads past keep-outs: it is clear of them between samples, too, or refused.
TEST(SingleRoute, EntersNoKeepOut) {
  Random random{5};
  int found = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    CurveProblem problem = random_curve(Random{seed});
    problem.reading = CostReading::of_flights;
    problem.samples = 20 + random.index(200);
    for (RouteHazard& hazard : problem.hazards) hazard.kind = HazardKind::keep_out;
    SingleRouteParams params;
    params.evaluations = 2'000;
    const auto route = plan_route(problem, params, Random{seed});
    if (!route) {
      EXPECT_NE(route.error().message.find("keep-out hazard"), std::string::npos);
      continue;
    }
    ++found;
    EXPECT_TRUE(route->clear);
    EXPECT_LT(route->costs.total, kBarredCost);
    for (std::size_t k = 1; k < route->curve.size(); ++k) {
      for (int i = 0; i <= 20; ++i) {
        const Vec2 at = route->curve[k - 1] + i / 20.0 * (route->curve[k] - route->curve[k - 1]);
        for (const RouteHazard& hazard : problem.hazards) {
          ASSERT_EQ(hazard.value_at(at), 0.0) << seed << " " << k;
        }
      }
    }
  }
  EXPECT_GE(found, 38);
}

TEST(SingleRoute, RefusesWhatCannotBePlanned) {
  CurveProblem problem{.start = {0, 0}, .site = {0, 0}};
  EXPECT_FALSE(plan_route(problem, {}, Random{1}).ok());
  problem.site = {100, 0};
  EXPECT_TRUE(plan_route(problem, {}, Random{1}).ok());
  problem.hazards = {{.id = HazardId{3}, .centre = {100, 0}, .radius_m = 5}};
  const auto inside = plan_route(problem, {}, Random{1});
  ASSERT_FALSE(inside.ok());
  EXPECT_NE(inside.error().message.find("hazard 3"), std::string::npos);
  problem.hazards = {{.centre = {50, 0}, .radius_m = 0}};
  EXPECT_FALSE(plan_route(problem, {}, Random{1}).ok());
  problem.hazards.clear();
  // Walled in.
  problem = {.start = {0, 0}, .site = {1000, 0}};
  for (int i = 0; i < 12; ++i) {
    problem.hazards.push_back({.id = HazardId{static_cast<std::uint16_t>(i + 1)},
                               .centre = 200.0 * unit_vector(i * kTwoPi / 12.0),
                               .radius_m = 80});
  }
  const auto walled = plan_route(problem, {}, Random{1});
  ASSERT_FALSE(walled.ok());
  EXPECT_NE(walled.error().message.find("clear of keep-out hazard"), std::string::npos);
  problem.hazards.clear();
  problem.waypoints = 0;
  EXPECT_FALSE(plan_route(problem, {}, Random{1}).ok());
}

}  // namespace
}  // namespace skein::routes
