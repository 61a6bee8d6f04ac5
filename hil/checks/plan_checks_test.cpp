// SPDX-License-Identifier: Apache-2.0
#include "test_record.hpp"

namespace skein::checks {
namespace {

using namespace checks::testing;  // most of it: NOLINT(google-build-using-namespace)
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(PlanChecks, AGoodMissionHolds) {
  const auto results = judge(good_record(), {});
  EXPECT_EQ(results.size(), 17U);
  for (const CheckResult& result : results) {
    EXPECT_TRUE(result.held()) << result.name << ": " << result.violations.front().sentence;
    const bool without = result.name == "hazards" || result.name == "standing orders";
    EXPECT_EQ(result.judged == 0U, without) << result.name;
  }
}

TEST(PlanChecks, AnEmptyMissionIsNoPanic) { EXPECT_THAT(failed(RunRecord{}), IsEmpty()); }

TEST(PlanChecks, AVehicleWithoutRecordingIsFoundUnlessItWasLost) {
  RunRecord record = good_record();
  VehicleSpec silent = record.vehicles.front();
  silent.id = VehicleId{9};
  record.vehicles.push_back(silent);
  EXPECT_THAT(failed(record), ElementsAre("recordings"));
  record.lost = {silent.id};
  EXPECT_THAT(failed(record), IsEmpty());
}

TEST(PlanChecks, AGapInATrackIsFound) {
  RunRecord record = good_record();
  auto& track = of(record, kSurveyor).track;
  track.erase(track.begin() + 1600, track.begin() + 1640);
  EXPECT_THAT(only_sentence(check_recordings(record, {})), HasSubstr("a gap of 2.05 s"));
}

TEST(PlanChecks, AGapWhileItsAutopilotHadItAloneIsNone) {
  RunRecord record = good_record();
  auto& track = of(record, kSurveyor).track;
  const Instant from = track[1600].state.time;
  track.erase(track.begin() + 1600, track.begin() + 1640);
  record.left_alone = {{kSurveyor, from, from + std::chrono::seconds{2}}};
  EXPECT_TRUE(check_recordings(record, {}).held());
  record.left_alone.front().vehicle = kFromWest;
  EXPECT_FALSE(check_recordings(record, {}).held());
}

TEST(PlanChecks, AGapAtEitherEndOfATrackIsFound) {
  RunRecord record = good_record();
  auto& begin = of(record, kSurveyor).track;
  begin.erase(begin.begin() + 1, begin.begin() + 41);
  EXPECT_THAT(only_sentence(check_recordings(record, {})), HasSubstr("at 0.00 s has a gap"));
  record = good_record();
  auto& end = of(record, kSurveyor).track;
  end.erase(end.end() - 41, end.end() - 1);
  EXPECT_THAT(only_sentence(check_recordings(record, {})), HasSubstr("a gap of 2.05 s"));
}

TEST(PlanChecks, ATightSegmentIsFoundHoweverShort) {
  RunRecord record = good_record();
  auto& plan = of(record, kSurveyor).plans.front().plan;
  ASSERT_TRUE(plan.path.append(Segment{-1.0 / 149.9, 0.001}));
  EXPECT_THAT(only_sentence(check_turn_radius(record, {})), HasSubstr("149.90 m (limit 150.00 m)"));
  plan.path.segments.back().curvature_per_m = -1.0 / 150.0;
  EXPECT_TRUE(check_turn_radius(record, {}).held());
}

TEST(PlanChecks, ATightHoldIsFound) {
  RunRecord record = good_record();
  of(record, kFromWest).plans.back().plan.tail_curvature_per_m = 1.0 / 100.0;
  EXPECT_THAT(failed(record), ElementsAre("turn radius"));
}

TEST(PlanChecks, ATightFlownTurnIsFoundFromThreePerCent) {
  for (const double share : {0.02, 0.04}) {
    RunRecord record = good_record();
    double heading = 0.0;
    for (auto& point : of(record, kFromSouth).track) {
      point.state.heading_rad = wrap_pi(heading);
      heading += (1.0 + share) / 150.0 * kSpeed * 0.05;
    }
    EXPECT_EQ(check_turn_radius(record, {}).held(), share < 0.03) << share;
  }
}

TEST(PlanChecks, AnAutopilotsTightTurnIsToldAndItsPlansAreJudged) {
  RunRecord record = good_record();
  recording::Recording truth;
  truth.vehicle = kFromSouth;
  record.truths.push_back(truth);
  double heading = 0.0;
  for (auto& point : of(record, kFromSouth).track) {
    point.state.heading_rad = wrap_pi(heading);
    heading += 1.25 / 150.0 * kSpeed * 0.05;
  }
  EXPECT_TRUE(check_turn_radius(record, {}).held());
  EXPECT_THAT(check_turn_radius(record, {}).measured, HasSubstr("80.0 %"));
  of(record, kFromSouth).plans.back().plan.tail_curvature_per_m = 1.0 / 100.0;
  EXPECT_FALSE(check_turn_radius(record, {}).held());
}

TEST(PlanChecks, ACopterMayTurnOnTheSpotButItsPlansMayNot) {
  RunRecord record = good_record();
  spec(record, kFromSouth).airframe = Airframe::copter;
  double heading = 0.0;
  for (auto& point : of(record, kFromSouth).track) {
    point.state.heading_rad = wrap_pi(heading);
    heading += 0.2;
  }
  EXPECT_TRUE(check_turn_radius(record, {}).held());
  of(record, kFromSouth).plans.back().plan.tail_curvature_per_m = 1.0 / 100.0;
  EXPECT_FALSE(check_turn_radius(record, {}).held());
}

TEST(PlanChecks, AJumpBetweenPlansIsFound) {
  RunRecord record = good_record();
  auto& plan = of(record, kFromWest).plans.back();
  plan.plan.path.start.y_m += 12.0;
  EXPECT_THAT(failed(record), ElementsAre("continuity"));
  EXPECT_THAT(only_sentence(check_continuity(record, {})),
              HasSubstr("plan 2 of vehicle 2 starts at 40.00 s 12.0 m and 0.0 deg"));
  plan.plan.path.start.y_m -= 12.0;
  plan.plan.path.start.heading_rad += radians(20.0);
  EXPECT_THAT(only_sentence(check_continuity(record, {})), HasSubstr("20.0 deg"));
}

TEST(PlanChecks, WhatFliesOnWithoutItsProgramStartsFromTheVehicle) {
  RunRecord record = good_record();
  auto& recorded = of(record, kFromWest);
  const auto since = recorded.plans.back().since;
  recorded.plans.back().plan.path.start.y_m += 12.0;
  for (auto& point : recorded.track) {  // it is off its plan, and the new one begins where it is
    if (point.state.time >= since) point.state.y_m += 12.0;
  }
  EXPECT_FALSE(check_continuity(record, {}).held());
  record.agent_ends = {{kFromWest, since, {}}};
  EXPECT_TRUE(check_continuity(record, {}).held());
  // So does what its new program plans first.
  record.agent_ends = {{kFromWest, since - std::chrono::seconds{1}, since}};
  EXPECT_TRUE(check_continuity(record, {}).held());
  recorded.plans.back().plan.path.start.y_m += 12.0;
  EXPECT_THAT(only_sentence(check_continuity(record, {})), HasSubstr("from the vehicle"));
}

TEST(PlanChecks, WhoWasLeftAloneGoesOnFromTheOldPlanOrFromWhereItIs) {
  RunRecord record = good_record();
  auto& recorded = of(record, kFromWest);
  const auto since = recorded.plans.back().since;
  record.left_alone = {{kFromWest, since - std::chrono::seconds{5}, since}};
  EXPECT_TRUE(check_continuity(record, {}).held());  // from the old plan
  recorded.plans.back().plan.path.start.y_m += 12.0;
  EXPECT_THAT(only_sentence(check_continuity(record, {})), HasSubstr("from the vehicle"));
  for (auto& point : recorded.track) {
    if (point.state.time >= since) point.state.y_m += 12.0;
  }
  EXPECT_TRUE(check_continuity(record, {}).held());
  record.left_alone.clear();
  EXPECT_FALSE(check_continuity(record, {}).held());
}

TEST(PlanChecks, AFirstPlanAwayFromTheVehicleIsFound) {
  RunRecord record = good_record();
  of(record, kFromSouth).plans.front().plan.path.start.y_m -= 100.0;
  EXPECT_THAT(only_sentence(check_continuity(record, {})), HasSubstr("100.0 m"));
}

TEST(PlanChecks, PlanNumbersMustGrow) {
  RunRecord record = good_record();
  of(record, kFromWest).plans.back().number = 1;
  EXPECT_THAT(only_sentence(check_continuity(record, {})), HasSubstr("must grow"));
}

TEST(PlanChecks, RangeIsJudgedByTrackAndByPlan) {
  RunRecord record = good_record();
  spec(record, kAssessor).range_m = 4990.0;  // the track is 5000 m, the plan 4550 m
  EXPECT_THAT(only_sentence(check_range(record, {})), HasSubstr("flew 5000 m (range 4990 m)"));
  record = good_record();
  spec(record, kFromSouth).range_m = 5990.0;
  EXPECT_THAT(only_sentence(check_range(record, {})),
              HasSubstr("brings the distance flown to 6000 m"));
}

TEST(PlanChecks, WhatAPlanHasAheadComesToWhatWasFlown) {
  RunRecord record = good_record();
  spec(record, kFromWest).range_m = 6290.0;
  of(record, kFromWest).plans.back().plan = plan_from({-1000.0, 0.0, 0.0}, 40.0, {{0.0, 4300.0}});
  EXPECT_THAT(only_sentence(check_range(record, {})),
              HasSubstr("brings the distance flown to 6300 m"));
}

/// The last 3000 m of the assessor, coming down from so high.
RunRecord landed_from(double height_m) {
  RunRecord record = good_record();
  for (auto& point : of(record, kAssessor).track) {
    if (point.state.distance_flown_m <= 2000.0) continue;
    point.state.phase = FlightPhase::landing;
  }
  for (auto& point : of(record, kAssessor).track) point.state.z_m = height_m;
  of(record, kAssessor).track.back().state.phase = FlightPhase::disarmed;
  spec(record, kAssessor).range_m = 4600.0;  // the plan's 4550 m
  spec(record, kAssessor).landing.approach_m = 100.0;
  return record;
}

TEST(PlanChecks, WhatIsFlownToLandIsAGlideAndTakesNoRange) {
  RunRecord record = landed_from(1.0);
  const double laps_m = 2.0 * kTwoPi * spec(record, kAssessor).planning_radius_m();
  const double enough_m = (3000.0 - 200.0 - laps_m) / 10.0;
  ASSERT_GT(enough_m, 2.0);
  EXPECT_THAT(check_range(landed_from(enough_m + 1.0), {}).violations, IsEmpty());
  EXPECT_THAT(only_sentence(check_range(landed_from(enough_m - 2.0), {})),
              HasSubstr("flew 3000 m to land (a glide there takes"));
}

TEST(PlanChecks, WhoFliesOnAnEmptyBatteryIsFound) {
  RunRecord record = good_record();
  auto& track = of(record, kAssessor).track;
  for (auto& point : track) point.state.battery_percent = 1;
  EXPECT_THAT(failed(record), IsEmpty());
  track.back().state.battery_percent = 0;
  EXPECT_THAT(only_sentence(check_range(record, {})), HasSubstr("a battery that is empty"));
}

TEST(PlanChecks, RangeIsNotTakenOnTheVehiclesWord) {
  RunRecord record = good_record();
  spec(record, kAssessor).range_m = 4990.0;
  for (auto& point : of(record, kAssessor).track) point.state.distance_flown_m = 0.0;
  EXPECT_THAT(failed(record), ElementsAre("range"));
}

}  // namespace
}  // namespace skein::checks
