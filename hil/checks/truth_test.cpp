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

TEST(Truth, OfACopterInFormationItIsHowFarItWasFromItsPlace) {
  RunRecord record = one_beside(kFromWest, {3.0, 0.0}, 2.0);
  EXPECT_FALSE(flown_truly(record, {})[0].off_place_m) << "it has plans";
  auto& believed = of(record, kFromWest);
  believed.plans.clear();
  for (auto& point : believed.track) {
    point.plan_number = 3;
    point.cross_error_m = 0.3;
  }
  believed.track.front().cross_error_m = 0.9;
  believed.track.back() = believed.track.front();
  believed.track.back().plan_number = 0;  // not yet in formation
  believed.track.back().cross_error_m = 50.0;
  const auto flown = flown_truly(record, {});
  ASSERT_TRUE(flown[0].off_place_m);
  EXPECT_EQ(flown[0].off_place_m->most, 0.9);
  EXPECT_NEAR(flown[0].off_place_m->rms, 0.3, 0.01);
}

TEST(Motion, TheJudgesHaveAPlanOfOneAirspeedWhereItIs) {
  TimedPath plan;
  plan.start_time = at_seconds(3.0);
  plan.speed_mps = 25.0;
  plan.tail_curvature_per_m = -0.01;
  plan.wind_east_mps = 4.0;
  plan.wind_north_mps = -3.0;
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
