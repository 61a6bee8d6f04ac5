// SPDX-License-Identifier: Apache-2.0
#include "skein/routes/cooperative.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "skein/paper_routes/paper_world.hpp"
#include "skein/routes/route_check.hpp"

namespace skein::routes {
namespace {

std::string complaints(const CheckReport& report) {
  std::string all;
  for (const Violation& v : report.violations) {
    all += "vehicle " + std::to_string(v.vehicle.value) + " " + v.message + "\n";
  }
  return all;
}

CooperativePlan planned(const RouteProblem& problem, std::uint64_t seed = 1,
                        const RoutePlannerParams& params = {}) {
  auto plan = plan_routes(problem, params, Random{seed});
  EXPECT_TRUE(plan.ok()) << plan.error().message;
  if (!plan) return {};
  const CheckReport report = check_routes(problem, *plan);
  EXPECT_TRUE(report.ok()) << complaints(report);
  EXPECT_GE(plan->arrival_s, plan->bound_s - 1e-9);
  EXPECT_LE(plan->arrival_s, plan->latest_s + 1e-9);
  return *std::move(plan);
}

TEST(Cooperative, ThePapersThreeVehiclesArriveTogetherAlmostAtTheBound) {
  const RouteProblem problem = paper_team();
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    const CooperativePlan plan = planned(problem, seed);
    ASSERT_EQ(plan.routes.size(), 3U);
    EXPECT_NEAR(plan.bound_s * 20.0, 1745.068, 0.001);
    EXPECT_LT(plan.arrival_s, 1.005 * plan.bound_s);
    const CheckReport report = check_routes(problem, plan);
    EXPECT_LT(report.arrival_spread_s, 0.01);
    for (const RouteMeasures& m : report.routes) EXPECT_LT(m.bearing_error_rad, radians(0.1));
  }
}

TEST(Cooperative, SpeedsOffsetsConesAndOpenHazardsAreKeptTo) {
  const std::vector<std::function<void(RouteProblem&)>> changes = {
      [](RouteProblem& p) {
        p.vehicles[0].speed_mps = 16;
        p.vehicles[1].speed_mps = 25;
      },
      [](RouteProblem& p) {
        p.vehicles[1].arrival_offset_s = 5;
        p.vehicles[2].arrival_offset_s = 10;
      },
      [](RouteProblem& p) {
        for (RouteVehicle& v : p.vehicles) {
          v.start_cone_rad = radians(20);
          v.start_heading_rad = radians(120);
        }
      },
      [](RouteProblem& p) { p.rules.detections_closed = false; },
      [](RouteProblem& p) { p.rules.detections_closed = p.rules.ramps_closed = false; },
      [](RouteProblem& p) { p.rules.clearance_m = 3; },
      [](RouteProblem& p) { p.rules.separation_m = 150; },
      [](RouteProblem& p) {
        for (RouteVehicle& v : p.vehicles) v.turn_radius_m = 60;
      },
      [](RouteProblem& p) {
        for (RouteVehicle& v : p.vehicles) v.turn_radius_m = 0.5;
      }};
  for (const auto& change : changes) {
    RouteProblem problem = paper_team();
    change(problem);
    planned(problem);
  }
}

TEST(Cooperative, ClimbsAreFlownInTimeAndHeightsSeparate) {
  RouteProblem problem = paper_team();
  problem.vehicles[1].arrival_height_m = 300;
  problem.vehicles[1].climb_max = 0.15;
  const CooperativePlan plan = planned(problem);
  // 300 m at 15 %, and the last leg level.
  EXPECT_NEAR(plan.bound_s * 20.0, 300 / 0.15 + 100, 1e-6);
  ASSERT_EQ(plan.routes.size(), 3U);
  EXPECT_LE(plan.routes[1].climb, 0.15 + 1e-9);
  EXPECT_GT(plan.routes[1].climb, 0.14);

  // Two that fly the same way, one above the other; at one height they cannot.
  RouteProblem pair;
  pair.site = {2000, 0};
  pair.rules = {.last_leg_m = 100, .separation_m = 50};
  pair.rules.separation_height_m = 25;
  for (const double side : {1.0, -1.0}) {
    RouteVehicle vehicle;
    vehicle.id = VehicleId{static_cast<std::uint16_t>(side > 0 ? 1 : 2)};
    vehicle.start = {0, 30 * side};
    vehicle.speed_mps = 20;
    vehicle.turn_radius_m = 20;
    vehicle.range_m = 2010;
    vehicle.start_height_m = vehicle.arrival_height_m = side > 0 ? 130 : 100;
    pair.vehicles.push_back(vehicle);
  }
  planned(pair);
  pair.vehicles[0].start_height_m = pair.vehicles[0].arrival_height_m = 120;
  RoutePlannerParams quick;
  quick.evaluations = 200;
  quick.reorders = 0;
  quick.corridors_tried = 1;
  EXPECT_FALSE(plan_routes(pair, quick, Random{1}).ok());
  // One descends past the other: they keep apart until it is below.
  pair.vehicles[0].start_height_m = 130;
  pair.vehicles[0].arrival_height_m = 70;
  for (RouteVehicle& vehicle : pair.vehicles) vehicle.range_m = 2300;
  quick.evaluations = 600;
  planned(pair, 1, quick);
}

TEST(Cooperative, RandomTeamsPassTheChecker) {
  for (std::uint64_t world = 0; world < 4; ++world) {
    const CooperativePlan plan = planned(random_team(5, 30, Random{world}));
    EXPECT_LT(plan.arrival_s, 1.01 * plan.bound_s) << world;
  }
}

/// One vehicle that has to turn back: its route is as long as the bound, which is that of lines and
/// arcs.
TEST(Cooperative, TheBoundKnowsTheTurnsAtBothEnds) {
  RouteProblem problem;
  problem.site = {1000, 0};
  problem.rules = {.last_leg_m = 100};
  RouteVehicle& vehicle = problem.vehicles.emplace_back();
  vehicle.id = VehicleId{1};
  vehicle.speed_mps = 20;
  vehicle.turn_radius_m = 50;
  vehicle.approach_heading_rad = kPi;
  const double back_m = 50 * (kPi + 2.0 * std::atan(50.0 / 1100.0));
  CooperativePlan plan = planned(problem);
  EXPECT_NEAR(plan.routes[0].bound_m, 1200 + back_m, 1e-6);
  EXPECT_NEAR(plan.routes[0].length_m, 1200 + back_m, 1e-3);
  // Leaves the other way, too: two half turns to the same side, and a line as long as between
  // their middles.
  vehicle.start_heading_rad = kPi;
  vehicle.start_cone_rad = 0;
  plan = planned(problem);
  EXPECT_NEAR(plan.routes[0].bound_m, 1200 + 2.0 * kPi * 50, 1e-6);
  EXPECT_NEAR(plan.routes[0].length_m, 1200 + 2.0 * kPi * 50, 1e-3);
  // A hazard in the turn: what is known then is the way without it.
  problem.hazards = {{.id = HazardId{1}, .centre = {1160, 50}, .radius_m = 20}};
  plan = planned(problem);
  EXPECT_NEAR(plan.routes[0].bound_m, 1200 + 2.0 * kPi * 50, 1e-6);
}

/// A vehicle that stands in the way goes first, and the others keep the routes that are clear of
/// it: a world that would take 165,306 tries if all were planned anew each time.
TEST(Cooperative, AnotherOrderKeepsTheRoutesThatAreInNobodysWay) {
  EXPECT_LT(planned(random_team(20, 30, Random{50007}), 50007).evaluations, 110'000U);
}

TEST(Cooperative, TheSameSeedGivesTheSamePlan) {
  const RouteProblem problem = random_team(4, 15, Random{3});
  const CooperativePlan a = planned(problem, 5);
  const CooperativePlan b = planned(problem, 5);
  EXPECT_EQ(a.evaluations, b.evaluations);
  EXPECT_EQ(a.total_cost, b.total_cost);
  for (std::size_t i = 0; i < a.routes.size(); ++i) {
    EXPECT_EQ(a.routes[i].waypoints, b.routes[i].waypoints);
  }
}

TEST(Cooperative, SaysWhatIsWrong) {
  const auto message = [](const std::function<void(RouteProblem&)>& change) {
    RouteProblem problem = paper_team();
    change(problem);
    const auto plan = plan_routes(problem, {}, Random{1});
    return plan ? std::string{} : plan.error().message;
  };
  const auto has = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_TRUE(has(message([](auto& p) { p.vehicles.clear(); }), "no vehicle"));
  EXPECT_TRUE(has(message([](auto& p) { p.vehicles[1].speed_mps = 0; }), "vehicle 2: the speed"));
  EXPECT_TRUE(has(message([](auto& p) { p.vehicles[1].turn_radius_m = 0; }), "turn radius"));
  EXPECT_TRUE(has(message([](auto& p) { p.vehicles[1].range_m = 1700; }), "vehicle 2 needs"));
  EXPECT_TRUE(has(message([](auto& p) { p.vehicles[0].range_m = 1500; }), "range is used up"));
  EXPECT_TRUE(has(message([](auto& p) { p.vehicles[0].start = p.hazards[0].centre; }),
                  "starts within hazard 1"));
  EXPECT_TRUE(has(message([](auto& p) { p.site = p.hazards[2].centre; }), "site lies within"));
  EXPECT_TRUE(has(message([](auto& p) { p.vehicles[2].start = p.vehicles[1].start; }), "nearer"));
  EXPECT_TRUE(has(message([](auto& p) { p.rules.waypoints_max = 3; }), "waypoints"));
  EXPECT_TRUE(has(message([](auto& p) {
                    // A ring around the site.
                    for (int i = 0; i < 12; ++i) {
                      p.hazards.push_back(
                          {.centre = p.site + 300.0 * unit_vector(i * kPi / 6.0), .radius_m = 90});
                    }
                  }),
                  "has no way"));
}

/// Two that start and arrive side by side, and have no range for anything else.
RouteProblem side_by_side() {
  RouteProblem problem;
  problem.site = {2000, 0};
  problem.rules = {.last_leg_m = 100, .separation_m = 50};
  for (const double side : {1.0, -1.0}) {
    RouteVehicle vehicle;
    vehicle.id = VehicleId{static_cast<std::uint16_t>(side > 0 ? 1 : 2)};
    vehicle.start = {0, 30 * side};
    vehicle.speed_mps = 20;
    vehicle.turn_radius_m = 20;
    vehicle.range_m = 2010;
    problem.vehicles.push_back(vehicle);
  }
  return problem;
}

TEST(Cooperative, NamesTheVehicleAndTheRuleThatStandInTheWay) {
  const auto reason = [](const RouteProblem& problem) {
    RoutePlannerParams quick;
    quick.evaluations = 200;
    const auto plan = plan_routes(problem, quick, Random{1});
    return plan ? std::string{"none"} : plan.error().message;
  };
  const auto has = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  const std::string near = reason(side_by_side());
  EXPECT_TRUE(has(near, "vehicle 1 came too near to others")) << near;
  EXPECT_TRUE(has(near, "for a common time of 100.01 to 100.")) << near;
  // Vehicle 1 must fly 160 m more than it has to, and its turns are too wide for a detour.
  RouteProblem stiff = side_by_side();
  stiff.rules.separation_m = 0;
  stiff.vehicles[0].start = {0, 0};
  stiff.vehicles[0].turn_radius_m = 3000;
  stiff.vehicles[0].arrival_offset_s = 8;
  stiff.vehicles[0].range_m = 2300;
  const std::string long_way = reason(stiff);
  EXPECT_TRUE(has(long_way, "vehicle 1 has no way of that length")) << long_way;
}

TEST(Cooperative, TriesNoMoreThanItMay) {
  // Nobody can be apart at the start: every order and time would be tried.
  RoutePlannerParams params;
  params.evaluations_all = 20'000;
  std::uint64_t tried = 0;
  params.go_on = [&](const RoutePlanProgress& progress) {
    tried = progress.evaluations;
    return true;
  };
  RouteProblem problem = side_by_side();
  for (RouteVehicle& vehicle : problem.vehicles) vehicle.range_m = 2200;
  problem.rules.separation_m = 59.9;
  problem.rules.last_leg_m = 1900;
  auto plan = plan_routes(problem, params, Random{1});
  ASSERT_FALSE(plan.ok());
  // Not all of it goes into the first times: all that the ranges allow are tried.
  EXPECT_NE(plan.error().message.find("to 107.7"), std::string::npos) << plan.error().message;
  params.evaluations_all = 3'000;
  plan = plan_routes(problem, params, Random{1});
  ASSERT_FALSE(plan.ok());
  EXPECT_NE(plan.error().message.find("within 3000 tries: vehicle"), std::string::npos)
      << plan.error().message;
  EXPECT_GE(tried, params.evaluations_all);
  EXPECT_LT(tried, params.evaluations_all + params.evaluations + params.population);
  // What needs less is found as ever, and what is found is not thrown away for being refined.
  const RouteProblem team = random_team(5, 30, Random{2});
  const CooperativePlan plenty = planned(team, 2);
  params.evaluations_all = plenty.evaluations + 1;
  const CooperativePlan enough = planned(team, 2, params);
  EXPECT_EQ(enough.evaluations, plenty.evaluations);
  EXPECT_EQ(enough.total_cost, plenty.total_cost);
}

TEST(Cooperative, CanBeCancelled) {
  RoutePlannerParams params;
  std::size_t asked = 0;
  params.go_on = [&](const RoutePlanProgress& progress) {
    EXPECT_GT(progress.arrival_s, 0.0);
    return ++asked < 2;
  };
  const auto plan = plan_routes(paper_team(), params, Random{1});
  ASSERT_FALSE(plan.ok());
  EXPECT_EQ(asked, 2U);
  EXPECT_NE(plan.error().message.find("cancelled"), std::string::npos);
}

}  // namespace
}  // namespace skein::routes
