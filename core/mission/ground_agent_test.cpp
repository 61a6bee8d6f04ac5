// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/ground_agent.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace skein::mission {
namespace {

using ::testing::HasSubstr;

constexpr VehicleId kLeader{2};
constexpr SiteId kSite{3};

GroundAgentConfig fleet_of_three() {
  GroundAgentConfig config;
  config.expected = {{1}, {2}, {3}};
  return config;
}

Telemetry telemetry_of(VehicleId vehicle, std::uint64_t instance, double seconds) {
  Telemetry t;
  t.vehicle = vehicle;
  t.instance = {instance};
  t.state.time = at_seconds(seconds);
  return t;
}

AuthorisationRequest request(std::uint32_t round, double decide_by_s, double deliver_at_s,
                             SiteId site = kSite) {
  AuthorisationRequest r;
  r.round = {{kLeader, {77}, 1}, round};
  r.site = site;
  r.deliveries.push_back({{{site, TaskKind::deliver, 0}, kLeader, at_seconds(deliver_at_s)}, 0.5});
  r.decide_by = at_seconds(decide_by_s);
  return r;
}

/// The agent and what came out of it since the last look.
struct Bench {
  explicit Bench(const GroundAgentConfig& config = fleet_of_three()) : agent{config, Instant{}} {}

  void hear(const Telemetry& t, double seconds) {
    agent.on_message(Message{t}, at_seconds(seconds));
  }
  /// Of who is heard.
  void ask(const AuthorisationRequest& r, double seconds) {
    hear_once(r.round.coalition.leader, seconds);
    for (const Delivery& delivery : r.deliveries) hear_once(delivery.assignment.vehicle, seconds);
    agent.on_message(Message{r}, at_seconds(seconds));
  }
  void hear_once(VehicleId vehicle, double seconds) {
    const auto known = agent.fleet().vehicles().find(vehicle);
    const bool heard = known != agent.fleet().vehicles().end() && known->second.telemetry;
    if (!heard) hear(telemetry_of(vehicle, 77, seconds), seconds);
  }
  template <class T>
  std::vector<T> sent() {
    std::vector<T> found;
    while (auto message = agent.poll_message()) {
      if (const auto* wanted = std::get_if<T>(&*message)) found.push_back(*wanted);
    }
    return found;
  }
  std::vector<MissionEvent> events() {
    std::vector<MissionEvent> all;
    while (auto event = agent.poll_event()) all.push_back(*event);
    return all;
  }
  /// Steps the agent at its own timeouts until `seconds`; the number of steps shows a busy loop.
  int run_until(double seconds) {
    int steps = 0;
    while (agent.next_timeout() <= at_seconds(seconds)) {
      agent.on_timeout(agent.next_timeout());
      if (++steps > 10000) break;
    }
    agent.on_timeout(at_seconds(seconds));
    return steps;
  }

