// SPDX-License-Identifier: Apache-2.0
#include "skein/checks/truth.hpp"

#include "motion.hpp"
#include "test_record.hpp"

namespace skein::checks {
namespace {

using namespace testing;  // NOLINT(google-build-using-namespace)
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// The aircraft of one vehicle really flew some way beside what it believed.
RunRecord one_beside(VehicleId vehicle, const Vec2& by, double higher_m) {
  RunRecord record = good_record();
  recording::Recording truth;
  truth.vehicle = vehicle;
  truth.track = of(record, vehicle).track;
  shift(truth, by);
  for (auto& point : truth.track) point.state.z_m += higher_m;
  record.truths.push_back(truth);
  return record;
}

/// Waits for its formation until 10 s, climbs until 20 s, travels until 30 s, holds until 40 s,
/// from 32 to 38 s in gusts, stands, and sinks to the ground from 50 s on, where it is at 60 s.
/// From its place it is as many cm as it is tens of seconds.
recording::Recording copter_flight(VehicleId vehicle) {
  recording::Recording flight{vehicle, {}, {}, {}, 0};
  for (int i = 0; i < 1400; ++i) {
    const double t_s = 0.05 * i;
    recording::TrackPoint point;
    point.state.time = at_seconds(t_s);
    point.state.x_m = 2.0 * std::clamp(t_s - 20.0, 0.0, 10.0);
    if (t_s >= 32.0 && t_s < 38.0) point.state.x_m += std::sin(kPi * t_s);
    point.state.z_m = std::clamp(t_s - 10.0, 0.0, 10.0) - std::clamp(t_s - 50.0, 0.0, 10.0);
    point.state.phase = t_s < 60.0 ? FlightPhase::flying : FlightPhase::landed;
    point.plan_number = t_s < 10.0 ? 0 : 3;
    point.cross_error_m = t_s < 10.0 || t_s >= 60.0 ? 50.0 : 0.01 * std::floor(t_s / 10.0);
    flight.track.push_back(point);
  }
  return flight;
}

TEST(Truth, OfACopterInFormationItIsHowFarItWasFromItsPlaceByWhatItDid) {
  RunRecord record = one_beside(kFromWest, {3.0, 0.0}, 2.0);
  EXPECT_FALSE(flown_truly(record, {})[0].off_place_m.known()) << "it has plans";
  of(record, kFromWest) = copter_flight(kFromWest);
  const auto on_ground = [](double time_s, mission::EventKind kind) {
    return event(kGroundStation, time_s, kind, {});
  };
  record.ground_events = {on_ground(10.0, mission::EventKind::change_begun),
                          on_ground(30.0, mission::EventKind::formation_held),
                          on_ground(40.0, mission::EventKind::change_begun)};
  auto off = flown_truly(record, {})[0].off_place_m;
  ASSERT_TRUE(off.in_place && off.level && off.climbing);
  EXPECT_EQ(off.in_place->most, 0.04);
  EXPECT_NEAR(off.in_place->rms, std::sqrt(0.5 * (0.03 * 0.03 + 0.04 * 0.04)), 0.001);
  EXPECT_EQ(off.level->most, 0.02);
  EXPECT_NEAR(off.level->rms, 0.02, 1e-9);
  EXPECT_EQ(off.climbing->most, 0.05);
  EXPECT_NEAR(off.climbing->rms, std::sqrt(0.5 * (0.01 * 0.01 + 0.05 * 0.05)), 0.002);

  record.ground_events.clear();  // nobody says that it holds: it moves in the gusts
  off = flown_truly(record, {})[0].off_place_m;
  EXPECT_EQ(off.level->most, 0.03);
}

TEST(Motion, TheJudgesHaveAPlanOfOneAirspeedWhereItIs) {
  TimedPath plan;
  plan.start_time = at_seconds(3.0);
  plan.speed_mps = 25.0;
  plan.tail_curvature_per_m = -0.01;
  plan.set_wind({4.0, -3.0});
  ASSERT_TRUE(plan.path.append(Segment{0.0, 300.0}));
  ASSERT_TRUE(plan.path.append(Segment{0.011, 400.0}));
  for (const double on_time_m : {0.0, 250.0, 700.0}) {
    plan.on_time_m = on_time_m;
    for (double t_s = 0.0; t_s < 90.0; t_s += 1.7) {
      EXPECT_NEAR(plan_distance_m(plan, at_seconds(t_s)), plan.distance_at(at_seconds(t_s)), 1e-3);
    }
  }
  for (const double pace : {1.1, 0.9, 1.0}) plan.paces.push_back(pace);
  for (double t_s = 0.0; t_s < 90.0; t_s += 1.7) {
    EXPECT_NEAR(plan_distance_m(plan, at_seconds(t_s)), plan.distance_at(at_seconds(t_s)), 1e-3);
  }
}

TEST(Truth, IsOfNobodyWhoseTruthIsNotKnown) {
  EXPECT_THAT(flown_truly(good_record(), {}), IsEmpty());
  EXPECT_THAT(deliveries_truly(good_record(), {}), IsEmpty());
}

TEST(Truth, IsMeasuredFromThePlansAsWhatWasBelievedIs) {
  const auto all = flown_truly(one_beside(kFromWest, {3.0, 0.0}, 2.0), {});
  ASSERT_THAT(all, SizeIs(1));
  const FlownTruly& flown = all[0];
  EXPECT_EQ(flown.vehicle, kFromWest);
  EXPECT_GT(flown.believed.points, 100U);
  EXPECT_NEAR(flown.believed.cross_m.most, 0.0, 1e-6);
  EXPECT_NEAR(flown.believed.along_m.most, 0.0, 1e-6);
  EXPECT_NEAR(flown.believed.height_m.most, 0.0, 1e-6);
  // Whichever way it flies, these two have the offset between them.
  EXPECT_NEAR(std::hypot(flown.truly.cross_m.rms, flown.truly.along_m.rms), 3.0, 1e-6);
  EXPECT_NEAR(flown.truly.height_m.rms, 2.0, 1e-9);
  EXPECT_NEAR(flown.apart_m.rms, std::hypot(3.0, 2.0), 1e-6);
  EXPECT_NEAR(flown.apart_m.most, std::hypot(3.0, 2.0), 1e-6);
}

TEST(Truth, CountsFromWhenThePlanIsJoined) {
  RunRecord record = one_beside(kFromWest, {0.0, 0.0}, 0.0);
  record.truths[0].track[0].state.x_m += 500.0;
  EXPECT_NEAR(flown_truly(record, {})[0].truly.cross_m.most, 0.0, 1e-6);
  record.truths[0].track[200].state.x_m += 500.0;
  const PlanErrors errors = flown_truly(record, {})[0].truly;
  EXPECT_NEAR(std::hypot(errors.cross_m.most, errors.along_m.most), 500.0, 1e-6);
}

TEST(Truth, ADeliveryThatWasBelievedGoodIsSeenToMiss) {
  const auto all = deliveries_truly(one_beside(kFromWest, {-5.0, 4.0}, 0.0), {});
  ASSERT_THAT(all, SizeIs(1));
  EXPECT_EQ(all[0].believed.run.vehicle, kFromWest);
  EXPECT_NEAR(all[0].believed.miss_m, 0.0, 0.1);
  EXPECT_NEAR(all[0].truly.miss_m, 4.0, 0.1);           // it flies eastward:
  EXPECT_NEAR(all[0].truly.time_error_s(), 0.1, 0.02);  // 5 m late at 50 m/s
}

}  // namespace
}  // namespace skein::checks
