// SPDX-License-Identifier: Apache-2.0
#include "task_flyer.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "agent_parts_test.hpp"

namespace skein::mission {
namespace {

using coalition::Reason;
const coalition::Round kRound{{{7}, {1}, 1}, 1};

/// A member, and the words of a leader to it.
struct Flying : PartsBench {
  using PartsBench::PartsBench;
  void hear(const coalition::Message& message, Reason otherwise_engaged = Reason::none) {
    flyer.on_message(message, now);
    while (const auto output = flyer.poll_output()) {
      const auto* call = std::get_if<coalition::Participant::BidWanted>(&*output);
      if (call != nullptr) {
        flyer.answer_call(call->announcement, otherwise_engaged, now);
      } else {
        flyer.answer(*output, now);
      }
    }
  }
  void call(Reason otherwise_engaged = Reason::none) {
    coalition::Announcement call;
    call.round = kRound;
    call.site = test_site(1);
    call.tasks = tasks_after_survey(call.site);
    call.bids_until = now + std::chrono::seconds{1};
    call.formed_at = now + std::chrono::seconds{2};
    hear(coalition::Message{call}, otherwise_engaged);
  }
  /// A delivery at that time, under a lease until then.
  void award(double delivery_s, double lease_s) {
    coalition::Award award;
    award.round = kRound;
    award.site = test_site(1);
    award.formed_at = now + std::chrono::seconds{1};
    award.assignments = {{{{1}, TaskKind::deliver, 0}, ownship.spec().id, at_seconds(delivery_s)}};
    award.awarded_at = now;
    award.lease_until = at_seconds(lease_s);
    hear(coalition::Message{award});
  }
  void grant() { flyer.on_authorisation({kRound, {1}, true, "", {}}, now); }
  /// At 60 s.
  void may_deliver() {
    call();
    award(60.0, 120.0);
    grant();
  }
  [[nodiscard]] bool leads_north(double seconds) const {
    const double heading_rad = ownship.flight().pose_at(at_seconds(seconds)).heading_rad;
    return std::abs(wrap_pi(heading_rad - kPi / 2.0)) < 1e-6;
  }
  /// When its task ended, as others are told.
  [[nodiscard]] std::optional<Instant> told_done_at() {
    std::optional<Instant> at;
    while (const auto said = flyer.poll_message()) {
      const auto* status = std::get_if<coalition::MemberStatus>(&*said);
      if (status == nullptr) continue;
      for (const auto& entry : status->tasks) {
        if (entry.state == coalition::TaskState::done) at = entry.time;
      }
    }
    return at;
  }
  void decide(bool granted, double decided_s) {
    flyer.on_authorisation({kRound, {1}, granted, "ada", at_seconds(decided_s)}, now);
  }
  void fly_until(double seconds) {
    for (double t = to_seconds(now); t < seconds; t += 0.1) {
      be_at(t);
      step();
    }
  }
  /// Its flight controller is silent.
  void be_lost_until(double seconds) {
    for (; to_seconds(now) < seconds; now += std::chrono::milliseconds{100}) step();
  }
  void step() {
    flyer.fly_begun(now);
    flyer.on_timeout(false, now);
    while (const auto output = flyer.poll_output()) flyer.answer(*output, now);
    flyer.fly(now);
  }

