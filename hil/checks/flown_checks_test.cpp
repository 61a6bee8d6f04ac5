// SPDX-License-Identifier: Apache-2.0
#include "skein/checks/flown.hpp"
#include "test_record.hpp"

namespace skein::checks {
namespace {

using namespace checks::testing;  // most of it: NOLINT(google-build-using-namespace)
using mission::EventKind;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// The same positions, `seconds` later.
TEST(FlownChecks, ThePassIsMeasuredBetweenPoints) {
  RunRecord record = good_record();
  auto& recorded = of(record, kFromWest);
  delay(recorded, 0.333);
  shift(recorded, {0.0, -7.0});
  const auto flown = deliveries_flown(record, {});
  ASSERT_EQ(flown.size(), 2U);
  EXPECT_EQ(flown[0].run.vehicle, kFromWest);
  EXPECT_NEAR(flown[0].time_error_s(), 0.333, 1e-6);
  EXPECT_NEAR(flown[0].miss_m, 7.0, 1e-6);
  EXPECT_NEAR(flown[0].bearing_error_rad, 0.0, 1e-6);
}

TEST(FlownChecks, WhateverIsJudgedHasAMomentToLookAt) {
  RunRecord record = good_record();
  delay(of(record, kFromWest), 0.4);
  std::size_t judged = 0;
  for (const CheckResult& result : judge(record, {})) {
    if (result.judged == 0 || result.name == "separation") continue;  // these two never came near
    ++judged;
    EXPECT_TRUE(result.moment) << result.name;
  }
  EXPECT_GT(judged, 10U);
  // The worst of the two deliveries is the one that was late.
  const auto flown = deliveries_flown(record, {});
  EXPECT_EQ(check_deliveries(record, {}).moment, flown[0].time);
}

TEST(FlownChecks, ALatePassIsFound) {
  RunRecord record = good_record();
  delay(of(record, kFromWest), 1.2);
  const CheckResult result = check_deliveries(record, {});
  ASSERT_EQ(result.violations.size(), 2U);
  EXPECT_THAT(result.violations[0].sentence, HasSubstr("1.20 s off (limit 1.0 s)"));
  EXPECT_THAT(result.violations[1].sentence, HasSubstr("1.20 s after the simultaneous"));
}

TEST(FlownChecks, WhoWasLeftAloneOnItsWayIsExcusedAndTold) {
  RunRecord record = good_record();
  delay(of(record, kFromWest), 1.2);
  const auto flown = deliveries_flown(record, {});
  record.left_alone = {{kFromWest, flown[0].run.begin() - std::chrono::seconds{5},
                        flown[0].run.begin() - std::chrono::seconds{4}}};
  const CheckResult result = check_deliveries(record, {});
  EXPECT_TRUE(result.held());
  ASSERT_EQ(result.excused.size(), 1U);
  EXPECT_THAT(result.excused[0].sentence, HasSubstr("its program stood still"));
  shift(of(record, kFromWest), {0.0, 70.0});
  EXPECT_THAT(only_sentence(check_deliveries(record, {})), HasSubstr("was told as done, though"));
  record.left_alone.front().vehicle = kFromSouth;
  EXPECT_FALSE(check_deliveries(record, {}).held());
}

TEST(FlownChecks, SimultaneousMeansOfEachOther) {
  RunRecord record = good_record();
  delay(of(record, kFromWest), 0.6);
  delay(of(record, kFromSouth), -0.6);
  EXPECT_THAT(only_sentence(check_deliveries(record, {})), HasSubstr("1.20 s after"));
}

TEST(FlownChecks, AMissIsFound) {
  RunRecord record = good_record();
  shift(of(record, kFromSouth), {31.0, 0.0});
  EXPECT_THAT(only_sentence(check_deliveries(record, {})),
              HasSubstr("31.0 m from the site (limit 30 m)"));
}

TEST(FlownChecks, AWrongBearingIsFound) {
  RunRecord record = good_record();
  record.sites.front().deliveries[0].bearing_rad = radians(-6.0);
  EXPECT_THAT(failed(record), ElementsAre("deliveries"));
  EXPECT_THAT(only_sentence(check_deliveries(record, {})), HasSubstr("6.0 deg off its bearing"));
}

TEST(FlownChecks, ADeliveryThatTheTrackDoesNotShowIsFound) {
  RunRecord record = good_record();
  of(record, kFromSouth).track.resize(900);
  EXPECT_THAT(only_sentence(check_deliveries(record, {})), HasSubstr("the track does not show it"));
}

TEST(FlownChecks, ADeliveryAtTheEndOfTheRecordingIsJudged) {
  RunRecord record = good_record();
  auto& track = of(record, kFromSouth).track;
  const Instant planned = deliveries_flown(record, {}).front().run.planned.value();
  std::erase_if(track, [&](const auto& point) { return point.state.time > planned; });
  EXPECT_TRUE(check_deliveries(record, {}).held());
}

TEST(FlownChecks, AnApproachThatOutlastsTheRecordingIsNotJudged) {
  RunRecord record = good_record();
  spec(record, kFromSouth).final_approach_m = 300.0;  // 6 s from 54 s on
  erase_events(record, kFromSouth, EventKind::task_done);
  of(record, kFromSouth).track.resize(1201);
  EXPECT_EQ(check_deliveries(record, {}).violations.size(), 1U);  // it ends at 60 s
  of(record, kFromSouth).track.resize(1199);
  EXPECT_TRUE(check_deliveries(record, {}).held());
}

TEST(FlownChecks, ADeliveryWhoseEndWasNeverToldIsFound) {
  RunRecord record = good_record();
  erase_events(record, kFromSouth, EventKind::task_done);
  EXPECT_THAT(only_sentence(check_deliveries(record, {})), HasSubstr("its end was never told"));
}

TEST(FlownChecks, SlotsAreKept) {
  RunRecord record = good_record();
  record.sites.front().deliveries[1].offset = from_seconds(5.0);
  record.sites.front().assess_wait = from_seconds(5.0);
  auto& south = of(record, kFromSouth);
  shift(south, {0.0, -250.0});  // 5 s behind
  set_moment(event_of(record, kFromSouth, EventKind::task_done), 65.0);
  EXPECT_TRUE(check_deliveries(record, {}).held());
  shift(south, {0.0, -60.0});
  const CheckResult late = check_deliveries(record, {});
  ASSERT_EQ(late.violations.size(), 2U);
  EXPECT_THAT(late.violations[1].sentence, HasSubstr("1.20 s off its slot"));
  set_moment(event_of(record, kFromSouth, EventKind::task_done), 66.0);
  EXPECT_THAT(check_deliveries(record, {}).violations.front().sentence,
              HasSubstr("off its slot beside the others"));
}

TEST(FlownChecks, AnArcIsMeasured) {
  const auto arcs = arcs_flown(good_record(), TaskKind::assess, {});
  ASSERT_EQ(arcs.size(), 1U);
  EXPECT_NEAR(arcs[0].time_error_s(), 0.0, 1e-6);
  EXPECT_NEAR(arcs[0].radius_error_m, 0.0, 1e-6);
  EXPECT_GT(arcs[0].dwell_s, 29.0);  // the hold goes on around the site
}

TEST(FlownChecks, ALateAssessmentIsFound) {
  RunRecord record = good_record();
  delay(of(record, kAssessor), 1.5);
  EXPECT_THAT(only_sentence(check_assessments(record, {})), HasSubstr("1.50 s off"));
}

TEST(FlownChecks, AShortDwellIsFound) {
  RunRecord record = good_record();
  auto& recorded = of(record, kAssessor);
  auto& path = recorded.plans.front().plan.path;
  path.segments.back().length_m = 500.0;
  ASSERT_TRUE(path.append(Segment{0.0, 3000.0}));
  fly(recorded, 100.0, 450.0);
  EXPECT_THAT(failed(record), ElementsAre("assessments"));
  EXPECT_THAT(only_sentence(check_assessments(record, {})),
              HasSubstr("(required 20.00 s within 10 %"));
}

TEST(FlownChecks, AWrongRadiusIsFound) {
  RunRecord record = good_record();
  spec(record, kAssessor).assess_radius_m = 230.0;
  EXPECT_THAT(failed(record), ElementsAre("assessments"));
  spec(record, kAssessor).assess_radius_m = 215.0;
  EXPECT_TRUE(check_assessments(record, {}).held());
}

TEST(FlownChecks, AnArcFromAnotherAngleIsFound) {
  RunRecord record = good_record();
  record.sites.front().assessments.front().start_angle_rad = kPi;
  EXPECT_THAT(only_sentence(check_assessments(record, {})),
              HasSubstr("does not pass its start angle"));
}

TEST(FlownChecks, ASurveyWithoutItsArcIsFound) {
  RunRecord record = good_record();
  auto& recorded = of(record, kSurveyor);
  recorded.plans.front().plan.path.segments.back().curvature_per_m = 0.0;
  fly(recorded, 100.0, 300.0);
  EXPECT_THAT(failed(record), Contains("surveys"));
}

TEST(FlownChecks, WhatCoptersAreToFlyTheyHaveFlown) {
  RunRecord record = good_record();
  Limits limits;
  EXPECT_TRUE(check_copters(record, limits).held()) << "nothing is expected";
  limits.copters_fly.add(TaskKind::survey);
  EXPECT_THAT(only_sentence(check_copters(record, limits)), HasSubstr("no copter has flown"));
  spec(record, kSurveyor).airframe = Airframe::copter;
  const CheckResult result = check_copters(record, limits);
  EXPECT_TRUE(result.held());
  EXPECT_THAT(result.measured, HasSubstr("1 survey"));
  // Told, and not flown.
  of(record, kSurveyor).track.clear();
  EXPECT_FALSE(check_copters(record, limits).held());
}

}  // namespace
}  // namespace skein::checks
