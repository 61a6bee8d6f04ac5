// SPDX-License-Identifier: Apache-2.0
// What a vehicle knows of itself: what is left of its range, and what it can fly.
#include "ownship.hpp"

#include <gtest/gtest.h>

#include "agent_parts_test.hpp"

namespace skein::mission {
namespace {

/// Whatever it does until it looks again, it comes home: a metre of flight brings it at most a
/// metre further away, and the way back takes a turn.
TEST(Ownship, LooksAtItsRangeAgainWhileItCanStillComeHome) {
  PartsBench bench;
  const double turn_m = kTwoPi * bench.ownship.planning_radius_m();
  const double there_m = bench.ownship.lasts_s(bench.ownship.spare_m(bench.now)) * kTestSpeed_mps;
  EXPECT_LE(2.0 * there_m + turn_m, bench.ownship.range_left(bench.now));
  EXPECT_GT(2.0 * there_m + turn_m, 0.9 * bench.ownship.range_left(bench.now)) << "and no sooner";
}

/// Else it would be awarded what it cannot come home from.
TEST(Ownship, WhatIsLeftForASiteIsWithoutTheWayHomeFromThere) {
  PartsBench bench;
  Site near = test_site(1);
  Site far = test_site(2);
  near.position = {500.0, 0.0};
  far.position = {2500.0, 0.0};
  const double near_m = bench.ownship.range_for(near, bench.now);
  EXPECT_NEAR(near_m - bench.ownship.range_for(far, bench.now), 2000.0, 50.0);
  EXPECT_LT(near_m, bench.ownship.range_to_spend(bench.now) - 400.0);
}

/// With the margin that wind and gusts take.
TEST(Ownship, PlansWithWiderTurnsThanItCanFly) {
  VehicleAgentConfig config = plane_config();
  config.vehicle.turn_radius_margin = 1.25;
  PartsBench bench{config};
  const planning::Candidate self = bench.ownship.candidate(Pose2{}, bench.now);
  EXPECT_DOUBLE_EQ(self.planning_radius_m, 1.25 * config.vehicle.turn_radius_m);
}

TEST(Ownship, AnOrbitToEitherSideStaysInTheFence) {
  VehicleAgentConfig config = plane_config();
  config.fence.corners = {{-500.0, -500.0}, {1000.0, -500.0}, {1000.0, 900.0}, {-500.0, 900.0}};
  config.fence.height_max_m = 500.0;
  PartsBench bench{config};
  constexpr double kRadius_m = 100.0;
  for (const double side : {1.0, -1.0}) {
    // Northwards beside the eastern edge, and beside the western one.
    Path east{{900.0, 0.0, kPi / 2.0}, {}};
    ASSERT_TRUE(east.append(Segment{0.0, 100.0}));
    Path west{{-400.0, 0.0, kPi / 2.0}, {}};
    ASSERT_TRUE(west.append(Segment{0.0, 100.0}));
    EXPECT_EQ(bench.ownship.stays_in_fence(east, side / kRadius_m), side > 0.0);
    EXPECT_EQ(bench.ownship.stays_in_fence(west, side / kRadius_m), side < 0.0);
  }
}

/// Who would fly on to its end would have to fly into the hazard behind it.
TEST(Ownship, AWayThatEndsWhereNoTurnMissesAHazardIsNotOpen) {
  for (const double beyond_m : {60.0, 300.0}) {
    PartsBench bench;
    const Instant at = bench.now + std::chrono::seconds{2};
    Path way{bench.ownship.flight().pose_at(at), {}};
    ASSERT_TRUE(way.append(Segment{0.0, 500.0}));
    ASSERT_TRUE(bench.ownship.flight().continue_with(at, way, 0.01, bench.now));
    const Pose2 end = way.end();
    const Vec2 centre = end.position() + beyond_m * unit_vector(end.heading_rad);
    ASSERT_TRUE(bench.ownship.on_hazard({{HazardId{1}, centre, 50.0}}));
    EXPECT_EQ(bench.ownship.way_is_open(bench.now), beyond_m > 100.0);
  }
}

/// Gusts take it some metres off.
TEST(Ownship, InWindAWayIsNotOpenBesideAHazardThatHasJustBecomeKnown) {
  for (const bool heeds_wind : {false, true}) {
    VehicleAgentConfig config = plane_config();
    config.heeds_wind = heeds_wind;
    PartsBench bench{config};
    const Instant at = bench.now + std::chrono::seconds{2};
    Path way{bench.ownship.flight().pose_at(at), {}};
    ASSERT_TRUE(way.append(Segment{0.0, 500.0}));
    ASSERT_TRUE(bench.ownship.flight().continue_with(at, way, 0.01, bench.now));
    const Pose2 middle = way.pose_at(250.0);
    const HazardId id{1};
    const Vec2 centre = middle.position() + 53.0 * unit_vector(middle.heading_rad + kPi / 2.0);
    ASSERT_TRUE(bench.ownship.on_hazard({{id, centre, 50.0}}));
    EXPECT_TRUE(bench.ownship.way_is_open(bench.now));
    EXPECT_EQ(bench.ownship.way_is_open(bench.now, id), !heeds_wind);
  }
}

/// Whatever it orbits for: what it began with is some way off its circle in another wind.
TEST(Ownship, PlansAnewInAnotherWindWhatNobodyCountsWith) {
  VehicleAgentConfig config = plane_config();
  config.heeds_wind = true;
  using enum CommandKind;
  for (const CommandKind order : {hold, return_home, resume}) {
    FlownAgent vehicle{config};
    vehicle.fly(2.0);
    vehicle.order(order);
    vehicle.fly(120.0);
    EXPECT_LT(vehicle.plan.timed.wind_mps().norm(), 1e-6);
    const double calm_per_m = std::abs(vehicle.plan.timed.tail_curvature_per_m);
    vehicle.wind_mps = {0.0, 7.0};
    vehicle.fly(60.0);
    EXPECT_NEAR(vehicle.plan.timed.wind_mps().y(), 7.0, 1.5);
    EXPECT_LT(std::abs(vehicle.plan.timed.tail_curvature_per_m), 0.8 * calm_per_m);
  }
}

TEST(Ownship, LeavesInAnotherWindWhatOthersCountWith) {
  PartsBench bench;
  const Instant at = bench.now + std::chrono::seconds{2};
  Path way{bench.ownship.flight().pose_at(at), {}};
  ASSERT_TRUE(way.append(Segment{0.0, 500.0}));
  ASSERT_TRUE(bench.ownship.flight().continue_with(at, way, 0.01, bench.now));
  const std::uint32_t number = bench.ownship.flight().plan().number;
  EXPECT_FALSE(bench.ownship.plans_anew(bench.now));
  EXPECT_EQ(bench.ownship.flight().plan().number, number);
  bench.ownship.hold(bench.now);
  EXPECT_TRUE(bench.ownship.plans_anew(bench.now));
}

}  // namespace
}  // namespace skein::mission