  GroundAgent agent;
};

TEST(GroundAgent, KnowsItsFleetBeforeItSpeaks) {
  const Bench bench;
  ASSERT_EQ(bench.agent.fleet().vehicles().size(), 3U);
  EXPECT_FALSE(bench.agent.fleet().vehicles().at({2}).telemetry);
  EXPECT_EQ(bench.agent.next_timeout(), Instant::max());
}

using event::FleetNews;
using event::FleetWarning;

FleetWarning news_of(const MissionEvent& event) {
  const auto* news = std::get_if<FleetWarning>(&event.body);
  return news == nullptr ? FleetWarning{FleetNews::count, {}} : *news;
}

TEST(GroundAgent, TellsSilenceAndReturn) {
  Bench bench;
  bench.hear(telemetry_of({1}, 10, 1.0), 1.0);
  EXPECT_EQ(bench.agent.next_timeout(), at_seconds(6.0));
  bench.run_until(6.0);
  EXPECT_TRUE(bench.agent.fleet().vehicles().at({1}).silent);
  auto events = bench.events();
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(news_of(events[0]), (FleetWarning{FleetNews::silent, {1}}));
  bench.hear(telemetry_of({1}, 10, 9.0), 9.0);
  EXPECT_FALSE(bench.agent.fleet().vehicles().at({1}).silent);
  events = bench.events();
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(news_of(events[0]), (FleetWarning{FleetNews::heard_again, {1}, from_seconds(8.0)}));
}

TEST(GroundAgent, TwoInstancesWithOneIdAreADuplicateUntilMended) {
  Bench bench;
  bench.hear(telemetry_of({1}, 10, 1.0), 1.0);
  bench.hear(telemetry_of({1}, 11, 1.1), 1.1);
  EXPECT_FALSE(bench.agent.fleet().vehicles().at({1}).duplicate);  // could be a restart
  bench.hear(telemetry_of({1}, 10, 1.2), 1.2);
  EXPECT_TRUE(bench.agent.fleet().vehicles().at({1}).duplicate);
  EXPECT_FALSE(bench.agent.command({1}, CommandKind::hold, at_seconds(1.3)).ok());
  EXPECT_FALSE(bench.agent.command(kGroundStation, CommandKind::resume, at_seconds(1.3)).ok());
  EXPECT_TRUE(bench.agent.command(kGroundStation, CommandKind::hold, at_seconds(1.3)).ok());
  for (int i = 0; i < 60; ++i) {
    bench.hear(telemetry_of({1}, 10, 1.4 + 0.1 * i), 1.4 + 0.1 * i);
  }
  EXPECT_FALSE(bench.agent.fleet().vehicles().at({1}).duplicate);
  EXPECT_TRUE(bench.agent.command({1}, CommandKind::hold, at_seconds(8.0)).ok());
}

TEST(GroundAgent, ARestartIsNoDuplicate) {
  Bench bench;
  for (int i = 0; i < 10; ++i) bench.hear(telemetry_of({1}, 10, 0.1 * i), 0.1 * i);
  for (int i = 10; i < 100; ++i) bench.hear(telemetry_of({1}, 11, 0.1 * i), 0.1 * i);
  EXPECT_FALSE(bench.agent.fleet().vehicles().at({1}).duplicate);
  const auto events = bench.events();
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(news_of(events[0]), (FleetWarning{FleetNews::restarted, {1}}));
}

TEST(GroundAgent, WarnsOnceOfAStranger) {
  Bench bench;
  bench.hear(telemetry_of({9}, 10, 1.0), 1.0);
  bench.hear(telemetry_of({9}, 10, 1.1), 1.1);
  const auto events = bench.events();
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(news_of(events[0]), (FleetWarning{FleetNews::stranger, {9}}));
  EXPECT_FALSE(bench.agent.command({9}, CommandKind::hold, at_seconds(2.0)).ok());
}

TEST(GroundAgent, AFloodOfStrangersIsBounded) {
  Bench bench;
  for (std::uint16_t id = 100; id < 5000; ++id) bench.hear(telemetry_of({id}, 1, 1.0), 1.0);
  EXPECT_LE(bench.agent.fleet().vehicles().size(), 3U + 64U);
}

TEST(GroundAgent, ForwardsEveryEventOnce) {
  Bench bench;
  MissionEvent event{{2}, at_seconds(4.0), {}, {kSite, TaskKind::deliver, 1}, event::TaskDone{}};
  bench.agent.on_message(Message{event}, at_seconds(4.1));
  bench.agent.on_message(Message{event}, at_seconds(4.2));
  event.task.index = 2;
  bench.agent.on_message(Message{event}, at_seconds(4.2));
  EXPECT_EQ(bench.events().size(), 2U);
}

TEST(GroundAgent, NothingIsAuthorisedUnlessSomebodyDoesIt) {
  Bench bench;
  bench.ask(request(1, 20.0, 30.0), 10.0);
  bench.ask(request(1, 20.0, 30.0), 10.5);
  EXPECT_EQ(bench.agent.authorisations().size(), 1U);
  bench.run_until(100.0);
  EXPECT_TRUE(bench.sent<Authorisation>().empty());
  const auto late = bench.agent.authorise(kSite, "Ada", at_seconds(100.0));
  ASSERT_FALSE(late.ok());
  EXPECT_THAT(late.error().message, HasSubstr("run out"));
  EXPECT_FALSE(bench.agent.authorise({8}, "Ada", at_seconds(100.0)).ok());
}

TEST(GroundAgent, SendsADecisionUntilTheLastDelivery) {
  Bench bench;
  bench.ask(request(1, 20.0, 30.0), 10.0);
  ASSERT_TRUE(bench.agent.authorise(kSite, "Ada", at_seconds(12.0)).ok());
  auto sent = bench.sent<Authorisation>();
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_TRUE(sent[0].granted);
  EXPECT_EQ(sent[0].decided_by, "Ada");
  EXPECT_EQ(sent[0].round.number, 1U);
  EXPECT_EQ(sent[0].decided_at, at_seconds(12.0));
  const auto events = bench.events();
  bench.run_until(60.0);
  EXPECT_EQ(bench.sent<Authorisation>().size(), 36U);  // 12.5 to 30.0
  EXPECT_EQ(bench.agent.next_timeout(), Instant::max());
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].kind(), EventKind::authorised);

  const auto again = bench.agent.refuse(kSite, "Bob", at_seconds(13.0));
  ASSERT_FALSE(again.ok());
  EXPECT_THAT(again.error().message, HasSubstr("already authorised by Ada"));
}

