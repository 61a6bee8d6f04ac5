// SPDX-License-Identifier: Apache-2.0
#include "skein/routes/route_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "skein/routes/fly_by.hpp"

namespace skein::routes {
namespace {

/// Two vehicles that fly around a keep-out to either side, a mirror image of each other.
struct Case {
  RouteProblem problem;
  CooperativePlan plan;

  Case() {
    problem.site = {1000, 0};
    problem.hazards = {{.id = HazardId{7}, .centre = {400, 0}, .radius_m = 100}};
    problem.rules = {.last_leg_m = 100, .turn_max_rad = radians(60), .separation_m = 50};
    for (const double side : {1.0, -1.0}) {
      RouteVehicle vehicle{.id = VehicleId{static_cast<std::uint16_t>(side > 0 ? 1 : 2)},
                           .start = {0, 40 * side},
                           .start_heading_rad = side * radians(20),
                           .start_cone_rad = radians(30),
                           .speed_mps = 20,
                           .turn_radius_m = 30,
                           .range_m = 1200,
                           .approach_heading_rad = -side * radians(30)};
      PlannedRoute route{.id = vehicle.id};
      const Vec2 last = problem.site - 150.0 * unit_vector(vehicle.approach_heading_rad);
      route.waypoints = {vehicle.start, {400, 120 * side}, last, problem.site};
      route.length_m = fly_by_length_m(route.waypoints, vehicle.turn_radius_m);
      route.arrival_s = route.length_m / vehicle.speed_mps;
      plan.arrival_s = route.arrival_s;
      problem.vehicles.push_back(vehicle);
      plan.routes.push_back(route);
    }
  }
};

TEST(RouteCheck, AGoodPlanPassesAndIsMeasured) {
  const Case good;
  const CheckReport report = check_routes(good.problem, good.plan);
  EXPECT_TRUE(report.ok()) << (report.ok() ? "" : report.violations.front().message);
  ASSERT_EQ(report.routes.size(), 2U);
  EXPECT_NEAR(report.routes[0].length_m, good.plan.routes[0].length_m, 1e-9);
  EXPECT_NEAR(report.arrival_spread_s, 0.0, 1e-9);
  EXPECT_NEAR(report.routes[0].bearing_error_rad, 0.0, 1e-9);
  // They start 80 m apart and come nearer only on their last legs.
  EXPECT_NEAR(report.separation_m, 80.0, 1e-6);
  EXPECT_EQ(report.separation_at_s, 0.0);
  const double turn = std::abs(turn_at(good.plan.routes[0].waypoints[1],
                                       good.plan.routes[0].waypoints[2], good.problem.site));
  EXPECT_NEAR(report.routes[0].last_straight_m, 150.0 - turn_reach_m(30.0, turn), 1e-9);
  EXPECT_GT(report.routes[0].clearance_m, 0.0);
}

struct Breach {
  std::string expected;
  std::function<void(Case&)> apply;
};

TEST(RouteCheck, EveryRuleIsSeenToBeBroken) {
  const std::vector<Breach> breaches = {
      {"m of hazard 7", [](Case& c) { c.problem.hazards[0].radius_m = 118; }},
      {"m of hazard 7", [](Case& c) { c.problem.rules.clearance_m = 30; }},
      {"m of hazard 7",
       [](Case& c) {
         c.problem.hazards.push_back(
             {.id = HazardId{7}, .kind = HazardKind::ramp, .centre = {600, 60}, .radius_m = 50});
       }},
      {"not begin", [](Case& c) { c.problem.vehicles[0].start.y() += 1; }},
      {"not end at the site", [](Case& c) { c.problem.site.x() += 1; }},
      {"turns overlap", [](Case& c) { c.problem.vehicles[0].turn_radius_m = 2000; }},
      {"deg at once", [](Case& c) { c.problem.rules.turn_max_rad = radians(15); }},
      {"off its start heading", [](Case& c) { c.problem.vehicles[0].start_heading_rad = -1; }},
      {"off its bearing", [](Case& c) { c.problem.vehicles[1].approach_heading_rad += 0.01; }},
      {"last straight leg", [](Case& c) { c.problem.rules.last_leg_m = 145; }},
      {"beyond the range", [](Case& c) { c.problem.vehicles[0].range_m = 1000; }},
      {"s late", [](Case& c) { c.plan.arrival_s -= 0.02; }},
      {"s late", [](Case& c) { c.problem.vehicles[1].arrival_offset_s = 1; }},
      {"s late", [](Case& c) { c.problem.vehicles[1].speed_mps = 21; }},
      {"and says", [](Case& c) { c.plan.routes[0].length_m += 1; }},
      {"m of vehicle 2", [](Case& c) { c.problem.rules.separation_m = 81; }},
      {"waypoints, not", [](Case& c) { c.problem.rules.waypoints_max = 3; }},
      {"another vehicle's", [](Case& c) { c.plan.routes[0].id = VehicleId{9}; }},
      {"one route for each", [](Case& c) { c.plan.routes.pop_back(); }},
      {"not finite", [](Case& c) { c.plan.routes[0].waypoints[1].x() = std::nan(""); }},
  };
  for (const Breach& breach : breaches) {
    Case broken;
    breach.apply(broken);
    const CheckReport report = check_routes(broken.problem, broken.plan);
    EXPECT_TRUE(std::any_of(
        report.violations.begin(), report.violations.end(),
        [&](const Violation& v) { return v.message.find(breach.expected) != std::string::npos; }))
        << breach.expected;
  }
}

TEST(RouteCheck, HeightsSeparateOnlyWhileTheyAreApart) {
  // As below, one vehicle descending through the other's height just after or before they cross.
  RouteProblem problem;
  problem.site = {2000, 0};
  problem.rules = {.last_leg_m = 100, .turn_max_rad = 3.0, .separation_m = 25};
  problem.rules.separation_height_m = 10;
  problem.vehicles = {{.id = VehicleId{1}, .start = {-400, 0}, .speed_mps = 25},
                      {.id = VehicleId{2}, .start = {0, -400}, .speed_mps = 25}};
  problem.vehicles[0].start_height_m = 100;
  CooperativePlan plan;
  plan.routes = {{.id = VehicleId{1}, .waypoints = {{-400, 0}, {2000, 0}}},
                 {.id = VehicleId{2}, .waypoints = {{0, -400}, {0, 400}, {2000, 0}}}};
  const auto too_near = [&] {
    const CheckReport report = check_routes(problem, plan);
    return std::any_of(report.violations.begin(), report.violations.end(), [](const Violation& v) {
      return v.message.find("of vehicle 2") != std::string::npos;
    });
  };
  // 100 m down over 2300 m: at 400 m flown it is at 82.6 m.
  problem.vehicles[1].start_height_m = problem.vehicles[1].arrival_height_m = 95;
  EXPECT_FALSE(too_near());
  problem.vehicles[1].start_height_m = problem.vehicles[1].arrival_height_m = 92.5;
  EXPECT_TRUE(too_near());  // just before they meet
  problem.vehicles[1].start_height_m = problem.vehicles[1].arrival_height_m = 72;
  EXPECT_TRUE(too_near());  // just after
  problem.vehicles[1].start_height_m = problem.vehicles[1].arrival_height_m = 70;
  EXPECT_FALSE(too_near());
  problem.vehicles[0].climb_max = 0.04;
  const CheckReport steep = check_routes(problem, plan);
  EXPECT_TRUE(std::any_of(steep.violations.begin(), steep.violations.end(), [](const Violation& v) {
    return v.message.find("climbs by") != std::string::npos;
  }));
  EXPECT_NEAR(steep.routes[0].climb, -100.0 / 2300.0, 1e-12);
}

TEST(RouteCheck, SeparationIsSeenBetweenAnyTwoMoments) {
  // They cross at a right angle, the second so much later that it passes 30 m / sqrt(2) away.
  RouteProblem problem;
  problem.site = {2000, 0};
  problem.rules = {.last_leg_m = 1, .turn_max_rad = 3.0, .separation_m = 25};
  problem.vehicles = {{.id = VehicleId{1}, .start = {-500, 0}, .speed_mps = 25},
                      {.id = VehicleId{2}, .start = {0, -530}, .speed_mps = 25}};
  CooperativePlan plan;
  plan.routes = {{.id = VehicleId{1}, .waypoints = {{-500, 0}, {2000, 0}}},
                 {.id = VehicleId{2}, .waypoints = {{0, -530}, {0, 530}, {2000, 0}}}};
  const CheckReport report = check_routes(problem, plan);
  EXPECT_NEAR(report.separation_m, 30.0 / std::sqrt(2.0), 1e-3);
  EXPECT_NEAR(report.separation_at_s, 515.0 / 25.0, 1e-3);
}

}  // namespace
}  // namespace skein::routes
