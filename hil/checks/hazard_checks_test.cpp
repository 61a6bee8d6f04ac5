// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "test_record.hpp"

namespace skein::checks {
namespace {

using testing::fly;
using testing::good_record;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::kFromSouth;
using testing::kSurveyor;
using testing::of;
using testing::plan_from;
using ::testing::SizeIs;

TEST(HazardChecks, AHazardOnTheWayIsFoundInPlanAndTrack) {
  RunRecord record = good_record();
  record.hazards = {{{HazardId{3}, {0.0, -1500.0}, 100.0}, Instant{}}};
  const CheckResult result = check_hazards(record, {});
  ASSERT_EQ(result.violations.size(), 2U);
  EXPECT_THAT(result.violations[0].sentence, HasSubstr("plan 1 of vehicle 3"));
  EXPECT_THAT(result.violations[1].sentence, HasSubstr("vehicle 3 flew at 30.00 s 100.0 m inside"));
}

TEST(HazardChecks, AHazardBesideTheWayIsNone) {
  RunRecord record = good_record();
  record.hazards = {{{HazardId{3}, {-101.0, -1500.0}, 100.0}, Instant{}}};
  const CheckResult result = check_hazards(record, {});
  EXPECT_TRUE(result.held());
  EXPECT_EQ(result.measured, "least clearance flown 1.0 m");
}

TEST(HazardChecks, WhoIsOutsideOfTheFenceIsFound) {
  RunRecord record = good_record();
  EXPECT_FALSE(check_fence(record)) << "there is none";
  record.fence.corners = {{-4e4, -4e4}, {4e4, -4e4}, {4e4, 4e4}, {-4e4, 4e4}};
  record.fence.height_max_m = 1000.0;
  EXPECT_TRUE(check_fence(record)->held());
  auto& track = of(record, kSurveyor).track;
  track[track.size() / 2].state.z_m = 1010.0;
  const auto above = check_fence(record);
  ASSERT_EQ(above->violations.size(), 1U);
  EXPECT_THAT(above->violations[0].sentence, HasSubstr("10.0 m outside of the fence"));
  track[track.size() / 2].state.x_m = 4.1e4;
  EXPECT_THAT(check_fence(record)->violations[0].sentence, HasSubstr("1000.0 m outside"));
}

TEST(HazardChecks, TheHoldIsJudgedToo) {
  RunRecord record = good_record();
  auto& plan = of(record, kSurveyor).plans.front().plan;
  const Pose2 hold = plan.pose_at_distance(plan.path.length_m() + kPi * 200.0);
  record.hazards = {{{HazardId{3}, {hold.x_m, hold.y_m}, 20.0}, Instant{}}};
  of(record, kSurveyor).track.resize(700);  // it never came there
  EXPECT_THAT(check_hazards(record, {}).violations.size(), 1U);
}

/// Vehicle 3 comes from the south along x = 0 with 50 m/s and a turn radius of 150 m: it is in this
/// circle from 28 s to 32 s, and at 26 s, 200 m before its centre, the last turn that misses it
/// begins. It touches it.
RunRecord record_with_hazard(double known_s) {
  RunRecord record = good_record();
  record.hazards = {{{HazardId{3}, {0.0, -1500.0}, 100.0}, at_seconds(known_s)}};
  return record;
}
constexpr double kLastTurn_s = 26.0;
constexpr double kReaction_s = Limits{}.hazard_reaction_s;

TEST(HazardChecks, AHazardCountsOnlyOnceKnown) {
  EXPECT_TRUE(check_hazards(record_with_hazard(33.0), {}).held());
  EXPECT_THAT(check_hazards(record_with_hazard(33.0), {}).excused, IsEmpty());
  EXPECT_FALSE(check_hazards(record_with_hazard(20.0), {}).held());
}

TEST(HazardChecks, WhatATurnWouldHaveMissedIsNotExcused) {
  const CheckResult result = check_hazards(record_with_hazard(kLastTurn_s - kReaction_s - 0.1), {});
  EXPECT_THAT(result.violations, SizeIs(2));
  EXPECT_THAT(result.excused, IsEmpty());
}

TEST(HazardChecks, WhatNoTurnWouldHaveMissedIsExcusedAndTold) {
  const CheckResult result = check_hazards(record_with_hazard(kLastTurn_s - kReaction_s + 0.1), {});
  EXPECT_THAT(result.violations, IsEmpty());
  ASSERT_THAT(result.excused, SizeIs(1));
  EXPECT_THAT(result.excused.front().sentence, HasSubstr("vehicle 3 could not but be 100.0 m"));
  EXPECT_THAT(result.excused.front().sentence,
              HasSubstr("it was outside after 3.95 s (limit 4.51 s)"));
  EXPECT_THAT(result.measured, HasSubstr("1 could not be avoided"));
}

TEST(HazardChecks, AHazardKnownBeforeTheMissionExcusesNobody) {
  RunRecord record = record_with_hazard(0.0);
  EXPECT_THAT(check_hazards(record, {}).violations, SizeIs(2));
}

TEST(HazardChecks, ATailwindTakesRoomToTurnAndAHeadwindLeavesNoMore) {
  for (const double airspeed_mps : {40.0, 60.0}) {  // 50 m/s over the ground
    RunRecord early = record_with_hazard(kLastTurn_s - kReaction_s - 0.1);
    RunRecord late = record_with_hazard(kLastTurn_s - kReaction_s + 0.1);
    for (RunRecord* record : {&early, &late}) {
      for (auto& point : of(*record, kFromSouth).track) point.state.airspeed_mps = airspeed_mps;
    }
    // Plans turn no tighter over the ground, against a wind either.
    EXPECT_THAT(check_hazards(late, {}).excused, SizeIs(1));
    EXPECT_THAT(check_hazards(early, {}).excused, SizeIs(airspeed_mps < 50.0 ? 1 : 0));
  }
}

TEST(HazardChecks, TheWindIsWhatItWasLater) {
  // From the side, it takes it clear after its last turn in a calm.
  RunRecord record = record_with_hazard(kLastTurn_s - kReaction_s + 0.1);
  for (auto& point : of(record, kFromSouth).track) {
    if (point.state.time < at_seconds(kLastTurn_s + 0.2)) continue;
    point.state.course_rad -= 0.1;
    point.state.groundspeed_mps = 50.0;
  }
  EXPECT_THAT(check_hazards(record, {}).excused, IsEmpty());
  EXPECT_FALSE(check_hazards(record, {}).held());
}

TEST(HazardChecks, WhoIsInsideAtFirstMayLeaveButOnlyByTheShortestWay) {
  // At 29 s it is 50 m inside: straight on it takes 3 s, by a turn a little less.
  RunRecord record = record_with_hazard(29.0 - kReaction_s);
  EXPECT_TRUE(check_hazards(record, {}).held());
  EXPECT_THAT(check_hazards(record, {}).excused, SizeIs(1));

  auto& loiters = of(record, kFromSouth);
  record.hazards.front().hazard.radius_m = 310.0;
  const Pose2 there = loiters.plans.front().plan.pose_at(at_seconds(29.0));
  loiters.plans.push_back({2, at_seconds(29.0), plan_from(there, 29.0, {{1.0 / 150.0, 2000.0}})});
  fly(loiters, 100.0, 300.0);
  record.hazards.front().hazard.centre = there.position() + Vec2{-150.0, 0.0};
  const CheckResult result = check_hazards(record, {});
  ASSERT_THAT(result.violations, SizeIs(2));
  EXPECT_THAT(result.violations[0].sentence, HasSubstr("plan 2 of vehicle 3"));
  EXPECT_THAT(result.violations[1].sentence, HasSubstr("which it should have left at"));
}

TEST(HazardChecks, APlanThatJustLeadsOutIsNoEntryThoughTheTrackIsOutAlready) {
  RunRecord record = record_with_hazard(31.95 - kReaction_s);
  auto& leaves = of(record, kFromSouth);
  for (auto& point : leaves.track) point.state.y_m += 5.0;  // ahead of its plan
  const CheckResult result = check_hazards(record, {});
  EXPECT_THAT(result.violations, IsEmpty());
  EXPECT_THAT(result.excused, IsEmpty());
}

TEST(HazardChecks, WhoComesBackIsNotExcused) {
  RunRecord record = record_with_hazard(kLastTurn_s - kReaction_s + 0.1);
  auto& returns = of(record, kFromSouth);
  const Pose2 beyond = returns.plans.front().plan.pose_at(at_seconds(33.0));
  returns.plans.push_back({2, at_seconds(33.0), plan_from(beyond, 33.0, {{1.0 / 150.0, 2000.0}})});
  fly(returns, 100.0, 300.0);
  const CheckResult result = check_hazards(record, {});
  EXPECT_THAT(result.excused, SizeIs(1));
  ASSERT_THAT(result.violations, SizeIs(2));
  EXPECT_THAT(result.violations[0].sentence, HasSubstr("plan 2 of vehicle 3"));
}

TEST(HazardChecks, WhomItsAutopilotHasAloneIsNotHeldToAnyButItsPlansAre) {
  RunRecord record = good_record();
  record.hazards = {{{HazardId{3}, {0.0, -1500.0}, 100.0}, Instant{}}};
  record.left_alone = {{kFromSouth, at_seconds(20.0), at_seconds(23.0)}};
  // In it from 28 s to 32 s, and for 10 s after the program goes on it may still be on its way
  // back.
  const CheckResult result = check_hazards(record, {});
  ASSERT_EQ(result.violations.size(), 1U);
  EXPECT_THAT(result.violations[0].sentence, HasSubstr("plan 1 of vehicle 3"));
  record.left_alone.front().until = at_seconds(20.5);
  EXPECT_THAT(check_hazards(record, {}).violations, SizeIs(2));
}

TEST(HazardChecks, WhoHasNoProgramKnowsOfAHazardFromItsNextStartOn) {
  RunRecord record = record_with_hazard(20.0);
  record.agent_ends = {{kFromSouth, at_seconds(19.0), at_seconds(25.5)}};
  EXPECT_TRUE(check_hazards(record, {}).held());
  EXPECT_THAT(check_hazards(record, {}).excused, SizeIs(1));
  record.agent_ends = {{kFromSouth, at_seconds(19.0), at_seconds(24.5)}};
  EXPECT_FALSE(check_hazards(record, {}).held());
  record.agent_ends = {{kFromSouth, at_seconds(21.0), at_seconds(25.5)}};
  EXPECT_FALSE(check_hazards(record, {}).held()) << "it had heard of it before its program ended";
  record.agent_ends = {{kFromSouth, at_seconds(19.0), std::nullopt}};
  EXPECT_TRUE(check_hazards(record, {}).held());
  EXPECT_THAT(check_hazards(record, {}).excused, IsEmpty());
}

TEST(HazardChecks, WhoseProgramStandsStillKnowsOfAHazardWhenItGoesOn) {
  RunRecord record = record_with_hazard(20.0);
  record.stood_still = {{kFromSouth, at_seconds(19.0), at_seconds(25.5)}};
  EXPECT_TRUE(check_hazards(record, {}).held());
  EXPECT_THAT(check_hazards(record, {}).excused, SizeIs(1));
  record.stood_still = {{kFromSouth, at_seconds(21.0), at_seconds(25.5)}};
  EXPECT_FALSE(check_hazards(record, {}).held()) << "it had heard of it before";
  record.stood_still = {{VehicleId{99}, at_seconds(19.0), at_seconds(25.5)}};
  EXPECT_FALSE(check_hazards(record, {}).held()) << "another's";
}

}  // namespace
}  // namespace skein::checks