TEST(GroundAgent, ADecisionIsForTheNewestPlanAndNoOther) {
  Bench bench;
  bench.ask(request(1, 20.0, 30.0), 10.0);
  bench.ask(request(2, 25.0, 35.0), 11.0);
  bench.ask(request(1, 20.0, 30.0), 11.5);  // late copy
  EXPECT_EQ(bench.agent.authorisations().size(), 1U);
  ASSERT_TRUE(bench.agent.refuse(kSite, "Ada", at_seconds(12.0)).ok());
  const auto sent = bench.sent<Authorisation>();
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_EQ(sent[0].round.number, 2U);
  EXPECT_FALSE(sent[0].granted);
  EXPECT_FALSE(bench.agent.authorise(kSite, "Ada", at_seconds(12.5)).ok());
}

TEST(GroundAgent, WhatAnEarlierProcessGrantedIsNotGrantedAgain) {
  Bench before;
  const AuthorisationRequest first = request(1, 30.0, 40.0);
  before.ask(first, 10.0);
  ASSERT_TRUE(before.agent.authorise(kSite, "ada", at_seconds(12)));
  const auto decision = before.sent<Authorisation>().at(0);

  Bench anew;
  anew.agent.recall(Message{first}, kLeader, at_seconds(10));
  anew.agent.recall(Message{decision}, kGroundStation, at_seconds(12));
  EXPECT_TRUE(anew.sent<Authorisation>().empty());
  EXPECT_TRUE(anew.events().empty());
  // It goes on telling what it decided, and nobody else gets what may have been flown.
  anew.run_until(20.0);
  EXPECT_FALSE(anew.sent<Authorisation>().empty());
  AuthorisationRequest other = request(1, 90.0, 100.0);
  other.round.coalition = {VehicleId{3}, {78}, 1};
  other.deliveries[0].assignment.vehicle = VehicleId{3};
  anew.ask(other, 60.0);
  EXPECT_FALSE(anew.agent.authorise(kSite, "ada", at_seconds(61)));
  const auto told = anew.sent<coalition::Message>();
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(std::get<coalition::MemberStatus>(told[0]).tasks.at(0).state,
            coalition::TaskState::unknown);
}

TEST(GroundAgent, AGrantIsTakenBackUntilItsDeliveriesHaveBegun) {
  Bench bench;
  EXPECT_FALSE(bench.agent.take_back(kSite, "Ada", at_seconds(1.0)));
  AuthorisationRequest two = request(1, 20.0, 30.0);
  two.deliveries.push_back({{{kSite, TaskKind::deliver, 1}, {3}, at_seconds(34.0)}, 1.0});
  bench.ask(two, 10.0);
  const auto waits = bench.agent.take_back(kSite, "Ada", at_seconds(11.0));
  ASSERT_FALSE(waits);
  EXPECT_THAT(waits.error().message, HasSubstr("refuse"));
  ASSERT_TRUE(bench.agent.authorise(kSite, "Ada", at_seconds(12.0)));
  const TaskId first = two.deliveries[0].assignment.task;
  bench.agent.on_message(
      Message{MissionEvent{kLeader, at_seconds(13.0), two.round, first, event::TaskStarted{}}},
      at_seconds(13.0));
  bench.run_until(14.0);
  (void)bench.sent<Authorisation>();
  (void)bench.events();

  const auto taken = bench.agent.take_back(kSite, "Bob", at_seconds(14.0));
  ASSERT_TRUE(taken);
  ASSERT_EQ(taken->flown_on.size(), 1U);
  EXPECT_EQ(taken->flown_on[0].task, first);
  EXPECT_TRUE(taken->silent.empty());
  auto sent = bench.sent<Authorisation>();
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_FALSE(sent[0].granted);
  EXPECT_EQ(sent[0].round, two.round);
  EXPECT_EQ(sent[0].decided_at, at_seconds(14.0));
  const auto events = bench.events();
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].kind(), EventKind::authorisation_withdrawn);
  // Said again until the last delivery would have been, and no grant is said any more.
  bench.run_until(60.0);
  sent = bench.sent<Authorisation>();
  EXPECT_EQ(sent.size(), 40U);  // 14.5 to 34.0
  EXPECT_TRUE(std::ranges::none_of(sent, &Authorisation::granted));
  EXPECT_FALSE(bench.agent.take_back(kSite, "Bob", at_seconds(60.0))) << "once is enough";
  // Nor does a successor go on with it.
  auto successor = two;
  successor.round = {{{1}, {5}, 1}, 1};
  bench.ask(successor, 15.0);
  EXPECT_TRUE(bench.sent<Authorisation>().empty());
}

TEST(GroundAgent, WhatHasBegunIsNotTakenBack) {
  Bench bench;
  const AuthorisationRequest one = request(1, 20.0, 30.0);
  bench.ask(one, 10.0);
  ASSERT_TRUE(bench.agent.authorise(kSite, "Ada", at_seconds(12.0)));
  bench.agent.on_message(
      Message{MissionEvent{kLeader, at_seconds(13.0), one.round, one.deliveries[0].assignment.task,
                           event::TaskStarted{}}},
      at_seconds(13.0));
  const auto taken = bench.agent.take_back(kSite, "Ada", at_seconds(14.0));
  ASSERT_FALSE(taken);
  EXPECT_THAT(taken.error().message, HasSubstr("flown to its end"));
}

