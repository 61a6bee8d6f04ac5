// SPDX-License-Identifier: Apache-2.0
#include "flight.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"

namespace skein::mission {
namespace {
using namespace std::chrono_literals;

VehicleSpec vehicle_with(Recovery recovery) {
  VehicleSpec spec;
  spec.id = VehicleId{1};
  spec.cruise_speed_mps = 50.0;
  spec.turn_radius_m = 150.0;
  spec.recovery = recovery;
  return spec;
}

std::vector<Vec2> random_route(Random& random) {
  constexpr std::size_t kPoints = 12;
  std::vector<Vec2> route;
  route.reserve(kPoints);
  while (route.size() < kPoints) {
    route.emplace_back(random.uniform(-4000.0, 4000.0), random.uniform(-4000.0, 4000.0));
  }
  return route;
}

TEST(Flight, SearchesAsFarAsItsRangeLastsThereAndHome) {
  Random random{7};
  int nearly_all = 0;
  for (int i = 0; i < 200; ++i) {
    Flight flight{vehicle_with(Recovery::home), {}, random_route(random)};
    const Pose2 home{random.uniform(-4000.0, 4000.0), random.uniform(-4000.0, 4000.0),
                     random.uniform(-kPi, kPi)};
    const std::vector<Hazard> hazards{
        {HazardId{1}, {random.uniform(-3000.0, 3000.0), random.uniform(-3000.0, 3000.0)}, 300.0}};
    if ((hazards[0].centre - home.position()).norm() < 1000.0) continue;
    const double range_m = random.uniform(5000.0, 60000.0);
    flight.start(home, hazards, range_m, Instant{});
    const TimedPath& plan = flight.plan().timed;
    // The handover and the way to an orbit come on top; the agent keeps a lap for them.
    const double lap_m = kTwoPi * vehicle_with(Recovery::home).planning_radius_m();
    const double all_m = plan.path.length_m() + flight.way_home_m(plan.path.end(), hazards);
    EXPECT_LE(all_m, range_m + lap_m) << "route " << i;
    nearly_all += all_m > 0.8 * range_m ? 1 : 0;
  }
  EXPECT_GT(nearly_all, 20) << "of routes that end for want of range";
}

TEST(Flight, WhoMayEndAnywhereSpendsItsRangeOnTheRoute) {
  Random random{7};
  const std::vector<Vec2> route = random_route(random);
  const Pose2 home{0.0, 0.0, 0.0};
  Flight returns{vehicle_with(Recovery::home), {}, route};
  Flight stays{vehicle_with(Recovery::anywhere), {}, route};
  returns.start(home, {}, 20000.0, Instant{});
  stays.start(home, {}, 20000.0, Instant{});
  EXPECT_GT(stays.plan().timed.path.length_m(), returns.plan().timed.path.length_m());
  EXPECT_LE(stays.plan().timed.path.length_m(), 20000.0 + 1000.0);
  EXPECT_EQ(stays.way_home_m({3000.0, 0.0, 0.0}, {}), 0.0);
  EXPECT_GE(returns.way_home_m({3000.0, 0.0, 0.0}, {}), 3000.0);
}

TEST(Flight, ARouteIsTakenUpWhereItWasLeft) {
  const std::vector<Vec2> route{{2000.0, 0.0}, {4000.0, 0.0}, {6000.0, 0.0}};
  Flight flight{vehicle_with(Recovery::anywhere), {}, route};
  flight.start({0.0, 0.0, 0.0}, {}, 1e6, Instant{});
  const Instant later = Instant{} + 50s;  // 500 m past the first point
  flight.hold({}, later);
  EXPECT_FALSE(flight.searching());
  flight.search({}, 1e6, later + 30s);
  const TimedPath& plan = flight.plan().timed;
  const double flown_m = plan.distance_at(later + 30s);
  EXPECT_NEAR(plan.path.end().x_m, 6000.0, 1e-6);
  // Had it gone back to the first point, the rest would be 2 km longer at least.
  EXPECT_LT(plan.path.length_m() - flown_m, 3500.0 + 1500.0);
}

std::vector<Vec2> long_route(Random& random) {
  std::vector<Vec2> route;
  for (int i = 0; i < 60; ++i) {
    route.emplace_back(random.uniform(-6000.0, 6000.0), random.uniform(-6000.0, 6000.0));
  }
  return route;
}

TEST(Flight, ARouteThatHasNoRoomInOnePlanIsFlownToItsEnd) {
  Random random{11};
  for (int i = 0; i < 100; ++i) {
    const std::vector<Vec2> route = long_route(random);
    Flight flight{vehicle_with(Recovery::anywhere), {}, route};
    flight.start({0.0, 0.0, random.uniform(-kPi, kPi)}, {}, 1e7, Instant{});
    std::vector<double> nearest_m(route.size(), 1e9);
    int plans = 0;
    Instant t{};
    while (plans < 20) {
      const Instant next = flight.search_goes_on_at();
      const Instant end = std::min(next, flight.plan().timed.end_time());
      EXPECT_GT(end, t) << "a plan that goes nowhere, route " << i;
      for (; t < end; t += 200ms) {
        const Vec2 here = flight.pose_at(t).position();
        for (std::size_t k = 0; k < route.size(); ++k) {
          nearest_m[k] = std::min(nearest_m[k], (here - route[k]).norm());
        }
      }
      ++plans;
      if (next == Instant::max()) break;
      flight.search({}, 1e7, next);
      t = next;
    }
    EXPECT_GE(plans, 3) << "60 ways of three pieces each";
    EXPECT_LT(plans, 20);
    for (const double m : nearest_m) EXPECT_LT(m, 10.0) << "route " << i;
    EXPECT_NE(flight.plan().timed.tail_curvature_per_m, 0.0);
  }
}

/// With the orbit at its end: nobody says when the next plan comes.
TEST(Flight, NoPlanOfALongRouteLeadsIntoAHazard) {
  Random random{12};
  for (int i = 0; i < 200; ++i) {
    const std::vector<Vec2> route = long_route(random);
    std::vector<Hazard> hazards;
    for (std::uint16_t id = 1; id <= 12; ++id) {
      // Many lie beside a waypoint, where one cannot orbit.
      const Vec2& beside = route[random.index(route.size())];
      const double radius_m = random.uniform(20.0, 60.0);
      const Vec2 centre = beside + random.uniform(radius_m + 15.0, radius_m + 100.0) *
                                       unit_vector(random.uniform(-kPi, kPi));
      if (centre.norm() > radius_m + 250.0) hazards.push_back({HazardId{id}, centre, radius_m});
    }
    Flight flight{vehicle_with(Recovery::anywhere), {}, route};
    flight.start({0.0, 0.0, random.uniform(-kPi, kPi)}, hazards, 1e7, Instant{});
    for (int plans = 0; plans < 40; ++plans) {
      const TimedPath& timed = flight.plan().timed;
      EXPECT_TRUE(planning::is_clear(timed.path, hazards)) << "route " << i << ", plan " << plans;
      Path orbit{timed.path.end(), {}};
      const double curvature_per_m = timed.tail_curvature_per_m;
      ASSERT_TRUE(orbit.append(Segment{curvature_per_m, kTwoPi / std::abs(curvature_per_m)}));
      EXPECT_TRUE(planning::is_clear(orbit, hazards)) << "route " << i << ", after plan " << plans;
      const Instant next = flight.search_goes_on_at();
      if (next == Instant::max()) break;
      flight.search(hazards, 1e7, next);
    }
  }
}

TEST(Flight, AChangeOfHeightKeepsPathAndTimesAndLastsOverPlans) {
  Flight flight{vehicle_with(Recovery::home), {}, {{6000.0, 0.0}}};
  flight.start({0.0, 0.0, 0.0}, {}, 1e6, Instant{});
  const FlightPlan before = *flight.poll_plan();
  flight.change_height(0.0, Instant{} + 1s);
  EXPECT_FALSE(flight.poll_plan()) << "it is there";
  flight.change_height(7.0, Instant{} + 2s);
  const auto higher = flight.poll_plan();
  ASSERT_TRUE(higher);
  EXPECT_GT(higher->number, before.number);
  EXPECT_EQ(higher->height_to_m, 7.0);
  EXPECT_EQ(higher->timed.start_time, before.timed.start_time);
  EXPECT_EQ(higher->timed.path.length_m(), before.timed.path.length_m());
  flight.hold({}, Instant{} + 3s);
  EXPECT_EQ(flight.plan().height_to_m, 7.0);
  flight.change_height(0.0, Instant{} + 4s);  // half way up
  EXPECT_NEAR(flight.plan().height_from_m, 4.0, 1e-9);
  EXPECT_EQ(flight.plan().height_to_m, 0.0);
}

TEST(Flight, ARouteGivenBeforeTheMissionIsFlownFirst) {
  TimedPath route;
  route.start_time = Instant{};
  route.speed_mps = 50.0;
  route.tail_curvature_per_m = 1.0 / 165.0;
  route.path.start = {100.0, 200.0, 0.0};
  ASSERT_TRUE(route.path.append(Segment{0.0, 2000.0}));
  Flight flight{vehicle_with(Recovery::home), {}, {{4000.0, 200.0}}};
  flight.start_route(route);
  EXPECT_TRUE(flight.started());
  EXPECT_TRUE(flight.en_route(Instant{} + 39s));
  EXPECT_FALSE(flight.en_route(Instant{} + 41s));
  EXPECT_NEAR(flight.pose_at(Instant{} + 20s).x_m, 1100.0, 1e-9);
  ASSERT_TRUE(flight.poll_plan());
  // What comes between ends it, and home is where it began.
  flight.hold({}, Instant{} + 10s);
  EXPECT_FALSE(flight.en_route(Instant{} + 11s));
  EXPECT_NEAR(flight.way_home_m({100.0, 1200.0, -kPi / 2.0}, {}), 1000.0, 1e-6);
}

TEST(Flight, TheLeadInIsOfTheFirstSearchAndDelaysNothingElse) {
  Flight searches{vehicle_with(Recovery::home), {}, {{0.0, 4000.0}}};
  searches.set_lead_in(3s);
  searches.start({0.0, 0.0, 0.0}, {}, 40'000.0, Instant{});
  EXPECT_NEAR(searches.pose_at(Instant{} + 2900ms).y_m, 0.0, 1e-9) << "straight on";
  EXPECT_GT(searches.pose_at(Instant{} + 4s).y_m, 1.0);
  TimedPath route;
  route.speed_mps = 50.0;
  route.tail_curvature_per_m = 1.0 / 165.0;
  ASSERT_TRUE(route.path.append(Segment{0.0, 2000.0}));
  Flight flight{vehicle_with(Recovery::home), {}, {{4000.0, 200.0}}};
  flight.set_lead_in(3s);
  flight.start_route(route);
  flight.hold({}, Instant{} + 10s);
  EXPECT_GT(std::abs(flight.pose_at(Instant{} + 11s).heading_rad), 0.1) << "it turns at once";
}

TEST(Flight, AWayHomeIsFlownAtItsOwnTimesAlsoInWind) {
  Flight flight{vehicle_with(Recovery::home), {}, {{2000.0, 0.0}}};
  flight.set_wind({8.0, -6.0});
  flight.start({0.0, 0.0, 0.0}, {}, 40'000.0, Instant{});
  flight.fly_home({}, Instant{} + 30s);
  const Pose2 before = flight.pose_at(Instant{} + 32s);
  TimedPath way;
  way.start_time = Instant{} + 40s;
  way.speed_mps = 50.0;
  way.path.start = flight.pose_at(way.start_time);
  ASSERT_TRUE(way.path.append(Segment{0.0, 600.0}));
  ASSERT_TRUE(way.path.append(Segment{1.0 / 165.0, 300.0}));
  way.tail_curvature_per_m = 1.0 / 165.0;
  ASSERT_TRUE(flight.return_along(way, Instant{} + 32s));
  const auto apart_m = [&flight](const Pose2& pose, Instant t) {
    return (flight.pose_at(t).position() - pose.position()).norm();
  };
  EXPECT_LT(apart_m(before, Instant{} + 32s), 1e-3) << "no jump";
  for (Instant t = way.start_time; t <= way.end_time(); t += 1s) {
    EXPECT_LT(apart_m(way.pose_at(t), t), 1e-3);
  }
  EXPECT_TRUE(flight.plan().timed.has_wind()) << "its hold is flown at one airspeed";
}

TEST(Flight, IsAtHomeOnlyWhereAWayHasLedThereAndTriesAgain) {
  Flight flight{vehicle_with(Recovery::home), {}, {{3000.0, 0.0}, {6000.0, 0.0}}};
  flight.start({0.0, 0.0, 0.0}, {}, 1e6, Instant{});
  const Instant out = Instant{} + 60s;
  const std::vector<Hazard> over_home{{HazardId{1}, {0.0, 0.0}, 500.0}};
  flight.fly_home(over_home, out);
  EXPECT_TRUE(flight.homing());
  EXPECT_FALSE(flight.at_home(out + 600s)) << "it orbits where it is";
  const Instant again = flight.tries_home_at();
  ASSERT_GT(again, out);
  ASSERT_LT(again, out + 60s);
  flight.fly_home({}, again);
  EXPECT_EQ(flight.tries_home_at(), Instant::max());
  EXPECT_FALSE(flight.at_home(again + 10s));
  EXPECT_TRUE(flight.at_home(again + 600s));
  EXPECT_LT((flight.pose_at(again + 600s).position() - flight.home()).norm(), 400.0);
}

}  // namespace
}  // namespace skein::mission
