// SPDX-License-Identifier: Apache-2.0
#include "scout.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "agent_parts_test.hpp"
#include "skein/planning/avoidance.hpp"

namespace skein::mission {
namespace {

using State = Scout::State;

struct Scouting : PartsBench {
  explicit Scouting(const VehicleAgentConfig& config = plane_config()) : PartsBench{config} {}

  void find(const Site& site) { scout.on_site_report({ownship.spec().id, site}, now); }
  /// Until it says which site to lead, or is idle.
  std::optional<SurveyedSite> fly_until(double seconds) {
    for (double t = to_seconds(now); t < seconds; t += 0.5) {
      be_at(t);
      if (auto site = scout.fly(now)) return site;
    }
    return std::nullopt;
  }
  /// Another vehicle announces it, at this moment.
  void is_announced(const Site& site, VehicleId by = {7}) {
    coalition::Announcement announcement;
    announcement.round = {{by, {1}, 1}, 1};
    announcement.site = site;
    announcement.announced_at = now;
    scout.on_message(coalition::Message{announcement}, now);
  }

  Scout scout{ownship, outbox};
};

TEST(Scout, SurveysWhatItFindsAndSaysThatItIsToBeLed) {
  Scouting s;
  s.find(test_site(1));
  s.find(test_site(1));
  EXPECT_EQ(s.reported(EventKind::site_detected), 2) << "who tells it again has not heard that";
  EXPECT_FALSE(s.scout.take_up(s.now)) << "it is to be surveyed first";
  EXPECT_EQ(s.scout.state(), State::to_survey);
  s.be_at(to_seconds(s.scout.next_timeout()));
  EXPECT_FALSE(s.scout.fly(s.now));
  EXPECT_EQ(s.scout.state(), State::surveying);
  const auto site = s.fly_until(300.0);
  ASSERT_TRUE(site);
  EXPECT_EQ(site->site.id, SiteId{1});
  EXPECT_EQ(s.scout.state(), State::idle);
  EXPECT_EQ(s.reported(EventKind::survey_done), 1);
}

/// On the orbit that it ends in.
Hazard half_a_lap_after(const TimedPath& plan, double flown_m) {
  const double half_lap_m = kPi / std::abs(plan.tail_curvature_per_m);
  return {HazardId{1}, plan.pose_at_distance(flown_m + half_lap_m).position(), 20.0};
}
auto with_a_lap(const TimedPath& plan) {
  const double lap_m = kTwoPi / std::abs(plan.tail_curvature_per_m);
  return plan.piece(0.0, plan.path.length_m() + lap_m);
}

/// A survey is flown to its end where a hazard has become known on the orbit behind it; who then
/// leads the site would circle on there.
TEST(Scout, WhoLeadsCirclesClearOfWhatBecameKnownDuringItsSurvey) {
  FlownAgent vehicle{plane_config()};
  vehicle.fly(1.0);
  vehicle.tell(SiteReport{{4}, test_site(5)});
  const auto activity = [&] { return vehicle.agent.activity(); };
  for (int i = 0; i < 600 && activity() != Activity::surveying; ++i) vehicle.fly(0.5);
  ASSERT_EQ(activity(), Activity::surveying);
  const TimedPath survey = vehicle.plan.timed;
  const std::vector<Hazard> hazards{half_a_lap_after(survey, survey.path.length_m())};
  vehicle.tell(HazardReport{hazards.front()});
  EXPECT_EQ(vehicle.plan.timed.path.length_m(), survey.path.length_m()) << "it is flown on";
  for (int i = 0; i < 600 && activity() == Activity::surveying; ++i) vehicle.fly(0.5);
  ASSERT_EQ(activity(), Activity::leading);
  vehicle.fly(0.5);
  const auto orbit = with_a_lap(vehicle.plan.timed);
  ASSERT_TRUE(orbit);
  EXPECT_TRUE(planning::is_clear(*orbit, hazards));
}

TEST(Scout, ASurveyWhoseArcWasLeftIsFlownAgain) {
  Scouting s;
  s.find(test_site(1));
  EXPECT_FALSE(s.scout.take_up(s.now));
  s.beside_m = {25.0, 0.0};
  EXPECT_FALSE(s.fly_until(300.0));
  EXPECT_EQ(s.reported(EventKind::survey_done), 0);
  s.beside_m = {0.0, 0.0};
  EXPECT_FALSE(s.scout.take_up(s.now));
  EXPECT_EQ(s.scout.state(), State::to_survey);
}

TEST(Scout, ASiteThatThereIsNoRoomForIsTakenUpWhenItIsSeenAgain) {
  Scouting s;
  for (std::uint16_t id = 1; id <= 17; ++id) s.find(test_site(id));
  EXPECT_EQ(s.reported(EventKind::site_detected), 16);
  EXPECT_EQ(s.scout.dropped(), 1U);
  EXPECT_FALSE(s.scout.take_up(s.now));
  ASSERT_EQ(s.scout.state(), State::to_survey);
  s.find(test_site(17));
  EXPECT_EQ(s.reported(EventKind::site_detected), 1);
  EXPECT_EQ(s.scout.dropped(), 1U);
}

TEST(Scout, ALeaderOfTheFutureIsLostLikeAnyOther) {
  Scouting s;
  coalition::Announcement announcement;
  announcement.round = {{{7}, {1}, 1}, 1};
  announcement.site = test_site(1);
  announcement.announced_at = s.now + std::chrono::hours{24};
  s.scout.on_message(coalition::Message{announcement}, s.now);
  s.be_at(90.0);
  EXPECT_FALSE(s.scout.take_up(s.now));
  EXPECT_EQ(s.scout.state(), State::to_relief);
}

TEST(SiteBook, WhatIsClosedMakesRoomAndStaysClosed) {
  SiteBook book;
  coalition::LeaseRenewal last;
  last.closed = true;
  for (std::uint16_t id = 1; id <= 64; ++id) {
    book.on_leader(test_site(id), at_seconds(1.0));
    if (id == 7) last.site = {id};
  }
  book.on_leader(test_site(65), at_seconds(1.0));
  EXPECT_EQ(book.lost(at_seconds(60.0)).size(), 64U) << "nothing makes room";
  book.on_renewal(last, at_seconds(2.0));
  book.on_leader(test_site(65), at_seconds(3.0));
  EXPECT_NE(book.lost({65}, at_seconds(60.0)), nullptr);
  book.on_leader(test_site(7), at_seconds(4.0));
  EXPECT_EQ(book.lost({7}, at_seconds(60.0)), nullptr);
  EXPECT_TRUE(book.led({7}, at_seconds(60.0)));
}

TEST(Scout, WhatIsWithdrawnIsForgottenForGood) {
  Scouting s;
  s.find(test_site(1));
  EXPECT_FALSE(s.scout.take_up(s.now));
  ASSERT_EQ(s.scout.state(), State::to_survey);
  EXPECT_TRUE(s.scout.withdraw({1}, true, s.now));
  EXPECT_FALSE(s.scout.withdraw({1}, true, s.now)) << "it is told again and again";
  EXPECT_EQ(s.scout.state(), State::idle);
  EXPECT_TRUE(s.ownship.flight().searching());
  (void)s.reported(EventKind::site_detected);
  s.find(test_site(1));
  EXPECT_EQ(s.reported(EventKind::site_detected), 0) << "a late copy of its report";
  s.be_at(30.0);
  EXPECT_FALSE(s.scout.take_up(s.now));
  EXPECT_EQ(s.scout.state(), State::idle);
  // Nor is it relieved, whether it was known before or is announced afterwards.
  s.is_announced(test_site(1));
  s.is_announced(test_site(2));
  EXPECT_TRUE(s.scout.withdraw({2}, true, s.now));
  s.be_at(200.0);
  EXPECT_FALSE(s.scout.take_up(s.now));
  EXPECT_EQ(s.scout.state(), State::idle);
}

TEST(Scout, DoesNotCircleASiteThroughAHazard) {
  VehicleAgentConfig config = plane_config();
  // On the circle around the site, and not on the arc that is flown.
  for (const Vec2& side : {Vec2{110.0, 0.0}, Vec2{0.0, 110.0}}) {
    config.hazards.push_back({{1}, test_site(1).position + side, 20.0});
  }
  Scouting s{config};
  s.find(test_site(1));
  EXPECT_FALSE(s.scout.take_up(s.now));
  ASSERT_EQ(s.scout.state(), State::to_survey);
  EXPECT_TRUE(s.ownship.flight().keeps_clear(s.ownship.hazards(), s.now + std::chrono::seconds{1}));
}

TEST(Scout, TakesUpNothingThatItCannotSurvey) {
  VehicleAgentConfig carrier = plane_config();
  carrier.vehicle.capabilities = Capabilities{}.add(TaskKind::deliver);
  Scouting s{carrier};
  s.find(test_site(1));
  EXPECT_EQ(s.reported(EventKind::site_detected), 0);
}

TEST(Scout, ASurveyThatWasCalledOffIsMadeUpFor) {
  Scouting s;
  s.find(test_site(1));
  EXPECT_FALSE(s.scout.take_up(s.now));
  s.fly_until(3.0);
  s.scout.call_off();
  EXPECT_EQ(s.scout.state(), State::idle);
  s.be_at(20.0);
  EXPECT_FALSE(s.scout.take_up(s.now));
  EXPECT_EQ(s.scout.state(), State::to_survey);
  EXPECT_TRUE(s.fly_until(300.0));
}

TEST(Scout, ASurveyOffItsPathIsNone) {
  Scouting s;
  s.find(test_site(1));
  EXPECT_FALSE(s.scout.take_up(s.now));
  s.ownship.hold(s.now);  // it flies elsewhere
  EXPECT_FALSE(s.fly_until(300.0));
  EXPECT_EQ(s.reported(EventKind::task_failed), 1);
  EXPECT_EQ(s.reported(EventKind::survey_done), 0);
}

TEST(Scout, ASurveyWhoseEndNobodyHasSeenIsNone) {
  Scouting s;
  s.find(test_site(1));
  EXPECT_FALSE(s.scout.take_up(s.now));
  EXPECT_FALSE(s.fly_until(to_seconds(s.scout.next_timeout()) + 2.0));
  ASSERT_EQ(s.scout.state(), State::surveying);
  s.now = s.scout.next_timeout();
  EXPECT_FALSE(s.scout.fly(s.now));
  EXPECT_EQ(s.scout.state(), State::surveying) << "it may yet be heard";
  ASSERT_GT(s.scout.next_timeout(), s.now);
  s.now = s.scout.next_timeout();
  EXPECT_FALSE(s.scout.fly(s.now));
  EXPECT_EQ(s.reported(EventKind::task_failed), 1);
  EXPECT_EQ(s.reported(EventKind::survey_done), 0);
}

TEST(Scout, FliesToASiteWhoseLeaderIsLostAndListensThere) {
  Scouting s;
  s.is_announced(test_site(1));
  s.be_at(60.0);
  EXPECT_FALSE(s.scout.take_up(s.now));
  EXPECT_EQ(s.scout.state(), State::idle) << "it may still be led";
  s.be_at(90.0);
  EXPECT_FALSE(s.scout.take_up(s.now));
  EXPECT_EQ(s.scout.state(), State::to_relief);
  const Instant arrival = s.scout.next_timeout();
  s.be_at(to_seconds(arrival));
  EXPECT_FALSE(s.scout.fly(s.now));
  EXPECT_EQ(s.scout.state(), State::listening);
  EXPECT_GT(s.scout.next_timeout(), s.now);
  const auto site = s.fly_until(300.0);
  ASSERT_TRUE(site);
  EXPECT_EQ(site->site.id, SiteId{1});
  EXPECT_GE(s.now, arrival + s.ownship.config().protocol.silence);
}

TEST(Scout, GoesBackToItsSearchWhenTheLostLeaderIsHeard) {
  Scouting s;
  s.is_announced(test_site(1));
  s.be_at(90.0);
  EXPECT_FALSE(s.scout.take_up(s.now));
  EXPECT_EQ(s.scout.state(), State::to_relief);
  s.is_announced(test_site(1));
  EXPECT_FALSE(s.scout.fly(s.now));
  EXPECT_EQ(s.scout.state(), State::idle);
  EXPECT_TRUE(s.ownship.flight().searching());
}

/// Where several leaders are lost at once, all that are free set out to the same site: nobody would
/// bid for another one before they are there.
struct Relieving : FlownAgent {
  Relieving() : FlownAgent{plane_config()} {
    fly(1.0);
    call(1, 7, 1.0);
    while (count(EventKind::relief_begun) == 0 && to_seconds(state.time) < 200.0) fly(0.5);
  }
  /// A leader announces that site.
  void call(std::uint16_t site, std::uint16_t leader, double bids_for_s) {
    coalition::Announcement call;
    call.round = round_of(leader);
    call.site = test_site(site);
    call.tasks = tasks_after_survey(call.site);
    call.announced_at = state.time;
    call.bids_until = state.time + from_seconds(bids_for_s);
    call.formed_at = call.bids_until + std::chrono::seconds{2};
    call.reward = 1.0;
    call.leader_at_formation = call.site.position;
    tell(coalition::Message{call});
  }
  void award(std::uint16_t site, std::uint16_t leader, VehicleId to) {
    coalition::Award award;
    award.round = round_of(leader);
    award.site = test_site(site);
    award.formed_at = state.time + std::chrono::seconds{1};
    award.assignments = {
        {{{site}, TaskKind::deliver, 0}, to, state.time + std::chrono::seconds{90}}};
    award.awarded_at = state.time;
    award.lease_until = state.time + std::chrono::seconds{120};
    tell(coalition::Message{award});
  }
  static coalition::Round round_of(std::uint16_t leader) { return {{{leader}, {1}, 1}, 1}; }
  [[nodiscard]] std::ptrdiff_t count(EventKind kind) const {
    return std::ranges::count_if(
        events, [kind](const MissionEvent& event) { return event.kind() == kind; });
  }
};

TEST(Scout, OnItsWayToRelieveASiteItBidsForAnother) {
  Relieving vehicle;
  ASSERT_EQ(vehicle.count(EventKind::relief_begun), 1);
  const auto bids = vehicle.count(EventKind::bid_sent);
  vehicle.call(2, 8, 1.0);
  EXPECT_EQ(vehicle.count(EventKind::bid_sent), bids + 1);
  EXPECT_EQ(vehicle.agent.activity(), Activity::surveying) << "it flies on meanwhile";
  vehicle.award(2, 8, vehicle.agent.telemetry().vehicle);
  EXPECT_EQ(vehicle.agent.activity(), Activity::executing);
  EXPECT_EQ(vehicle.agent.telemetry().task.site, SiteId{2});
}

TEST(Scout, WhoWasNotAwardedWhatItBidForRelievesItsSite) {
  Relieving vehicle;
  const std::uint32_t plan = vehicle.plan.number;
  const auto bids = vehicle.count(EventKind::bid_sent);
  vehicle.call(2, 8, 1.0);
  ASSERT_EQ(vehicle.count(EventKind::bid_sent), bids + 1);
  vehicle.award(2, 8, {8});
  for (int i = 0; i < 300 && vehicle.agent.activity() == Activity::surveying; ++i) vehicle.fly(0.5);
  EXPECT_EQ(vehicle.agent.activity(), Activity::leading);
  EXPECT_EQ(vehicle.plan.number, plan) << "one way there, whatever it bid for meanwhile";
}

TEST(Scout, WhatItRelievesIsWithdrawnAndWhatItBidHolds) {
  Relieving vehicle;
  const std::uint32_t plan = vehicle.plan.number;
  vehicle.call(2, 8, 3.0);
  vehicle.tell(SiteReport{{}, test_site(1), true});
  EXPECT_EQ(vehicle.plan.number, plan) << "it bid from this way";
  vehicle.fly(60.0);
  EXPECT_EQ(vehicle.agent.activity(), Activity::searching);
}

/// A hazard on the rest of the circle that it flies while it waits.
TEST(Scout, WhoWaitsForItsBidCirclesClearOfWhatBecomesKnown) {
  Relieving vehicle;
  vehicle.call(2, 8, 120.0);
  vehicle.fly(60.0);
  ASSERT_EQ(vehicle.agent.activity(), Activity::surveying);
  const TimedPath relief = vehicle.plan.timed;
  const double flown_m = relief.distance_at(vehicle.state.time);
  const std::vector<Hazard> hazards{half_a_lap_after(relief, flown_m)};
  vehicle.tell(HazardReport{hazards.front()});
  vehicle.fly(0.5);
  const auto orbit = with_a_lap(vehicle.plan.timed);
  ASSERT_TRUE(orbit);
  EXPECT_TRUE(planning::is_clear(*orbit, hazards));
}

TEST(Scout, LeadsNothingBeforeWhatItBidForIsDecided) {
  Relieving vehicle;
  vehicle.call(2, 8, 120.0);
  vehicle.fly(100.0);
  EXPECT_EQ(vehicle.agent.activity(), Activity::surveying) << "it has long been there";
  EXPECT_GT(vehicle.agent.next_timeout(), vehicle.state.time);
  for (int i = 0; i < 300 && vehicle.agent.activity() == Activity::surveying; ++i) vehicle.fly(0.5);
  EXPECT_EQ(vehicle.agent.activity(), Activity::leading);
}

TEST(Scout, WhatWasLedInVainComesAfterAllElse) {
  Scouting s;
  EXPECT_FALSE(s.scout.has_another_site());
  s.scout.put_last({test_site(1), {}, {}});
  s.scout.put_off({test_site(2), {}, {}});
  s.find(test_site(3));
  EXPECT_TRUE(s.scout.has_another_site());
  const auto first = s.scout.take_up(s.now);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->site.id, SiteId{2});
  EXPECT_FALSE(s.scout.take_up(s.now));
  ASSERT_EQ(s.scout.state(), State::to_survey);
  ASSERT_TRUE(s.fly_until(300.0));
  const auto last = s.scout.take_up(s.now);
  ASSERT_TRUE(last);
  EXPECT_EQ(last->site.id, SiteId{1});
}

TEST(Scout, ASiteThatWasPutOffIsLedLaterUnlessOthersDo) {
  Scouting s;
  s.scout.put_off({test_site(1), {}, {}});
  s.scout.put_off({test_site(2), {}, {}});
  s.is_announced(test_site(1));
  // The ground station passes on what the vehicle itself has said before.
  s.is_announced(test_site(2), s.ownship.spec().id);
  const auto site = s.scout.take_up(s.now);
  ASSERT_TRUE(site);
  EXPECT_EQ(site->site.id, SiteId{2});
  EXPECT_FALSE(s.scout.take_up(s.now));
}

/// Who was awarded a task then may not have heard that its leader was held: nobody else is to have
/// it before its lease is over, nor ever what may have been flown by then.
TEST(Scout, ASiteThatWasPutOffIsLedWhenNobodyHoldsItsTasksAnyMore) {
  const coalition::Round round{{{4}, {1}, 1}, 1};
  const TaskId first{SiteId{1}, TaskKind::deliver, 0};
  const TaskId second{SiteId{1}, TaskKind::deliver, 1};
  Scouting s;
  const Instant until = s.now + std::chrono::seconds{14};
  s.scout.put_off(
      {test_site(1),
       {{first, VehicleId{7}, round, until, true}, {second, VehicleId{8}, round, until, true}},
       {}});
  EXPECT_FALSE(s.scout.take_up(s.now));
  EXPECT_LE(s.scout.takes_up_at(), until);
  coalition::MemberStatus status;
  status.member = VehicleId{8};
  status.round = round;
  status.tasks = {{second, coalition::TaskState::failed, s.now}};
  s.scout.on_message(coalition::Message{status}, s.now);
  EXPECT_FALSE(s.scout.take_up(until - std::chrono::milliseconds{1}));
  const auto site = s.scout.take_up(until);
  ASSERT_TRUE(site);
  EXPECT_THAT(site->over, testing::ElementsAre(first)) << "the other has said that it has not";
  EXPECT_EQ(s.reported(EventKind::task_unknown), 1);

  s.scout.put_off(
      {test_site(1), {{second, VehicleId{8}, round, until + std::chrono::seconds{1}, false}}, {}});
  s.scout.on_message(coalition::Message{status}, s.now);
  EXPECT_TRUE(s.scout.take_up(until)) << "nobody holds it, by its word";
}

/// Two of three who have not heard that their leader was held may have chosen another one, unless
/// one of them has left before they could, or says that it will not.
TEST(Scout, ASiteThatWasPutOffIsLedWhenNobodyCanHaveBeenChosenToLeadIt) {
  const coalition::Round round{{{4}, {1}, 1}, 1};
  const TaskId first{SiteId{1}, TaskKind::deliver, 0};
  const TaskId second{SiteId{1}, TaskKind::deliver, 1};
  using namespace std::chrono_literals;
  for (const auto& [left_after, says_so] :
       {std::pair<Duration, bool>{0s, false}, {12s, false}, {100s, false}, {12s, true}}) {
    Scouting s;
    const Instant promised = s.now + 10s;
    const Instant leases_end = s.now + 14s;
    const Instant until = promised + 60s;
    s.scout.put_off(
        {test_site(1),
         {{first, VehicleId{7}, round, leases_end, false},
          {second, VehicleId{8}, round, leases_end, false}},
         {round.coalition, {{VehicleId{7}, {}}, {VehicleId{8}, {}}}, 2, promised, until}});
    if (says_so) {
      const coalition::Allegiance none{round.coalition, VehicleId{8}, {}, {}, s.now};
      s.scout.on_message(coalition::Message{none}, s.now + left_after);
    } else if (left_after < 100s) {
      coalition::MemberStatus status{round, VehicleId{8}, {}};
      status.tasks = {{second, coalition::TaskState::failed, s.now + left_after}};
      s.scout.on_message(coalition::Message{status}, s.now + left_after);
    }
    const Instant led_at = left_after == 0s || says_so ? leases_end : until;
    EXPECT_FALSE(s.scout.take_up(led_at - 1ms));
    EXPECT_TRUE(s.scout.take_up(led_at));
  }
}

}  // namespace
}  // namespace skein::mission