TEST(GroundAgent, WhatIsTakenBackStaysSoAfterANewStartAndAgainstAClockSetBack) {
  Bench before;
  const AuthorisationRequest one = request(1, 30.0, 40.0);
  before.ask(one, 10.0);
  ASSERT_TRUE(before.agent.authorise(kSite, "ada", at_seconds(12.0)));
  ASSERT_TRUE(before.agent.take_back(kSite, "ada", at_seconds(11.0)));
  const auto said = before.sent<Authorisation>();
  ASSERT_EQ(said.size(), 2U);
  EXPECT_GT(said[1].decided_at, said[0].decided_at);

  for (const bool in_order : {true, false}) {
    Bench anew;
    anew.agent.recall(Message{one}, kLeader, at_seconds(10));
    anew.agent.recall(Message{said[in_order ? 0 : 1]}, kGroundStation, at_seconds(12));
    anew.agent.recall(Message{said[in_order ? 1 : 0]}, kGroundStation, at_seconds(12));
    anew.run_until(20.0);
    const auto repeated = anew.sent<Authorisation>();
    ASSERT_FALSE(repeated.empty());
    EXPECT_TRUE(std::ranges::none_of(repeated, &Authorisation::granted));
  }
}

TEST(GroundAgent, APlanWithWhoIsSilentIsGrantedOnlyByWhoPassesOverThat) {
  Bench bench;
  AuthorisationRequest two = request(1, 60.0, 80.0);
  two.deliveries.push_back({{{kSite, TaskKind::deliver, 1}, {3}, at_seconds(84.0)}, 1.0});
  bench.ask(two, 10.0);
  bench.run_until(14.0);
  bench.hear(telemetry_of(kLeader, 77, 14.0), 14.0);
  bench.run_until(17.0);
  const auto plain = bench.agent.authorise(kSite, "Ada", at_seconds(17.0));
  ASSERT_FALSE(plain);
  EXPECT_THAT(plain.error().message, HasSubstr("vehicle 3 is silent for 7 s"));
  EXPECT_THAT(plain.error().message, HasSubstr("authorise 3 override"));
  EXPECT_FALSE(bench.agent.decide_on(two.round, kSite, {true}, "Ada", at_seconds(17.0)));
  EXPECT_TRUE(bench.sent<Authorisation>().empty());
  (void)bench.events();

  const auto over = bench.agent.decide_on(two.round, kSite, {true, true}, "Ada", at_seconds(17.0));
  ASSERT_TRUE(over);
  EXPECT_EQ(*over, "vehicle 3 is silent for 7 s");
  const auto sent = bench.sent<Authorisation>();
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_EQ(sent[0].decided_by, "Ada") << "who signs";
  const auto events = bench.events();
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(std::get<event::Authorised>(events[0].body).by,
            "Ada, although vehicle 3 is silent for 7 s");
  // Whom it has passed over may not hear that it is taken back, either.
  const auto taken = bench.agent.take_back(kSite, "Ada", at_seconds(18.0));
  ASSERT_TRUE(taken);
  EXPECT_EQ(taken->silent, std::vector<VehicleId>{{3}});
}

TEST(GroundAgent, ASilentLeaderOrOneThatWasNeverHeardIsPassedOverOnlyByOrder) {
  Bench bench;
  AuthorisationRequest led = request(1, 60.0, 80.0);
  led.deliveries[0].assignment.vehicle = {3};
  bench.ask(led, 10.0);
  bench.run_until(14.0);
  bench.hear(telemetry_of({3}, 77, 14.0), 14.0);
  bench.run_until(17.0);
  const auto silent = bench.agent.authorise(kSite, "Ada", at_seconds(17.0));
  ASSERT_FALSE(silent);
  EXPECT_THAT(silent.error().message, HasSubstr("vehicle 2 is silent"));

  Bench fresh;
  fresh.agent.on_message(Message{led}, at_seconds(10.0));
  const auto never = fresh.agent.authorise(kSite, "Ada", at_seconds(11.0));
  ASSERT_FALSE(never);
  EXPECT_THAT(never.error().message, HasSubstr("vehicle 3 was never heard"));
  EXPECT_TRUE(fresh.agent.authorise(kSite, "Ada", at_seconds(11.0), true));
}

