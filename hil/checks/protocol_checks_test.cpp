// SPDX-License-Identifier: Apache-2.0
#include "skein/checks/task_runs.hpp"
#include "test_record.hpp"

namespace skein::checks {
namespace {

using namespace checks::testing;  // most of it: NOLINT(google-build-using-namespace)
using mission::EventKind;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(ProtocolChecks, ADeliveryThatBeginsAfterItsVehicleHasHeardThatItIsTakenBackIsFound) {
  RunRecord record = good_record();
  EXPECT_FALSE(check_taken_back(record)) << "nobody has heard such a thing";
  const TaskRun* delivery = nullptr;
  const auto runs = task_runs(record);
  for (const TaskRun& run : runs) {
    if (run.task.kind == TaskKind::deliver) delivery = &run;
  }
  ASSERT_NE(delivery, nullptr);
  const SiteId site = delivery->task.site;
  record.refusals = {{delivery->vehicle, site, "ada", delivery->begin() + Duration{1}}};
  const auto later = check_taken_back(record);
  ASSERT_TRUE(later);
  EXPECT_TRUE(later->held()) << "it had begun";
  record.refusals[0].at = delivery->begin() - Duration{1};
  EXPECT_THAT(failed(record), ElementsAre("taken back"));
  record.refusals[0].vehicle = {99};
  EXPECT_TRUE(check_taken_back(record)->held()) << "another has heard it";
  // By its own word as well.
  of(record, delivery->vehicle)
      .events.push_back(event(delivery->vehicle, to_seconds(delivery->begin()) - 1.0,
                              EventKind::authorisation_withdrawn, delivery->task));
  EXPECT_THAT(failed(record), ElementsAre("taken back"));
}

TEST(ProtocolChecks, ASurveyThatIsToldTwiceIsOneRun) {
  const auto runs = task_runs(good_record());
  ASSERT_EQ(runs.size(), 4U);
  EXPECT_EQ(runs[0].task, kSurvey);
  EXPECT_EQ(runs[0].started, at_seconds(10.0));
  EXPECT_EQ(runs[0].done, at_seconds(30.0));
  EXPECT_EQ(runs[0].planned, at_seconds(10.0));
}

TEST(ProtocolChecks, ADeliveryBeforeTheSurveyIsDoneIsFound) {
  RunRecord record = good_record();
  for (auto& e : of(record, kSurveyor).events) {
    if (e.kind() != EventKind::survey_started) e.time = at_seconds(56.0);
  }
  EXPECT_THAT(failed(record), ElementsAre("precedence"));
  EXPECT_EQ(check_precedence(record, {}).violations.size(), 2U);
}

TEST(ProtocolChecks, ATaskAtASiteNeverSurveyedIsFound) {
  RunRecord record = good_record();
  of(record, kSurveyor).events.clear();
  EXPECT_THAT(failed(record), ElementsAre("precedence", "completion"));
  EXPECT_THAT(check_precedence(record, {}).violations.front().sentence,
              HasSubstr("never surveyed"));
}

TEST(ProtocolChecks, AnAssessmentBeforeItsWaitIsFound) {
  RunRecord record = good_record();
  event_of(record, kAssessor, EventKind::task_started).time = at_seconds(68.0);
  EXPECT_THAT(failed(record), ElementsAre("precedence"));
  EXPECT_THAT(check_precedence(record, {}).violations.front().sentence, HasSubstr("wait 10.0 s"));
}

TEST(ProtocolChecks, WhatMayHaveBeenFlownIsFollowedByItsAssessment) {
  RunRecord record = good_record();
  event_of(record, kFromWest, EventKind::task_started).time = at_seconds(90.0);
  event_of(record, kFromWest, EventKind::task_done).time = at_seconds(95.0);
  EXPECT_FALSE(check_precedence(record, {}).held());
  auto& told = of(record, kSurveyor).events;
  told.push_back(event(kSurveyor, 69.0, EventKind::task_unknown, kEastward));
  EXPECT_FALSE(check_precedence(record, {}).held()) << "by the same coalition";
  for (const auto kind : {EventKind::task_started, EventKind::task_done}) {
    event_of(record, kFromWest, kind).round.coalition.number += 1;
  }
  EXPECT_TRUE(check_precedence(record, {}).held());
  told.back().time = at_seconds(71.0);
  EXPECT_FALSE(check_precedence(record, {}).held()) << "the assessment had begun";
}

TEST(ProtocolChecks, AnAssessmentPlannedBeforeItsWaitIsFound) {
  RunRecord record = good_record();
  set_moment(event_of(record, kAssessor, EventKind::task_done), 69.9);
  const CheckResult result = check_precedence(record, {});
  ASSERT_EQ(result.violations.size(), 2U);
  EXPECT_THAT(result.violations.front().sentence, HasSubstr("was planned at 69.90 s"));
}

TEST(ProtocolChecks, ATaskBeyondAVehiclesCapabilitiesIsFound) {
  RunRecord record = good_record();
  spec(record, kAssessor).capabilities = Capabilities{}.add(TaskKind::deliver);
  EXPECT_THAT(failed(record), ElementsAre("capabilities"));
  EXPECT_THAT(check_capabilities(record, {}).violations.back().sentence,
              HasSubstr("cannot assess"));
}

TEST(ProtocolChecks, MoreDeliveriesThanLoadsAreFound) {
  RunRecord record = good_record();
  spec(record, kFromWest).loads = 0;
  EXPECT_THAT(failed(record), ElementsAre("loads"));
  EXPECT_THAT(only_sentence(check_loads(record, {})), HasSubstr("(carried 0)"));
}

TEST(ProtocolChecks, TwoLeasesOnOneTaskAreFound) {
  RunRecord record = good_record();
  auto& events = of(record, kAssessor).events;
  events.push_back(event(kAssessor, 50.0, EventKind::lease_granted, kEastward, 55.0));
  EXPECT_THAT(failed(record), ElementsAre("leases"));
  EXPECT_THAT(only_sentence(check_leases(record, {})),
              HasSubstr("vehicle 2 and vehicle 4 at once from 50.00 s to 55.00 s"));
}

TEST(ProtocolChecks, ALeaseThatFollowsAnExpiredOneIsFine) {
  RunRecord record = good_record();
  auto& events = of(record, kFromWest).events;
  std::erase_if(events, [](const auto& e) {
    const auto* lease = std::get_if<mission::event::LeaseGranted>(&e.body);
    return lease != nullptr && lease->until > at_seconds(100.0);  // the renewal
  });
  of(record, kAssessor)
      .events.push_back(event(kAssessor, 45.0, EventKind::lease_granted, kEastward, 55.0));
  EXPECT_TRUE(check_leases(record, {}).held());
  of(record, kAssessor).events.back().time = at_seconds(44.9);
  EXPECT_FALSE(check_leases(record, {}).held());
}

TEST(ProtocolChecks, ALeaseEndsWhenTheMemberSaysSo) {
  RunRecord record = good_record();
  of(record, kFromWest).events.push_back(event(kFromWest, 46.0, EventKind::lease_ended, kEastward));
  of(record, kAssessor)
      .events.push_back(event(kAssessor, 50.0, EventKind::lease_granted, kEastward, 55.0));
  EXPECT_TRUE(check_leases(record, {}).held());
}

TEST(ProtocolChecks, LeasesFromTwoLeadersAreFound) {
  RunRecord record = good_record();
  auto grant =
      event(kAssessor, 50.0, EventKind::lease_granted, {SiteId{2}, TaskKind::assess, 0}, 60.0);
  grant.round.coalition.leader = VehicleId{8};
  of(record, kAssessor).events.push_back(grant);
  EXPECT_THAT(only_sentence(check_leases(record, {})), HasSubstr("two leaders at once"));
  // From the leader's own second coalition it is none.
  of(record, kAssessor).events.back().round.coalition = {kSurveyor, InstanceId{77}, 2};
  EXPECT_TRUE(check_leases(record, {}).held());
  // From an earlier life of the same leader it is.
  of(record, kAssessor).events.back().round.coalition.instance = InstanceId{76};
  EXPECT_FALSE(check_leases(record, {}).held());
}

TEST(ProtocolChecks, ADeliveryWithoutAuthorisationIsFound) {
  RunRecord record = good_record();
  record.ground_events.clear();
  EXPECT_THAT(failed(record), ElementsAre("authorisation"));
  EXPECT_THAT(check_authorisation(record, {}).violations.front().sentence,
              HasSubstr("never authorised it"));
}

TEST(ProtocolChecks, AuthorisationIsForOneRoundAndOneSite) {
  RunRecord record = good_record();
  record.ground_events.front().round.number = 2;
  EXPECT_FALSE(check_authorisation(record, {}).held());
  record = good_record();
  record.ground_events.front().task.site = SiteId{2};
  EXPECT_FALSE(check_authorisation(record, {}).held());
}

TEST(ProtocolChecks, ADeliveryStartedBeforeItsAuthorisationIsFound) {
  RunRecord record = good_record();
  record.ground_events.front().time = at_seconds(54.1);
  EXPECT_THAT(check_authorisation(record, {}).violations.front().sentence,
              HasSubstr("authorised only at 54.10 s"));
  record = good_record();
  event_of(record, kFromSouth, EventKind::authorised).time = at_seconds(55.0);
  EXPECT_THAT(only_sentence(check_authorisation(record, {})), HasSubstr("heard of"));
  record = good_record();
  erase_events(record, kFromSouth, EventKind::authorised);
  EXPECT_THAT(only_sentence(check_authorisation(record, {})), HasSubstr("never heard"));
}

TEST(ProtocolChecks, ADeliveryAfterARefusalIsFound) {
  RunRecord record = good_record();
  record.ground_events.push_back(
      event(kGroundStation, 40.0, EventKind::authorisation_refused, kEastward));
  EXPECT_EQ(check_authorisation(record, {}).violations.size(), 2U);
}

TEST(ProtocolChecks, ADeliveryWithNoStartToldStillNeedsAuthorisation) {
  RunRecord record = good_record();
  record.ground_events.clear();
  erase_events(record, kFromWest, EventKind::task_started);
  EXPECT_EQ(check_authorisation(record, {}).violations.size(), 2U);
}

mission::MissionEvent said_by_surveyor(double seconds, mission::EventBody body) {
  return {kSurveyor, at_seconds(seconds), {}, {}, std::move(body)};
}

TEST(ProtocolChecks, WhoTakesUpSomethingUnderAHoldIsFound) {
  using mission::CommandKind;
  namespace event = mission::event;
  const auto with = [](double told, mission::EventBody body) {
    RunRecord record = good_record();
    auto& events = of(record, kSurveyor).events;
    events.insert(events.begin(), {said_by_surveyor(1.0, event::Commanded{CommandKind::hold}),
                                   said_by_surveyor(told, std::move(body))});
    return check_standing_orders(record, {});
  };
  const CheckResult forgotten = with(5.0, event::OrdersKnown{kGroundStation});
  ASSERT_FALSE(forgotten.held());
  EXPECT_THAT(forgotten.violations.front().sentence, HasSubstr("told to hold"));
  EXPECT_TRUE(with(5.0, event::Commanded{CommandKind::resume}).held());
  EXPECT_TRUE(with(5.0, event::OrdersKnown{kAssessor}).held()) << "which may have missed it";
  EXPECT_FALSE(with(1.0, event::OrdersKnown{kAssessor}).held()) << "which has told it of the hold";
}

TEST(ProtocolChecks, WhoHoldsTakesUpNothingOfAnyKind) {
  using mission::CommandKind;
  namespace event = mission::event;
  const auto holds = [](EventKind taken_up) {
    RunRecord record = good_record();
    of(record, kSurveyor).events = {
        said_by_surveyor(1.0, event::Commanded{CommandKind::return_home}),
        said_by_surveyor(5.0, mission::body_of(taken_up))};
    return check_standing_orders(record, {}).held();
  };
  for (const EventKind kind :
       {EventKind::survey_started, EventKind::announced, EventKind::bid_sent, EventKind::confirmed,
        EventKind::lease_granted, EventKind::relief_begun}) {
    EXPECT_FALSE(holds(kind)) << to_string(kind);
  }
  EXPECT_TRUE(holds(EventKind::task_started)) << "what it had begun";
}

TEST(ProtocolChecks, ADeliveryFlownTwiceIsFound) {
  RunRecord record = good_record();
  auto& events = of(record, kAssessor).events;
  events.push_back(event(kAssessor, 95.0, EventKind::task_started, kEastward));
  EXPECT_THAT(only_sentence(check_single_delivery(record, {})),
              HasSubstr("was flown by vehicle 2 at 54.00 s and again by vehicle 4 at 95.00 s"));
  events.push_back(event(kAssessor, 96.0, EventKind::task_failed, kEastward));
  EXPECT_TRUE(check_single_delivery(record, {}).held());
}

TEST(ProtocolChecks, AForgottenTaskIsFoundUnlessTheOperatorRefused) {
  RunRecord record = good_record();
  for (const VehicleId id : {kFromWest, kFromSouth, kAssessor}) {
    erase_events(record, id, EventKind::task_started);
    erase_events(record, id, EventKind::task_done);
  }
  EXPECT_THAT(failed(record), ElementsAre("completion"));
  EXPECT_EQ(check_completion(record, {}).violations.size(), 3U);
  record.ground_events = {event(kGroundStation, 36.0, EventKind::authorisation_refused, kEastward)};
  EXPECT_THAT(failed(record), IsEmpty());
  // By another ground station, which has not heard of the refusal.
  record.ground_events.push_back(event(kGroundStation, 40.0, EventKind::authorised, kEastward));
  EXPECT_THAT(failed(record), IsEmpty());
  record.ground_events = {event(kGroundStation, 40.0, EventKind::authorised, kEastward)};
  EXPECT_THAT(failed(record), ElementsAre("completion"));
}

TEST(ProtocolChecks, ATaskBegunAndNotDoneIsFound) {
  RunRecord record = good_record();
  erase_events(record, kAssessor, EventKind::task_done);
  EXPECT_THAT(only_sentence(check_completion(record, {})), HasSubstr("begun and never done"));
  EXPECT_THAT(failed(record), Contains("completion"));
}

TEST(ProtocolChecks, ATaskThatFailedIsNotDone) {
  RunRecord record = good_record();
  event_of(record, kAssessor, EventKind::task_done) =
      event(kAssessor, 91.0, EventKind::task_failed, kAssessment);
  EXPECT_THAT(only_sentence(check_completion(record, {})), HasSubstr("begun and never done"));
}

TEST(ProtocolChecks, AnArcThatIsLeftForWantOfALeaseAndFlownAgainAreTwoRuns) {
  RunRecord record = good_record();
  auto& events = of(record, kAssessor).events;
  events.insert(events.begin(), {event(kAssessor, 61.0, EventKind::task_started, kAssessment),
                                 event(kAssessor, 62.0, EventKind::lease_ended, kAssessment)});
  const auto runs = task_runs(record);
  ASSERT_EQ(runs.size(), 5U);
  EXPECT_TRUE(runs[3].failed);
  EXPECT_EQ(runs[4].started, at_seconds(70.0));
}

TEST(ProtocolChecks, AnArcThatIsFlownToItsEndWithoutALeaseIsOneRun) {
  RunRecord record = good_record();
  auto& events = of(record, kAssessor).events;
  events.push_back(event(kAssessor, 80.0, EventKind::lease_ended, kAssessment));
  const auto runs = task_runs(record);
  ASSERT_EQ(runs.size(), 4U);
  EXPECT_EQ(runs[3].started, at_seconds(70.0));
  EXPECT_FALSE(runs[3].failed);
  EXPECT_TRUE(check_assessments(record, {}).held());
}

TEST(ProtocolChecks, WhatEndsWithItsAgentIsCutOffAndCountsAsFlown) {
  RunRecord record = good_record();
  erase_events(record, kFromWest, EventKind::task_done);
  EXPECT_THAT(failed(record), ElementsAre("precedence", "completion", "deliveries"));
  record.agent_ends = {{kFromWest, at_seconds(56.0), {}}};
  const auto runs = task_runs(record);
  const auto cut =
      std::find_if(runs.begin(), runs.end(), [](const TaskRun& r) { return r.cut_off; });
  ASSERT_NE(cut, runs.end());
  EXPECT_EQ(cut->task, kEastward);
  EXPECT_THAT(failed(record), ElementsAre("completion"));
  record.excused = {{kEastward, "may have been flown"}};
  EXPECT_THAT(failed(record), IsEmpty());
  EXPECT_THAT(check_completion(record, {}).measured, HasSubstr("1 may have been flown"));
  // When it ended nobody knows; but nothing that comes after it may begin before it did.
  RunRecord early = record;
  for (auto& e : of(early, kFromWest).events) {
    if (e.kind() == EventKind::task_started) e.time = at_seconds(90.0);
  }
  early.agent_ends = {{kFromWest, at_seconds(91.0), {}}};
  EXPECT_FALSE(check_precedence(early, {}).held());
  // It is not to be flown again for that.
  of(record, kAssessor)
      .events.push_back(event(kAssessor, 95.0, EventKind::task_started, kEastward));
  EXPECT_FALSE(check_single_delivery(record, {}).held());
}

TEST(ProtocolChecks, ANewAgentHoldsNoLeaseOfTheOldOne) {
  RunRecord record = good_record();
  auto grant =
      event(kAssessor, 60.0, EventKind::lease_granted, {SiteId{2}, TaskKind::assess, 0}, 110.0);
  grant.round.coalition.leader = VehicleId{8};
  record.agent_ends = {{kAssessor, at_seconds(50.0), at_seconds(58.0)}};
  auto& events = of(record, kAssessor).events;
  std::erase_if(events, [](const auto& e) { return e.time > at_seconds(45.0); });
  events.push_back(grant);
  EXPECT_TRUE(check_leases(record, {}).held());
  record.agent_ends.clear();
  EXPECT_FALSE(check_leases(record, {}).held());
}

}  // namespace
}  // namespace skein::checks
