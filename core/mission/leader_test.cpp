// SPDX-License-Identifier: Apache-2.0
#include "leader.hpp"

#include <gtest/gtest.h>

#include "agent_parts_test.hpp"

namespace skein::mission {
namespace {

using State = Leader::State;
constexpr VehicleId kMember{5};

/// A leader of a site with one delivery, and another vehicle that does what it is asked.
struct Leading : PartsBench {
  Leading() { leader.lead({test_site(1), {}}, now); }

  template <class T>
  [[nodiscard]] std::optional<T> said() {
    std::optional<T> found;
    while (auto message = leader.poll_message()) {
      if (const auto* wanted = std::get_if<T>(&*message)) found = *wanted;
    }
    return found;
  }
  void hear(const coalition::Message& message) {
    EXPECT_FALSE(leader.on_message(message, now));
    work();
  }
  void work() {
    while (leader.answer_next(now)) {
    }
  }
  void wait_until(double seconds) {
    be_at(seconds);
    leader.on_timeout(now);
    leader.repeat(now);
    work();
  }
  /// The coalition stands: the member has bid, was awarded the delivery, due then, and has
  /// confirmed.
  void form(Duration due = std::chrono::seconds{60}) {
    const auto call = said<coalition::Announcement>();
    ASSERT_TRUE(call);
    coalition::Bid bid;
    bid.round = call->round;
    bid.bidder = kMember;
    bid.speed_mps = kTestSpeed_mps;
    bid.planning_radius_m = 60.0;
    bid.final_approach_m = 100.0;
    hear(coalition::Message{bid});
    wait_until(to_seconds(call->bids_until));
    const auto request = outbox.planning_requests.pop();
    ASSERT_TRUE(request);
    planning::Allocation plan;
    plan.assignments = {{call->tasks.front(), kMember, now + due}};
    EXPECT_TRUE(leader.on_planning_result({request->round, plan}, now));
    hear(coalition::Message{coalition::Confirmation{call->round, kMember, true, {}}});
  }