TEST(GroundAgent, ADeliveryIsGrantedToOneCoalitionAtATime) {
  Bench bench;
  bench.ask(request(1, 20.0, 30.0), 10.0);
  AuthorisationRequest rival = request(1, 20.0, 35.0);
  rival.round.coalition.leader = {3};
  rival.deliveries[0].assignment.vehicle = {3};
  bench.ask(rival, 11.0);  // both wait; the newest is decided first
  ASSERT_TRUE(bench.agent.authorise(kSite, "Ada", at_seconds(12.0)).ok());
  const auto second = bench.agent.authorise(kSite, "Ada", at_seconds(13.0));
  ASSERT_FALSE(second.ok());
  EXPECT_THAT(second.error().message, HasSubstr("is granted to vehicle 3 in another coalition"));

  // Until its owner says that it does not fly it.
  bench.ask(request(2, 25.0, 40.0), 14.0);
  EXPECT_FALSE(bench.agent.authorise(kSite, "Ada", at_seconds(14.5)).ok());
  const TaskId& task = rival.deliveries[0].assignment.task;
  const auto ends = [&](coalition::Reason reason, bool held) {
    return MissionEvent{
        {3}, at_seconds(15.0), rival.round, task, event::LeaseEnded{{reason}, held}};
  };
  for (const MissionEvent& holds :
       {ends(coalition::Reason::task_done, false), ends(coalition::Reason::lease_ran_out, true)}) {
    bench.agent.on_message(Message{holds}, at_seconds(15.0));
    bench.ask(request(2, 25.0, 40.0), 15.2);
    EXPECT_FALSE(bench.agent.authorise(kSite, "Ada", at_seconds(15.2)).ok());
  }
  const MissionEvent gives_up = ends(coalition::Reason::bid_again, false);
  bench.agent.on_message(Message{gives_up}, at_seconds(15.0));
  bench.ask(request(2, 25.0, 40.0), 15.5);
  EXPECT_TRUE(bench.agent.authorise(kSite, "Ada", at_seconds(16.0), true).ok());
}

/// The plan of that request goes on under another leader.
AuthorisationRequest passed_on(AuthorisationRequest request) {
  request.round = {{{1}, {5}, 1}, 1};
  return request;
}

TEST(GroundAgent, ASuccessorsPlanIsGrantedWithoutAskingAgain) {
  Bench bench;
  const auto first = request(1, 40.0, 50.0);
  bench.ask(first, 10.0);
  ASSERT_TRUE(bench.agent.authorise(kSite, "Ada", at_seconds(12.0)).ok());
  (void)bench.sent<Authorisation>();

  bench.ask(passed_on(first), 30.0);
  const auto sent = bench.sent<Authorisation>();
  const auto grant = std::ranges::find(sent, passed_on(first).round, &Authorisation::round);
  ASSERT_NE(grant, sent.end());
  EXPECT_TRUE(grant->granted);
  EXPECT_EQ(grant->decided_by, "Ada");

  Bench other;  // what is another plan needs a decision
  other.ask(first, 10.0);
  ASSERT_TRUE(other.agent.authorise(kSite, "", at_seconds(12.0)).ok());
  auto changed = passed_on(first);
  changed.deliveries[0].assignment.time += std::chrono::seconds{1};
  other.ask(changed, 30.0);
  (void)other.sent<Authorisation>();
  ASSERT_EQ(other.agent.authorisations().size(), 2U);
  EXPECT_FALSE(other.agent.authorisations().back().decision);
  // A decision counts, whoever made it.
  auto same = passed_on(first);
  same.round.coalition.leader = {3};
  other.ask(same, 31.0);
  EXPECT_TRUE(other.agent.authorisations().back().decision);
}

TEST(GroundAgent, WhoWatchesGrantsASuccessorsPlanOnceItHasTheCommand) {
  Bench bench;
  const auto first = request(1, 40.0, 50.0);
  bench.agent.set_watching(true, at_seconds(5.0));
  bench.ask(first, 10.0);
  Authorisation grant{.round = first.round, .site = kSite, .granted = true, .decided_by = "Ada"};
  grant.decided_at = at_seconds(12.0);
  bench.agent.overhear(Message{grant}, at_seconds(12.0));
  (void)bench.events();
  bench.ask(passed_on(first), 30.0);
  EXPECT_FALSE(bench.agent.authorisations().back().decision);
  EXPECT_TRUE(bench.sent<Authorisation>().empty());
  bench.agent.set_watching(false, at_seconds(32.0));
  const auto sent = bench.sent<Authorisation>();
  EXPECT_NE(std::ranges::find(sent, passed_on(first).round, &Authorisation::round), sent.end());
  const auto told = bench.events();
  EXPECT_TRUE(std::ranges::any_of(told, [&](const MissionEvent& e) {
    return e.kind() == EventKind::authorised && e.round == passed_on(first).round;
  })) << "the operator, and the audit";
}

