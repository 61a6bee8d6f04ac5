// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"
#include "skein/domain/hazard.hpp"
#include "skein/domain/path.hpp"
#include "skein/domain/set_down.hpp"
#include "skein/domain/site.hpp"
#include "skein/domain/vehicle.hpp"

namespace skein {
namespace {

static_assert(std::is_trivially_copyable_v<Segment>);

TEST(TimedPath, FliesItsSegmentsThenHoldsForEver) {
  TimedPath plan;
  plan.start_time = at_seconds(10.0);
  plan.speed_mps = 50.0;
  plan.tail_curvature_per_m = 1.0 / 100.0;
  ASSERT_TRUE(plan.path.append(Segment{0.0, 500.0}));
  EXPECT_EQ(plan.end_time(), at_seconds(20.0));
  EXPECT_NEAR(plan.pose_at(at_seconds(15.0)).x_m, 250.0, 1e-9);
  EXPECT_NEAR(plan.pose_at(at_seconds(5.0)).x_m, 0.0, 1e-9);
  // Half an orbit later it is a diameter to the left, and after a whole one back at the end.
  const double half = kPi * 100.0 / 50.0;
  const Pose2 opposite = plan.pose_at(at_seconds(20.0 + half));
  EXPECT_NEAR(opposite.x_m, 500.0, 1e-6);
  EXPECT_NEAR(opposite.y_m, 200.0, 1e-6);
  EXPECT_NEAR(plan.pose_at(at_seconds(20.0 + 2 * half)).y_m, 0.0, 1e-6);
}

TEST(TimedPath, APieceOfItIsFlownTheSame) {
  TimedPath plan;
  plan.speed_mps = 10.0;
  plan.tail_curvature_per_m = -0.02;
  ASSERT_TRUE(plan.path.append(Segment{0.0, 100.0}));
  ASSERT_TRUE(plan.path.append(Segment{0.01, 50.0}));
  const auto piece = plan.piece(60.0, 300.0);
  ASSERT_TRUE(piece);
  EXPECT_EQ(piece->segments.size(), 3U);
  EXPECT_NEAR(piece->length_m(), 240.0, 1e-9);
  for (int d = 0; d <= 240; d += 7) {
    const Pose2 a = piece->pose_at(d);
    const Pose2 b = plan.pose_at_distance(60.0 + d);
    EXPECT_NEAR(a.x_m, b.x_m, 1e-9);
    EXPECT_NEAR(a.y_m, b.y_m, 1e-9);
  }
}

TEST(Hazard, WhatIsKnownAtTheEpochWasKnownBefore) {
  const auto id = [](std::uint16_t number) { return Hazard{.id = {number}}; };
  const std::vector<TimedHazard> all{
      {id(1), Instant{}}, {id(2), at_seconds(5.0)}, {id(3), at_seconds(-1.0)}};
  EXPECT_TRUE(all[0].known_before() && all[2].known_before());
  EXPECT_FALSE(all[1].known_before());
  EXPECT_EQ(hazards_known_at(all, Instant{}).size(), 2U);
  EXPECT_EQ(hazards_known_at(all, at_seconds(5.0)).at(1).id, HazardId{2});
}

/// Some lines and arcs, then an orbit, flown at 25 m/s in a wind of up to 7 m/s.
TimedPath windy(Random& random) {
  TimedPath plan;
  plan.start_time = at_seconds(random.uniform(-5.0, 5.0));
  plan.speed_mps = 25.0;
  plan.tail_curvature_per_m = 1.0 / random.uniform(80.0, 200.0);
  plan.path.start.heading_rad = random.uniform(-kPi, kPi);
  const auto pieces = 1 + random.index(8);
  for (std::size_t i = 0; i < pieces; ++i) {
    const double curvature = random.chance(0.5) ? 0.0 : random.uniform(-0.012, 0.012);
    EXPECT_TRUE(plan.path.append(Segment{curvature, random.uniform(5.0, 700.0)}));
  }
  plan.set_wind(random.uniform(0.5, 7.0) * unit_vector(random.uniform(-kPi, kPi)));
  return plan;
}

TEST(TimedPath, InWindTimesAndDistancesAgreeAndItIsWhereItIsToBeOnTime) {
  Random random{1};
  for (int i = 0; i < 300; ++i) {
    TimedPath plan = windy(random);
    const double length_m = plan.path.length_m();
    if (random.chance(0.7)) plan.on_time_m = random.uniform(0.1, 1.0) * length_m;
    double before_m = 0.0;
    for (double distance_m = 1.0; distance_m < length_m + 1500.0; distance_m += 60.0) {
      const Instant at = plan.time_at(distance_m);
      EXPECT_NEAR(plan.distance_at(at), distance_m, 1e-4);
      EXPECT_GT(at, plan.time_at(before_m));
      const Instant soon = plan.time_at(distance_m + 0.01);
      EXPECT_NEAR(0.01 / to_seconds(soon - at), plan.speed_at_distance(distance_m), 0.05);
      before_m = distance_m;
    }
    EXPECT_EQ(plan.distance_at(plan.start_time - std::chrono::seconds{1}), 0.0);
    EXPECT_NEAR(to_seconds(plan.time_at(plan.on_time_m) - plan.start_time), plan.on_time_m / 25.0,
                1e-6);
    const double lap_m = kTwoPi / plan.tail_curvature_per_m;
    const Instant once = plan.time_at(length_m + lap_m / 3.0);
    EXPECT_NEAR(to_seconds(plan.time_at(length_m + lap_m * 4.0 / 3.0) - once), lap_m / 25.0, 1e-6);
  }
}

TEST(TimedPath, InWindItsAirspeedIsNearlyConstant) {
  Random random{2};
  for (int i = 0; i < 300; ++i) {
    const TimedPath plan = windy(random);
    const Vec2 wind = plan.wind_mps();
    const double share = wind.norm() / plan.speed_mps;
    for (double at_m = 0.0; at_m < plan.path.length_m() + 1000.0; at_m += 25.0) {
      const Vec2 ground =
          plan.speed_at_distance(at_m) * unit_vector(plan.pose_at_distance(at_m).heading_rad);
      const double airspeed_mps = (ground - wind).norm();
      EXPECT_NEAR(airspeed_mps, plan.speed_mps, 1.5 * share * share * plan.speed_mps) << share;
    }
  }
}

TEST(TimedPath, OnTimeItsAirspeedIsNearlyWhatTheWindLeavesOfItsMean) {
  Random random{4};
  for (int i = 0; i < 300; ++i) {
    TimedPath plan = windy(random);
    plan.on_time_m = plan.path.length_m();
    const Vec2 straight = plan.path.end().position() - plan.path.start.position();
    const double v_mps = plan.speed_mps - plan.wind_mps().dot(straight) / plan.on_time_m;
    const double share = plan.wind_mps().norm() / v_mps;
    for (double at_m = 0.0; at_m < plan.on_time_m; at_m += 25.0) {
      const Vec2 ground =
          plan.speed_at_distance(at_m) * unit_vector(plan.pose_at_distance(at_m).heading_rad);
      EXPECT_NEAR((ground - plan.wind_mps()).norm(), v_mps, 2.0 * share * share * v_mps) << share;
    }
  }
}

TEST(TimedPath, WithPacesTheWindIsOfItsHold) {
  Random random{3};
  for (int i = 0; i < 100; ++i) {
    TimedPath plan = windy(random);
    TimedPath paced = plan;
    paced.paces.push_back(random.uniform(0.8, 1.2));
    while (paced.paces.size() <= paced.path.segments.size()) paced.paces.push_back(1.0);
    const double length_m = plan.path.length_m();
    plan.set_wind({0.0, 0.0});
    plan.paces = paced.paces;
    for (double at_m = 0.0; at_m < length_m; at_m += 50.0) {
      EXPECT_EQ(paced.time_at(at_m), plan.time_at(at_m));
      EXPECT_NEAR(paced.distance_at(paced.time_at(at_m)), at_m, 1e-4);
    }
    for (double at_m = length_m; at_m < length_m + 1500.0; at_m += 50.0) {
      EXPECT_NEAR(paced.distance_at(paced.time_at(at_m)), at_m, 1e-4);
      const double passes_s = to_seconds(paced.time_at(at_m + 0.01) - paced.time_at(at_m));
      EXPECT_NEAR(0.01 / passes_s, paced.speed_at_distance(at_m + 0.005), 0.05);
    }
  }
}

TEST(TimedPath, AStrongerWindCountsAsAShareOfItsSpeed) {
  TimedPath plan;
  plan.speed_mps = 10.0;
  plan.set_wind({30.0, 0.0});
  ASSERT_TRUE(plan.path.append(Segment{0.0, 100.0}));
  EXPECT_NEAR(plan.speed_at_distance(50.0), 10.0 / (1.0 - TimedPath::kWindShare), 1e-9);
  EXPECT_NEAR(to_seconds(plan.end_time() - plan.start_time), 10.0 * (1.0 - TimedPath::kWindShare),
              1e-6);
}

TEST(Path, RefusesMoreSegmentsThanItHolds) {
  Path path;
  for (std::size_t i = 0; i < kPathSegmentsMax; ++i) ASSERT_TRUE(path.append(Segment{0.0, 1.0}));
  EXPECT_FALSE(path.append(Segment{0.0, 1.0}));
  EXPECT_TRUE(path.append(Segment{0.0, 0.0})) << "a piece of no length needs no room";
  EXPECT_DOUBLE_EQ(path.length_m(), static_cast<double>(kPathSegmentsMax));
}

TEST(Site, ListsItsTasksInOrder) {
  Site site;
  site.id = SiteId{3};
  site.deliveries.resize(2);
  site.assessments.resize(1);
  const auto tasks = tasks_after_survey(site);
  ASSERT_EQ(tasks.size(), 3U);
  EXPECT_EQ(to_string(tasks[1]), "site 3 deliver 2");
  EXPECT_EQ(to_string(tasks[2]), "site 3 assess 1");
}

TEST(Capabilities, BitsSurviveARoundTripAndNothingElseDoes) {
  Capabilities c;
  c.add(TaskKind::deliver);
  EXPECT_TRUE(c.has(TaskKind::deliver));
  EXPECT_FALSE(c.has(TaskKind::assess));
  EXPECT_EQ(Capabilities::from_bits(c.bits()), c);
  EXPECT_EQ(Capabilities::from_bits(0xF8).bits(), 0);
}

TEST(VehicleState, GoesWhereItsCourseIsAndWhereItHoversItsNose) {
  VehicleState state;
  state.heading_rad = 0.2;
  state.course_rad = -2.6;
  state.groundspeed_mps = 7.0;
  EXPECT_EQ(state.pose_over_ground().heading_rad, -2.6);
  state.groundspeed_mps = 0.3;  // a gust's
  EXPECT_EQ(state.pose_over_ground().heading_rad, 0.2);
  EXPECT_EQ(state.pose().heading_rad, 0.2);
}

TEST(SetDown, ACopterIsLedDownWithoutAStepAndStopsAboveTheGround) {
  constexpr double kRate_mps = -2.0;
  constexpr double kStep_s = 1e-3;
  Climb before = led_down({10.0 - kRate_mps * kStep_s, kRate_mps, 0.0});
  for (double height_m = 10.0; height_m > 0.0; height_m += kRate_mps * kStep_s) {
    const Climb led = led_down({height_m, kRate_mps, 0.0});
    EXPECT_GE(led.height_m, std::max(height_m, kSetDownFrom_m));
    EXPECT_LE(led.rate_mps, 0.0);
    EXPECT_NEAR(led.height_m - before.height_m, before.rate_mps * kStep_s, 2e-3 * kStep_s);
    EXPECT_LE(std::abs(led.rate_mps - before.rate_mps), 0.7 * kStep_s) << "at 0.67 m/s^2";
    before = led;
  }
  EXPECT_DOUBLE_EQ(led_down({3.0, kRate_mps, 0.0}, 3.0).height_m, 3.0) << "no step up, either";
  EXPECT_DOUBLE_EQ(led_down({0.0, 0.0, 0.0}, 3.0).height_m, 1.5);
  EXPECT_DOUBLE_EQ(led_down({0.0, 0.0, 0.0}).height_m, kSetDownFrom_m);
  EXPECT_DOUBLE_EQ(led_down({-1.0, kRate_mps, 0.0}).rate_mps, 0.0);
}

}  // namespace
}  // namespace skein