  Leader leader{ownship, outbox};
};

TEST(Leader, AwaitsTheDecisionOnWhatHasFormed) {
  Leading l;
  EXPECT_EQ(l.leader.state(), State::leading);
  l.form();
  EXPECT_EQ(l.reported(EventKind::coalition_formed), 1);
  EXPECT_EQ(l.leader.state(), State::awaiting_decision);
  l.wait_until(2.0);
  const auto request = l.sent<AuthorisationRequest>();
  ASSERT_TRUE(request);
  EXPECT_EQ(request->deliveries.size(), 1U);
  auto other = request->round;
  ++other.number;
  l.leader.on_authorisation({other, {1}, true, "", {}}, l.now);
  EXPECT_EQ(l.leader.state(), State::awaiting_decision) << "it is for its round";
  l.leader.on_authorisation({request->round, {1}, true, "", {}}, l.now);
  EXPECT_EQ(l.leader.state(), State::leading);
  l.wait_until(4.0);
  EXPECT_FALSE(l.sent<AuthorisationRequest>());
}

TEST(Leader, GivesUpASiteThatIsWithdrawnAndSaysWhy) {
  Leading l;
  l.form();
  l.leader.withdraw({2}, l.now);
  EXPECT_TRUE(l.leader.leading()) << "it leads another";
  (void)l.said<coalition::Cancel>();
  l.leader.withdraw({1}, l.now);
  EXPECT_FALSE(l.leader.leading());
  EXPECT_EQ(l.reported(EventKind::cancelled), 1);
  const auto words = l.leader.poll_last_words();
  ASSERT_TRUE(words);
  const auto* cancel = std::get_if<coalition::Cancel>(&*words);
  ASSERT_NE(cancel, nullptr);
  EXPECT_EQ(cancel->why.reason, coalition::Reason::site_withdrawn);
}

TEST(Leader, PlansWithoutTheBidsThatNothingCanBePlannedFor) {
  Leading l;
  const auto call = l.said<coalition::Announcement>();
  ASSERT_TRUE(call);
  coalition::Bid bid;
  bid.round = call->round;
  bid.capabilities.add(TaskKind::deliver);
  bid.loads = 1;
  bid.range_left_m = 50'000.0;
  for (const auto& [speed_mps, radius_m] : {std::pair{25.0, 0.0}, {0.0, 60.0}, {25.0, 60.0}}) {
    ++bid.bidder.value;
    bid.speed_mps = speed_mps;
    bid.planning_radius_m = radius_m;
    l.hear(coalition::Message{bid});
  }
  EXPECT_EQ(l.leader.tally().bad_messages, 2U);
  l.wait_until(to_seconds(call->bids_until));
  const auto request = l.outbox.planning_requests.pop();
  ASSERT_TRUE(request);
  const auto plan = planning::allocate(request->params, request->problem);
  ASSERT_TRUE(plan.ok());
  EXPECT_EQ(plan->assignments.front().vehicle, bid.bidder);
}

TEST(Leader, AssessmentsForWhichTooFewCanBeHadAreFlownOneAfterAnother) {
  PartsBench bench;
  Leader leader{bench.ownship, bench.outbox};
  Site site = test_site(1);
  site.deliveries.clear();
  site.assessments.resize(3);
  leader.lead({site, {}}, bench.now);
  std::vector<std::size_t> asked;
  const auto round = [&] {
    std::optional<coalition::Announcement> call;
    while (auto said = leader.poll_message()) {
      if (const auto* announced = std::get_if<coalition::Announcement>(&*said)) call = *announced;
    }
    ASSERT_TRUE(call);
    EXPECT_EQ(call->tasks.size(), 3U) << "all are told of";
    for (const VehicleId bidder : {VehicleId{5}, VehicleId{6}}) {
      coalition::Bid bid;
      bid.round = call->round;
      bid.bidder = bidder;
      bid.capabilities.add(TaskKind::assess);
      bid.speed_mps = kTestSpeed_mps;
      bid.planning_radius_m = 60.0;
      EXPECT_FALSE(leader.on_message(coalition::Message{bid}, bench.now));
    }
    bench.be_at(to_seconds(call->bids_until));
    leader.on_timeout(bench.now);
    while (leader.answer_next(bench.now)) {
    }
    const auto request = bench.outbox.planning_requests.pop();
    ASSERT_TRUE(request);
    asked.push_back(request->problem.open_tasks.size());
    EXPECT_TRUE(leader.on_planning_result({request->round, Error{"too few"}}, bench.now));
    while (leader.answer_next(bench.now)) {
    }
    while (leader.monitoring()) {
      bench.be_at(to_seconds(leader.next_timeout()));
      leader.on_timeout(bench.now);
      while (leader.answer_next(bench.now)) {
      }
    }
  };
  for (int i = 0; i < 4; ++i) round();
  EXPECT_EQ(asked, (std::vector<std::size_t>{3, 3, 3, 2}));
}

TEST(Leader, ARefusalEndsItsCoalition) {
  Leading l;
  l.form();
  l.wait_until(2.0);
  const auto request = l.sent<AuthorisationRequest>();
  ASSERT_TRUE(request);
  EXPECT_TRUE(l.said<coalition::Award>());
  l.leader.on_authorisation({request->round, {1}, false, "", {}}, l.now);
  EXPECT_EQ(l.leader.state(), State::idle);
  EXPECT_EQ(l.reported(EventKind::authorisation_refused), 1);
  EXPECT_TRUE(l.leader.poll_last_words()) << "its members are released";
}

TEST(Leader, AGrantThatIsTakenBackEndsItsCoalition) {
  for (const bool passed_on : {false, true}) {
    Leading l;
    l.form();
    l.wait_until(2.0);
    const auto request = l.sent<AuthorisationRequest>();
    ASSERT_TRUE(request);
    (void)l.said<coalition::Award>();
    l.leader.on_authorisation({request->round, {1}, true, "ada", at_seconds(1.0)}, l.now);
    auto round = request->round;
    if (passed_on) ++round.number;
    l.leader.on_authorisation({round, {2}, false, "ada", at_seconds(2.0)}, l.now);
    EXPECT_TRUE(l.leader.leading()) << "it is of another site";
    l.leader.on_authorisation({round, {1}, false, "ada", at_seconds(2.0)}, l.now);
    EXPECT_EQ(l.leader.state(), State::idle);
    EXPECT_EQ(l.reported(EventKind::cancelled), 1);
    EXPECT_EQ(l.reported(EventKind::authorisation_refused), 0);
    const auto words = l.leader.poll_last_words();
    ASSERT_TRUE(words);
    const auto* cancel = std::get_if<coalition::Cancel>(&*words);
    ASSERT_NE(cancel, nullptr);
    EXPECT_EQ(cancel->why.reason, coalition::Reason::grant_taken_back);
  }
}

TEST(Leader, WithoutADecisionInTimeItOpensAnotherRound) {
  Leading l;
  l.form(std::chrono::seconds{9});  // 4 s of it are the final approach
  EXPECT_TRUE(l.said<coalition::Award>());
  l.wait_until(3.0);
  EXPECT_EQ(l.leader.state(), State::awaiting_decision);
  l.wait_until(3.5);
  EXPECT_EQ(l.reported(EventKind::authorisation_late), 1);
  EXPECT_EQ(l.leader.state(), State::leading);
  const auto call = l.said<coalition::Announcement>();
  ASSERT_TRUE(call);
  EXPECT_EQ(call->round.number, 2U);
}

TEST(Leader, SaysFarewellWhenEverythingIsDone) {
  Leading l;
  l.form();
  const auto award = l.said<coalition::Award>();
  ASSERT_TRUE(award);
  const TaskId task = award->assignments.front().task;
  l.hear(coalition::Message{
      coalition::MemberStatus{award->round, kMember, {{task, coalition::TaskState::done, l.now}}}});
  EXPECT_EQ(l.leader.state(), State::parting);
  const auto last = l.said<coalition::LeaseRenewal>();
  ASSERT_TRUE(last);
  EXPECT_TRUE(last->closed);
  l.leader.part();
  EXPECT_EQ(l.leader.state(), State::idle);
  EXPECT_EQ(l.reported(EventKind::site_done), 1);
  l.leader.repeat(l.now);
  EXPECT_TRUE(l.sent<coalition::Message>()) << "once more, for who has not heard it";
}

/// What a leader that is lost has left: the member's delivery, due then.
coalition::Participant::LeadershipWon plan_of_a_lost_leader(Instant now, Instant due) {
  coalition::Participant::LeadershipWon won;
  won.plan.round = {{{7}, {1}, 1}, 2};
  won.plan.site = test_site(1);
  won.plan.assignments = {{{{1}, TaskKind::deliver, 0}, kMember, due}};
  won.supporters = {{{4}, {9}}, {kMember, {1}}};
  won.majority = 2;
  won.promised_from = now;
  return won;
}

TEST(Leader, ASuccessorAsksForADecisionThatIsInTime) {
  PartsBench bench;
  Leader leader{bench.ownship, bench.outbox};
  const Instant due = at_seconds(60.0);
  leader.take_over(plan_of_a_lost_leader(bench.now, due), bench.now);
  const auto round = coalition::Round{{bench.ownship.spec().id, {9}, 1}, 1};
  EXPECT_FALSE(leader.on_message(
      coalition::Message{coalition::Confirmation{round, kMember, true, {}}}, bench.now));
  while (leader.answer_next(bench.now)) {
  }
  ASSERT_EQ(leader.state(), State::awaiting_decision);
  leader.repeat(bench.now);
  const auto request = bench.sent<AuthorisationRequest>();
  ASSERT_TRUE(request);
  EXPECT_EQ(request->round, round);
  // It has no bid of the member's: its own final approach of 4 s stands for the member's.
  EXPECT_EQ(request->decide_by, due - std::chrono::seconds{6});
  bench.be_at(55.0);
  leader.repeat(bench.now);
  EXPECT_EQ(bench.reported(EventKind::authorisation_late), 1);
}

TEST(Leader, YieldsToALargerRewardAndLeadsItsSiteLater) {
  Leading l;
  coalition::Announcement other;
  other.round = {{{7}, {1}, 1}, 1};
  other.site = test_site(2);
  other.bids_until = l.now + std::chrono::seconds{1};
  other.formed_at = l.now + std::chrono::seconds{2};
  other.reward = 0.5;
  EXPECT_FALSE(l.leader.on_message(coalition::Message{other}, l.now));
  EXPECT_EQ(l.leader.state(), State::leading);
  other.reward = 100.0;
  const auto own = l.leader.on_message(coalition::Message{other}, l.now);
  ASSERT_TRUE(own);
  EXPECT_EQ(own->site.id, SiteId{1});
  EXPECT_EQ(l.leader.state(), State::idle);
  EXPECT_EQ(l.reported(EventKind::conflict_yielded), 1);
}

TEST(Leader, WhoseRoundsAreInVainYieldsToWhoseWorkItCanDo) {
  Leading l;
  const auto fail_a_round = [&] {
    const auto call = l.said<coalition::Announcement>();
    ASSERT_TRUE(call);
    l.wait_until(to_seconds(call->bids_until));  // nobody bids
    const auto request = l.outbox.planning_requests.pop();
    ASSERT_TRUE(request);
    EXPECT_TRUE(l.leader.on_planning_result({request->round, Error{"too few"}}, l.now));
    l.work();
  };
  const auto call_of_another = [&l] {
    coalition::Announcement other;
    other.round = {{{7}, {1}, 1}, 1};
    other.site = test_site(2);
    other.tasks = tasks_after_survey(other.site);
    other.announced_at = l.now;
    other.bids_until = l.now + std::chrono::seconds{1};
    other.formed_at = l.now + std::chrono::seconds{2};
    other.reward = 0.5;
    return coalition::Message{other};
  };
  for (int round = 1; round <= 4; ++round) {
    EXPECT_FALSE(l.leader.on_message(call_of_another(), l.now)) << "it may find somebody yet";
    ASSERT_NO_FATAL_FAILURE(fail_a_round());
    while (round < 4 && l.leader.monitoring()) l.wait_until(to_seconds(l.leader.next_timeout()));
  }
  const auto own = l.leader.on_message(call_of_another(), l.now);
  ASSERT_TRUE(own);
  EXPECT_EQ(own->site.id, SiteId{1});
  EXPECT_EQ(l.leader.state(), State::idle);
}

TEST(Leader, HandsOnOnlyWhatNobodyFlies) {
  Leading l;
  l.form();
  l.leader.hand_on(coalition::Reason::out_of_range, l.now);
  EXPECT_TRUE(l.leader.leading());
  Leading free;
  free.leader.hand_on(coalition::Reason::out_of_range, free.now);
  EXPECT_FALSE(free.leader.leading());
  EXPECT_EQ(free.reported(EventKind::cancelled), 1);
}

TEST(Leader, ASiteWithoutTasksIsDone) {
  PartsBench bench;
  Leader leader{bench.ownship, bench.outbox};
  Site site = test_site(1);
  site.deliveries.clear();
  leader.lead({site, {}}, bench.now);
  EXPECT_EQ(leader.state(), State::idle);
  EXPECT_EQ(bench.reported(EventKind::site_done), 1);
}

}  // namespace
}  // namespace skein::mission