/// It has not heard what was asked, nor the vehicle since: the delivery may have been flown.
TEST(GroundAgent, WhatAnotherStationHasGrantedUnheardIsGrantedToNobodyElse) {
  for (const bool watches : {false, true}) {
    Bench bench;
    const auto first = request(1, 40.0, 50.0);
    Authorisation grant{.round = first.round, .site = kSite, .granted = true, .decided_by = "Ada"};
    grant.decided_at = at_seconds(12.0);
    grant.deliveries = first.deliveries;
    if (watches) {
      bench.agent.overhear(Message{grant}, at_seconds(12.0));
    } else {
      bench.agent.on_message(Message{grant}, at_seconds(12.0));
    }
    auto relieved = passed_on(request(1, 80.0, 90.0));
    relieved.deliveries[0].assignment.vehicle = {3};
    bench.ask(relieved, 60.0);
    EXPECT_TRUE(bench.agent.authorisations().empty());
    const auto told = bench.sent<coalition::Message>();
    EXPECT_TRUE(std::ranges::any_of(told, [](const coalition::Message& message) {
      const auto* status = std::get_if<coalition::MemberStatus>(&message);
      return status != nullptr && status->tasks[0].state == coalition::TaskState::unknown;
    }));
  }
}

/// The grant is said again every half second, of its own round and of a successor's, and is all of
/// one time: what the vehicle has said of it since stays known.
TEST(GroundAgent, AGrantThatIsHeardAgainIsNoNewGrant) {
  Bench bench;
  const auto first = request(1, 40.0, 90.0);
  Authorisation grant{.round = first.round, .site = kSite, .granted = true, .decided_by = "Ada"};
  grant.decided_at = at_seconds(12.0);
  grant.deliveries = first.deliveries;
  Authorisation succeeding = grant;
  succeeding.round = passed_on(first).round;
  const auto say_again = [&](double at_s) {
    bench.agent.overhear(Message{grant}, at_seconds(at_s));
    bench.agent.overhear(Message{succeeding}, at_seconds(at_s));
  };
  const auto says = [&](const EventBody& body, double at_s) {
    const Delivery& delivery = first.deliveries[0];
    bench.agent.on_message(Message{MissionEvent{delivery.assignment.vehicle, at_seconds(at_s),
                                                first.round, delivery.assignment.task, body}},
                           at_seconds(at_s));
  };
  say_again(12.0);
  says(event::TaskStarted{}, 20.0);
  say_again(21.0);
  says(event::TaskFailed{}, 22.0);
  auto relieved = request(1, 80.0, 95.0);
  relieved.round.coalition.leader = {3};
  relieved.deliveries[0].assignment.vehicle = {3};
  bench.ask(relieved, 60.0);
  EXPECT_TRUE(bench.agent.authorisations().empty()) << "it may be flown to its end";
}

TEST(GroundAgent, AGrantIsOfTheDeliveriesThatTheOperatorHasSigned) {
  bool may_sign = false;
  GroundAgentConfig config;
  config.approve = [&may_sign](Authorisation& grant) -> Result<void> {
    if (!may_sign) return Error{"locked"};
    grant.approval = {static_cast<std::uint8_t>(grant.deliveries.size()), 7};
    return {};
  };
  GroundAgent agent{config, Instant{}};
  const auto first = request(1, 40.0, 50.0);
  agent.on_message(Message{telemetry_of(kLeader, 77, 10.0)}, at_seconds(10.0));
  agent.on_message(Message{first}, at_seconds(10.0));
  const auto refused = agent.authorise(kSite, "Ada", at_seconds(12.0));
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().message, "locked");
  EXPECT_FALSE(agent.authorisations().front().decision) << "it still waits";
  may_sign = true;
  ASSERT_TRUE(agent.authorise(kSite, "Ada", at_seconds(13.0)).ok());
  const Authorisation grant = agent.authorisations().front().decision.value();
  EXPECT_EQ(grant.deliveries.size(), first.deliveries.size());
  EXPECT_EQ(grant.until, first.deliveries.back().assignment.time);
  EXPECT_FALSE(grant.approval.empty());
  may_sign = false;  // the approval is of the deliveries, whoever leads
  agent.on_message(Message{passed_on(first)}, at_seconds(30.0));
  ASSERT_TRUE(agent.authorisations().back().decision);
  EXPECT_EQ(agent.authorisations().back().decision->approval, grant.approval);
  EXPECT_EQ(agent.authorisations().back().decision->decided_at, grant.decided_at);
}

TEST(GroundAgent, WhoIsLateUnderASuccessorHasGivenUpWhatWasGrantedBefore) {
  Bench bench;
  const auto first = request(1, 40.0, 50.0);
  bench.ask(first, 10.0);
  ASSERT_TRUE(bench.agent.authorise(kSite, "Ada", at_seconds(12.0)).ok());
  const TaskId& task = first.deliveries[0].assignment.task;
  auto anew = passed_on(first);
  anew.round.number = 2;
  anew.decide_by = at_seconds(70.0);
  anew.deliveries[0].assignment = {task, {1}, at_seconds(80.0)};

  // An event of the time before the grant is of a plan before it.
  const auto late = [&](double seconds) {
    return MissionEvent{kLeader, at_seconds(seconds), passed_on(first).round, task,
                        event::AuthorisationLate{event::Lateness::not_authorised}};
  };
  bench.agent.on_message(Message{late(12.5)}, at_seconds(46.0));
  bench.ask(anew, 46.5);
  EXPECT_FALSE(bench.agent.authorise(kSite, "Ada", at_seconds(47.0)).ok());
  // The successor's request was never heard here; the vehicle was late under its round.
  bench.agent.on_message(Message{late(46.0)}, at_seconds(48.0));
  bench.ask(anew, 49.0);
  EXPECT_TRUE(bench.agent.authorise(kSite, "Ada", at_seconds(50.5)).ok());
  EXPECT_TRUE(bench.sent<coalition::Message>().empty()) << "nothing may have been flown";
}