  TaskFlyer flyer{ownship, outbox};
};

TEST(TaskFlyer, BidsUnlessItIsOtherwiseEngaged) {
  Flying f;
  f.call(Reason::surveying);
  EXPECT_EQ(f.reported(EventKind::bid_declined), 1);
  EXPECT_TRUE(f.flyer.free());
  f.call();
  EXPECT_EQ(f.reported(EventKind::bid_sent), 1);
  EXPECT_FALSE(f.flyer.free());
  EXPECT_FALSE(f.flyer.flying());
}

TEST(TaskFlyer, BidsOnlyForWhatItsBatteryBringsItHomeFrom) {
  for (const bool enough : {false, true}) {
    Flying f;
    VehicleState state = f.ownship.state();
    state.battery_percent = enough ? 40 : 22;  // 625 m a percent above the reserve of 20
    EXPECT_TRUE(f.ownship.measures_range(state));
    f.call();
    EXPECT_EQ(f.reported(EventKind::bid_sent), enough ? 1 : 0);
    EXPECT_EQ(f.reported(EventKind::bid_declined), enough ? 0 : 1);
    const auto said = f.flyer.poll_message();
    ASSERT_EQ(said.has_value(), enough);
    if (!said) continue;
    const auto& bid = std::get<coalition::Bid>(*said);
    EXPECT_LT(bid.range_left_m, 20 * 625.0);  // with the way home
    EXPECT_GT(bid.range_left_m, 15 * 625.0);
  }
}

TEST(TaskFlyer, OfAWithdrawnSiteOnlyABegunDeliveryIsFlownToItsEnd) {
  for (const bool told : {true, false}) {  // by the operator, or by the leader's cancel alone
    for (const bool begun : {false, true}) {
      Flying f;
      f.may_deliver();
      f.fly_until(begun ? 58.5 : 50.0);
      ASSERT_EQ(f.reported(EventKind::task_started), begun ? 1 : 0);
      if (told) f.flyer.leave_site({1}, Reason::site_withdrawn, f.now);
      f.hear(coalition::Message{coalition::Cancel{kRound, {Reason::site_withdrawn}}});
      f.fly_until(65.0);
      EXPECT_EQ(f.reported(EventKind::task_done), begun ? 1 : 0);
      EXPECT_EQ(f.reported(EventKind::task_started), 0);
      EXPECT_TRUE(f.flyer.free());
      EXPECT_FALSE(f.flyer.flying());
    }
  }
}

TEST(TaskFlyer, WhatIsTakenBackBeforeItsGateIsNotFlown) {
  for (const double taken_s : {30.0, 55.5, 58.5}) {  // on its way, committed, begun
    Flying f;
    f.call();
    f.award(60.0, 120.0);
    f.decide(true, 1.0);
    f.fly_until(taken_s);
    const bool begun = f.reported(EventKind::task_started) == 1;
    EXPECT_EQ(begun, taken_s == 58.5);
    EXPECT_EQ(f.flyer.in_run(), taken_s > 55.0);
    f.decide(false, 2.0);
    f.decide(false, 2.0);
    EXPECT_EQ(f.reported(EventKind::authorisation_withdrawn), begun ? 0 : 1);
    f.hear(coalition::Message{coalition::Cancel{kRound, {Reason::grant_taken_back}}});
    f.fly_until(65.0);
    EXPECT_EQ(f.reported(EventKind::task_started), 0);
    EXPECT_EQ(f.reported(EventKind::task_done), begun ? 1 : 0);
    EXPECT_TRUE(f.flyer.free());
  }
}

TEST(TaskFlyer, TheOperatorsNewestWordCountsInWhateverOrderTheyCome) {
  Flying f;
  f.call();
  f.award(60.0, 120.0);
  f.decide(false, 2.0);  // has overtaken the grant
  f.decide(true, 1.0);
  EXPECT_EQ(f.reported(EventKind::authorised), 0);
  f.fly_until(65.0);
  EXPECT_EQ(f.reported(EventKind::task_started), 0);

  Flying other;
  other.call();
  other.award(60.0, 120.0);
  other.decide(true, 3.0);
  other.decide(false, 2.0);  // a late copy of what was said before
  EXPECT_EQ(other.reported(EventKind::authorisation_withdrawn), 0);
  other.fly_until(65.0);
  EXPECT_EQ(other.reported(EventKind::task_done), 1);
}

TEST(TaskFlyer, ALateCopyOfAnOlderRefusalHidesNoNewerOne) {
  Flying f;
  f.call();
  f.award(60.0, 120.0);
  f.decide(false, 4.0);
  f.decide(false, 2.0);
  f.decide(true, 3.0);
  EXPECT_EQ(f.reported(EventKind::authorised), 0);
  f.fly_until(65.0);
  EXPECT_EQ(f.reported(EventKind::task_started), 0);
}

/// The turn away has begun by then, and control takes a new plan over only after some time.
TEST(TaskFlyer, AGrantInTheLastMomentBeforeTheGateIsTooLate) {
  constexpr double kGate_s = 56.0;  // 100 m before the site
  for (const double heard_s : {kGate_s - 0.3, kGate_s - 0.1, kGate_s}) {
    Flying f;
    f.call();
    f.award(60.0, 120.0);
    f.fly_until(heard_s);
    f.be_at(heard_s);
    f.grant();
    f.fly_until(65.0);
    const bool in_time = heard_s < kGate_s - 0.2;
    EXPECT_EQ(f.reported(EventKind::task_started), in_time ? 1 : 0) << heard_s;
    EXPECT_EQ(f.reported(EventKind::authorisation_late), in_time ? 0 : 1) << heard_s;
  }
}

constexpr double kArc_s = 60.0;

/// Is to assess at kArc_s what another delivers then, and has flown on until a second after that.
void awaits_delivery(Flying& f, double delivered_s) {
  Site site = test_site(1);
  site.assessments.push_back({});
  site.assessments[0].dwell = std::chrono::seconds{4};
  site.assess_wait = std::chrono::seconds{10};
  coalition::Announcement call;
  call.round = kRound;
  call.site = site;
  call.tasks = tasks_after_survey(site);
  call.bids_until = f.now + std::chrono::seconds{1};
  call.formed_at = f.now + std::chrono::seconds{2};
  f.hear(coalition::Message{call});
  coalition::Award award;
  award.round = kRound;
  award.site = site;
  award.formed_at = f.now + std::chrono::seconds{1};
  award.assignments = {{{{1}, TaskKind::deliver, 0}, {77}, at_seconds(delivered_s)},
                       {{{1}, TaskKind::assess, 0}, f.ownship.spec().id, at_seconds(kArc_s)}};
  award.awarded_at = f.now;
  award.lease_until = at_seconds(120.0);
  f.hear(coalition::Message{award});
  f.fly_until(delivered_s + 1.0);
  coalition::MemberStatus status{kRound, {77}, {}};
  status.tasks = {
      {{{1}, TaskKind::deliver, 0}, coalition::TaskState::done, at_seconds(delivered_s)}};
  f.hear(coalition::Message{status});
}

/// Of the last delivery, as who flew it has told its end: a round of its own may have had it later.
TEST(TaskFlyer, AnAssessmentBeginsOnlyAfterTheWait) {
  for (const double delivered_s : {45.0, 50.0, 50.1, 55.0}) {
    Flying f;
    awaits_delivery(f, delivered_s);
    f.fly_until(kArc_s + 2.0);
    const bool may = delivered_s + 10.0 <= kArc_s;
    EXPECT_EQ(f.reported(EventKind::task_started), may ? 1 : 0) << delivered_s;
    EXPECT_EQ(f.reported(EventKind::authorisation_late), may ? 0 : 1) << delivered_s;
  }
}

TEST(TaskFlyer, AnAssessmentWhoseArcWasLeftIsNotDone) {
  for (const double beside_m : {0.0, 25.0}) {
    Flying f;
    awaits_delivery(f, 45.0);
    f.beside_m = {beside_m, 0.0};
    f.fly_until(kArc_s + 6.0);
    const bool left = beside_m > 0.0;
    EXPECT_EQ(f.reported(EventKind::task_done), left ? 0 : 1);
    EXPECT_EQ(f.reported(EventKind::task_failed), left ? 1 : 0);
  }
}

TEST(TaskFlyer, ASuccessorsPlanIsTakenBackToo) {
  Flying f;
  f.call();
  f.award(60.0, 120.0);
  f.decide(true, 1.0);
  f.fly_until(55.5);
  ASSERT_TRUE(f.flyer.in_run());
  // Whichever round the operator's word names: the site is what he has decided against.
  coalition::Round other = kRound;
  other.number = 7;
  f.flyer.on_authorisation({other, {1}, false, "ada", at_seconds(2.0)}, f.now);
  f.fly_until(65.0);
  EXPECT_EQ(f.reported(EventKind::task_started), 0);
}

TEST(TaskFlyer, DeliversWithAGrantUnderItsLease) {
  Flying f;
  f.call();
  f.award(60.0, 120.0);
  EXPECT_EQ(f.reported(EventKind::confirmed), 1);
  EXPECT_TRUE(f.flyer.flying());
  f.grant();
  EXPECT_EQ(f.reported(EventKind::authorised), 1);
  EXPECT_FALSE(f.flyer.in_run()) << "its plan does not lead past the gate yet";
  f.fly_until(59.0);
  EXPECT_TRUE(f.flyer.in_run());
  EXPECT_EQ(f.reported(EventKind::task_started), 1);
  f.fly_until(62.0);
  EXPECT_EQ(f.reported(EventKind::task_done), 1);
  EXPECT_FALSE(f.flyer.flying());
  EXPECT_EQ(f.ownship.loads(), 0);
}

TEST(TaskFlyer, WhatNobodyHasSeenIsNotDone) {
  for (const bool heard_again : {false, true}) {
    Flying f;
    f.may_deliver();
    f.fly_until(59.0);
    ASSERT_TRUE(f.flyer.in_run());
    f.be_lost_until(60.2);
    EXPECT_EQ(f.reported(EventKind::task_done) + f.reported(EventKind::task_failed), 0)
        << "it may yet be heard";
    EXPECT_GT(f.flyer.next_timeout(), f.now);
    if (heard_again) {
      f.fly_until(60.4);
    } else {
      f.be_lost_until(61.0);
    }
    EXPECT_EQ(f.reported(EventKind::task_done), heard_again ? 1 : 0);
    EXPECT_EQ(f.reported(EventKind::task_failed), heard_again ? 0 : 1);
    EXPECT_EQ(f.ownship.loads(), 0) << "it counts as used in any case";
  }
}

TEST(TaskFlyer, NobodyPassesAGateWithoutKnowingWhereItIs) {
  Flying f;
  f.may_deliver();
  f.fly_until(50.0);
  f.be_lost_until(62.0);
  EXPECT_EQ(f.reported(EventKind::task_started), 0);
}

TEST(TaskFlyer, WhoIsLateTurnsAwayOnlyBeyondTheSite) {
  for (const double late_m : {0.0, 12.0}) {
    Flying f;
    f.may_deliver();
    f.beside_m = {0.0, -late_m};  // which is behind where it flies to the north
    f.fly_until(59.0);
    ASSERT_TRUE(f.flyer.in_run());
    EXPECT_TRUE(f.leads_north(60.0));
    EXPECT_EQ(f.leads_north(60.9), late_m > 0.0);
    f.fly_until(62.0);
    EXPECT_EQ(f.reported(EventKind::task_done), 1);
  }
}

/// What it flies next turns away at once.
TEST(TaskFlyer, WhomTheWindMakesLateInItsRunIsDoneWhenItHasPassedTheSite) {
  for (const double late_m : {0.0, 12.0}) {
    Flying f;
    f.may_deliver();
    f.fly_until(58.0);
    ASSERT_TRUE(f.flyer.in_run());
    f.beside_m = {0.0, -late_m};
    f.fly_until(59.9);
    EXPECT_EQ(f.leads_north(60.9), late_m > 0.0);
    f.fly_until(60.0 + late_m / kTestSpeed_mps - 0.05);
    EXPECT_EQ(f.reported(EventKind::task_done), 0);
    f.fly_until(60.0 + late_m / kTestSpeed_mps + 0.2);
    EXPECT_EQ(f.reported(EventKind::task_done), 1);
    EXPECT_EQ(f.told_done_at(), at_seconds(60.0)) << "assessments count from when it was planned";
  }
}

TEST(TaskFlyer, WhomTheWindMakesLateIsDoneOnTimeWhereItsLeaseLastsNoLonger) {
  Flying f;
  f.call();
  f.award(60.0, 60.2);
  f.grant();
  f.fly_until(58.0);
  ASSERT_TRUE(f.flyer.in_run());
  f.beside_m = {0.0, -12.0};
  f.fly_until(60.1);
  EXPECT_EQ(f.reported(EventKind::task_done), 1);
}

/// The way there, timed as its plan has it, takes no more of the airspeed in one wind than in
/// another.
TEST(TaskFlyer, InWindItBidsAndPlansAtCruiseSpeedThroughTheAir) {
  VehicleAgentConfig config = plane_config();
  config.heeds_wind = true;
  double earliest_s = 1e3;
  double latest_s = 0.0;
  for (int i = 0; i < 8; ++i) {
    Flying f{config};
    f.wind_mps = 5.0 * unit_vector(kPi / 4.0 * i);
    f.be_at(0.1);
    f.call();
    const auto told = f.outbox.events.pop();
    ASSERT_TRUE(told && told->kind() == EventKind::bid_sent);
    const double eta_s = to_seconds(std::get<event::BidSent>(told->body).eta);
    earliest_s = std::min(earliest_s, eta_s);
    latest_s = std::max(latest_s, eta_s);
    f.award(70.0, 120.0);
    ASSERT_TRUE(f.flyer.flying());
    const TimedPath& plan = f.ownship.flight().plan().timed;
    for (double m = 0.0; m < plan.on_time_m; m += 20.0) {
      const Vec2 over_ground =
          plan.speed_at_distance(m) * unit_vector(plan.pose_at_distance(m).heading_rad);
      EXPECT_NEAR((over_ground - f.wind_mps).norm(), kTestSpeed_mps, 0.08 * kTestSpeed_mps)
          << "wind " << i << ", at " << m;
    }
  }
  EXPECT_LT(earliest_s, 0.95 * latest_s) << "against the wind it takes longer";
}

TEST(TaskFlyer, AGrantIsOfItsVehicleTimeAndBearingUntilItsEnd) {
  const auto granted = [](const std::function<void(Authorisation&)>& change) {
    Flying f;
    f.call();
    f.award(60.0, 120.0);
    Authorisation grant{kRound, {1}, true, "ada", f.now, {}, at_seconds(60.0), {}};
    grant.deliveries.push_back(
        {{{{1}, TaskKind::deliver, 0}, f.ownship.spec().id, at_seconds(60.0)},
         test_site(1).deliveries.at(0).bearing_rad});
    change(grant);
    f.flyer.on_authorisation(grant, f.now);
    return f.reported(EventKind::authorised) == 1;
  };
  using A = Authorisation;
  EXPECT_TRUE(granted([](A&) {}));
  EXPECT_FALSE(granted([](A& g) { g.deliveries[0].assignment.vehicle = {77}; }));
  EXPECT_FALSE(granted([](A& g) { g.deliveries[0].assignment.time += std::chrono::seconds{1}; }));
  EXPECT_FALSE(granted([](A& g) { g.deliveries[0].assignment.task.index = 1; }));
  EXPECT_FALSE(granted([](A& g) { g.deliveries[0].bearing_rad += 0.1; }));
  EXPECT_FALSE(granted([](A& g) { g.until = Instant{} - std::chrono::seconds{1}; }));
}

TEST(TaskFlyer, HoldsAtTheGateWhereAHazardHasAppearedBeyondIt) {
  for (const bool covered : {false, true}) {
    Flying f;
    f.may_deliver();
    f.fly_until(50.0);
    EXPECT_TRUE(f.flyer.run_is_open());
    ASSERT_EQ(covered && f.ownship.on_hazard({{HazardId{7}, test_site(1).position, 20.0}}),
              covered);
    EXPECT_EQ(f.flyer.run_is_open(), !covered);
    f.fly_until(65.0);
    EXPECT_EQ(f.reported(EventKind::task_started), covered ? 0 : 1);
  }
}

TEST(TaskFlyer, HoldsAtTheGateWhereAFenceThatWasOrderedLeavesTheSiteOut) {
  Flying f;
  f.may_deliver();
  f.fly_until(50.0);
  const Vec2 site = test_site(1).position;
  const Fence wide{{{-3e3, -3e3}, {3e3, -3e3}, {3e3, 3e3}, {-3e3, 3e3}}};
  ASSERT_TRUE(f.ownship.keep_fence(wide));
  EXPECT_TRUE(f.flyer.run_is_open());
  // The same with a notch around the site.
  const Fence without{{{-3e3, -3e3},
                       {3e3, -3e3},
                       {3e3, site.y() - 20.0},
                       {site.x() - 20.0, site.y() - 20.0},
                       {site.x() - 20.0, site.y() + 20.0},
                       {3e3, site.y() + 20.0},
                       {3e3, 3e3},
                       {-3e3, 3e3}}};
  ASSERT_TRUE(f.ownship.keep_fence(without));
  EXPECT_FALSE(f.flyer.run_is_open());
  f.fly_until(65.0);
  EXPECT_EQ(f.reported(EventKind::task_started), 0);
}

TEST(TaskFlyer, HoldsAtTheGateWithoutAGrantOrALease) {
  for (const bool granted : {false, true}) {
    Flying f;
    f.call();
    f.award(60.0, granted ? 59.0 : 120.0);
    if (granted) f.grant();
    const Vec2 site = test_site(1).position;
    for (double t = 1.0; t < 80.0; t += 0.5) {
      f.fly_until(t);
      EXPECT_FALSE(f.flyer.in_run());
      EXPECT_GT((f.ownship.state().position().horizontal() - site).norm(), 30.0) << t;
    }
    EXPECT_EQ(f.reported(EventKind::task_started), 0);
    EXPECT_EQ(f.reported(EventKind::authorisation_late), 1);
    EXPECT_GT(f.flyer.next_timeout(), f.now);
    EXPECT_EQ(f.ownship.loads(), 1);
  }
}

TEST(TaskFlyer, RefusesWhatItCannotFly) {
  Flying f;
  f.call();
  f.award(5.0, 120.0);  // too soon
  EXPECT_EQ(f.reported(EventKind::refused), 1);
  EXPECT_FALSE(f.flyer.flying());
}

TEST(TaskFlyer, GivesItsTaskBackWhenItWithdraws) {
  Flying f;
  f.call();
  f.award(60.0, 120.0);
  f.flyer.withdraw(Reason::path_barred, f.now);
  f.fly_until(1.0);
  EXPECT_FALSE(f.flyer.flying());
  EXPECT_TRUE(f.flyer.free());
  EXPECT_EQ(f.reported(EventKind::lease_ended), 1);
}

}  // namespace
}  // namespace skein::mission