TEST(GroundAgent, SitesThatAreOverMakeRoomForOthers) {
  Bench bench;
  const auto renews = [&](std::uint16_t site, bool closed) {
    coalition::LeaseRenewal renewal;
    renewal.round = {{kLeader, {77}, site}, 1};
    renewal.site = {site};
    renewal.closed = closed;
    bench.agent.on_message(Message{coalition::Message{renewal}}, at_seconds(site));
  };
  for (std::uint16_t site = 1; site <= 64; ++site) {
    renews(site, true);
    coalition::MemberStatus status;
    for (std::uint8_t i = 0; i < 16; ++i) {
      status.tasks.push_back(
          {{{site}, TaskKind::deliver, i}, coalition::TaskState::done, at_seconds(1.0)});
    }
    bench.agent.on_message(Message{coalition::Message{status}}, at_seconds(site));
  }
  (void)bench.sent<coalition::Message>();
  renews(100, false);
  const auto said = bench.sent<coalition::Message>();
  EXPECT_TRUE(std::ranges::any_of(said, [](const coalition::Message& message) {
    const auto* renewal = std::get_if<coalition::LeaseRenewal>(&message);
    return renewal != nullptr && renewal->site == SiteId{100};
  })) << "it is passed on that it is led";
  coalition::MemberStatus status;
  const TaskId task{{100}, TaskKind::deliver, 0};
  status.tasks = {{task, coalition::TaskState::done, at_seconds(101.0)}};
  bench.agent.on_message(Message{coalition::Message{status}}, at_seconds(101.0));
  bench.ask(request(1, 120.0, 130.0, {100}), 102.0);
  EXPECT_TRUE(bench.agent.authorisations().empty()) << "it is known to be done";
}

TEST(GroundAgent, CountsWhatItHasNoRoomFor) {
  Bench bench;
  EXPECT_EQ(bench.agent.dropped(), 0U);
  for (int i = 0; i < 5000; ++i) {
    const MissionEvent event{{2}, at_seconds(0.001 * i), {}, {}, event::TaskDone{}};
    bench.agent.on_message(Message{event}, at_seconds(0.001 * i));
  }
  EXPECT_GT(bench.agent.dropped(), 0U);
}

TEST(GroundAgent, DoesNotAuthoriseADuplicate) {
  GroundAgentConfig config = fleet_of_three();
  config.decisions = {{.site = kSite, .reaction = from_seconds(1.0)}};
  Bench bench{config};
  for (const std::uint64_t instance : {5U, 6U, 5U})
    bench.hear(telemetry_of(kLeader, instance, 9.0), 9.0);
  bench.ask(request(1, 20.0, 30.0), 10.0);
  EXPECT_LT(bench.run_until(13.0), 20);
  EXPECT_TRUE(bench.sent<Authorisation>().empty());
  EXPECT_FALSE(bench.agent.authorise(kSite, "Ada", at_seconds(13.0)).ok());
  bench.run_until(16.0);  // both silent by now: nothing answers to the id twice
  EXPECT_FALSE(bench.sent<Authorisation>().empty());
}

TEST(GroundAgent, TheScriptDecidesInItsOrderAtItsTime) {
  GroundAgentConfig config = fleet_of_three();
  config.decisions = {{.site = kSite, .grant = false, .reaction = from_seconds(2.0)},
                      {.site = {4}, .grant = true},
                      {.site = kSite,
                       .grant = true,
                       .reaction = from_seconds(1.0),
                       .not_before = at_seconds(50.0)}};
  Bench bench{config};
  bench.ask(request(1, 20.0, 30.0), 10.0);
  bench.run_until(11.9);
  EXPECT_TRUE(bench.sent<Authorisation>().empty());
  bench.run_until(12.0);
  auto sent = bench.sent<Authorisation>();
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_FALSE(sent[0].granted);
  EXPECT_EQ(sent[0].decided_by, "scenario");

  bench.ask(request(2, 70.0, 80.0), 40.0);
  bench.run_until(49.9);
  for (const auto& a : bench.sent<Authorisation>()) EXPECT_EQ(a.round.number, 1U);
  bench.run_until(50.0);
  sent = bench.sent<Authorisation>();
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_TRUE(sent[0].granted);
  EXPECT_EQ(sent[0].decided_at, at_seconds(50.0));

  bench.run_until(90.0);
  (void)bench.sent<Authorisation>();
  bench.ask(request(3, 120.0, 130.0), 100.0);  // the last decision serves again
  bench.run_until(101.0);
  sent = bench.sent<Authorisation>();
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_TRUE(sent[0].granted);
}

TEST(GroundAgent, GivesAnAircraftBackAloneAndTellsWhen) {
  Bench bench;
  EXPECT_FALSE(bench.agent.command(kGroundStation, CommandKind::give_back, at_seconds(10.0)).ok());
  EXPECT_FALSE(bench.agent.command({1}, CommandKind::give_back, at_seconds(-1.0)).ok());
  ASSERT_TRUE(bench.agent.command({1}, CommandKind::give_back, at_seconds(10.25)).ok());
  const auto sent = bench.sent<Command>();
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_EQ(sent[0].kind, CommandKind::give_back);
  EXPECT_EQ(issued_at(sent[0]), at_seconds(10.25));
}

TEST(GroundAgent, WhatIsAskedForAWithdrawnSiteIsRefused) {
  Bench bench;
  bench.ask(request(1, 90.0, 120.0), 80.0);
  bench.ask(request(1, 90.0, 120.0, {4}), 80.0);
  ASSERT_TRUE(bench.agent.authorise({4}, "ada", at_seconds(81.0)).ok());
  (void)bench.sent<Authorisation>();
  bench.agent.end_site(kSite, "ada", at_seconds(82.0));
  bench.agent.end_site({4}, "ada", at_seconds(82.0));
  auto sent = bench.sent<Authorisation>();
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_EQ(sent[0].site, kSite);
  EXPECT_FALSE(sent[0].granted);
  // A leader that has not heard of it asks on; nobody is asked.
  bench.ask(request(2, 100.0, 120.0), 85.0);
  bench.run_until(99.0);
  for (const auto& said : bench.sent<Authorisation>()) EXPECT_FALSE(said.granted);
  EXPECT_FALSE(bench.agent.authorise(kSite, "ada", at_seconds(99.0)).ok());
}

TEST(GroundAgent, DecidesOnThePlanThatWasSeenOrOnNone) {
  Bench bench;
  AuthorisationRequest other = request(1, 90.0, 120.0);
  other.round.coalition.leader = {3};
  bench.ask(request(7, 100.0, 120.0), 80.0);
  bench.ask(other, 81.0);
  EXPECT_FALSE(bench.agent.decide_on(other.round, {9}, {true}, "ada", at_seconds(85.0)).ok());
  // The newer one has run out: the older one is not granted in its place.
  EXPECT_FALSE(bench.agent.decide_on(other.round, kSite, {true}, "ada", at_seconds(90.5)).ok());
  EXPECT_TRUE(bench.sent<Authorisation>().empty());
  EXPECT_TRUE(
      bench.agent.decide_on(request(7, 0.0, 0.0).round, kSite, {true}, "ada", at_seconds(91.0))
          .ok());
  const auto sent = bench.sent<Authorisation>();
  ASSERT_FALSE(sent.empty());
  EXPECT_EQ(sent[0].round.number, 7U);
  EXPECT_FALSE(
      bench.agent.decide_on(request(7, 0.0, 0.0).round, kSite, {false}, "bob", at_seconds(92.0))
          .ok());
}

TEST(GroundAgent, RepeatsCommandsWithGrowingNumbers) {
  Bench bench;
  ASSERT_TRUE(bench.agent.command({1}, CommandKind::hold, at_seconds(10.0)).ok());
  bench.run_until(30.0);
  auto sent = bench.sent<Command>();
  ASSERT_EQ(sent.size(), 6U);  // at once, then every second for five
  const auto first = sent.front().number;
  EXPECT_TRUE(
      std::all_of(sent.begin(), sent.end(), [&](const Command& c) { return c.number == first; }));
  ASSERT_TRUE(bench.agent.command({1}, CommandKind::resume, at_seconds(30.0)).ok());
  ASSERT_TRUE(bench.agent.command(kGroundStation, CommandKind::hold, at_seconds(30.0)).ok());
  bench.run_until(31.0);
  sent = bench.sent<Command>();
  ASSERT_EQ(sent.size(), 3U);  // `all` has replaced the repeats of the first
  EXPECT_LT(first, sent[0].number);
  EXPECT_LT(sent[0].number, sent[1].number);
  EXPECT_EQ(sent[1].number, sent[2].number);

  Bench restarted;
  ASSERT_TRUE(restarted.agent.command({1}, CommandKind::hold, at_seconds(32.0)).ok());
  EXPECT_LT(sent[2].number, restarted.sent<Command>().front().number);
}

}  // namespace
}  // namespace skein::mission
