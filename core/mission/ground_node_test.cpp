// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/ground_node.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace skein::mission {
namespace {

constexpr VehicleId kVehicle{2};
constexpr SiteId kSite{3};
const coalition::Round kRound{{kVehicle, {77}, 1}, 1};

GroundNode node() {
  GroundNodeConfig config;
  config.agent.expected = {{1}, {2}, {3}};
  config.formation.vehicles = {{1}, {2}, {3}};
  return {config, Instant{}};
}

Telemetry telemetry_of(Activity activity) {
  Telemetry telemetry;
  telemetry.vehicle = kVehicle;
  telemetry.instance = {7};
  telemetry.activity = activity;
  return telemetry;
}

TEST(GroundNode, AnEventCountsOnlyWhereItsVehicleSaysIt) {
  GroundNode ground = node();
  MissionEvent done;
  done.vehicle = kVehicle;
  done.time = at_seconds(1.0);
  done.round = kRound;
  done.task = {kSite, TaskKind::deliver, 0};
  done.body = event::TaskDone{};
  EXPECT_FALSE(ground.on_message(done, {9}, at_seconds(1.0)));
  EXPECT_EQ(ground.refused(), 1U);
  EXPECT_FALSE(ground.poll_event());
  EXPECT_TRUE(ground.on_message(done, kVehicle, at_seconds(1.0)));
  EXPECT_EQ(ground.refused(), 1U);
  const auto told = ground.poll_event();
  ASSERT_TRUE(told);
  EXPECT_EQ(told->vehicle, kVehicle);
}

TEST(GroundNode, OnlyTheLeaderOfARoundAsksForItsAuthorisation) {
  GroundNode ground = node();
  AuthorisationRequest request;
  request.round = kRound;
  request.site = kSite;
  request.decide_by = at_seconds(20.0);
  EXPECT_FALSE(ground.on_message(request, {9}, at_seconds(1.0)));
  EXPECT_TRUE(ground.agent().authorisations().empty());
  EXPECT_TRUE(ground.on_message(request, kVehicle, at_seconds(1.0)));
  EXPECT_EQ(ground.agent().authorisations().size(), 1U);
}

TEST(GroundNode, WhoseSecondProgramIsSilentIsWorkedWithAgainWhoeverSpeaksFirst) {
  GroundNode ground = node();
  const auto speak = [&](VehicleId vehicle, InstanceId instance, double seconds) {
    Telemetry telemetry = telemetry_of(Activity::searching);
    telemetry.vehicle = vehicle;
    telemetry.instance = instance;
    telemetry.state.time = at_seconds(seconds);
    ground.on_message(telemetry, vehicle, at_seconds(seconds));
    mission::Setup setup;
    setup.node = vehicle;
    setup.instance = instance;
    setup.time = at_seconds(seconds);
    ground.on_message(setup, vehicle, at_seconds(seconds));
  };
  for (const std::uint64_t instance : {7U, 8U, 7U}) speak(kVehicle, {instance}, 1.0);
  ASSERT_TRUE(ground.fleet().why_not_with(kVehicle));
  for (double s = 2.0; s < 60.0; s += 1.0) {
    ground.on_timeout(at_seconds(s));
    speak({3}, {9}, s);
    speak(kVehicle, {7}, s);
  }
  EXPECT_FALSE(ground.fleet().why_not_with(kVehicle));
}

/// As a later leader and a vehicle that starts anew must hear of it.
TEST(GroundNode, ARefusalIsToldAsAWithdrawalForTheRestOfTheMissionAlsoAfterANewStart) {
  GroundNode ground = node();
  AuthorisationRequest request;
  request.round = kRound;
  request.site = kSite;
  request.decide_by = at_seconds(20.0);
  std::vector<std::pair<Message, VehicleId>> record{{Message{request}, kVehicle}};
  ground.on_message(request, kVehicle, at_seconds(1.0));
  ASSERT_TRUE(ground.agent().refuse(kSite, "Ada", at_seconds(2.0)).ok());
  const auto withdrawals = [](GroundNode& node, double from_s, double to_s, auto&& keep) {
    int said = 0;
    for (int i = 0; from_s + 0.5 * i < to_s; ++i) {
      const double s = from_s + 0.5 * i;
      node.on_timeout(at_seconds(s));
      while (const auto message = node.poll_message()) {
        keep(*message);
        const auto* report = std::get_if<SiteReport>(&*message);
        said += report != nullptr && report->withdrawn && report->site.id == kSite ? 1 : 0;
      }
    }
    return said;
  };
  const auto record_it = [&](const Message& message) {
    record.emplace_back(message, kGroundStation);
  };
  EXPECT_EQ(withdrawals(ground, 2.0, 6.0, record_it), 0) << "its leader hears why, first";
  GroundNode next = node();
  for (const auto& [message, sender] : record) next.recall(message, sender, at_seconds(2.0));
  EXPECT_GE(withdrawals(ground, 6.0, 28.0, record_it), 4);
  EXPECT_GE(withdrawals(next, 30.0, 50.0, [](const Message&) {}), 4);

  // Another leader that has not heard of it is refused at once, and the operator is not asked.
  request.round = {{{3}, {78}, 1}, 1};
  request.decide_by = at_seconds(80.0);
  next.on_message(request, {3}, at_seconds(51.0));
  bool refused = false;
  while (const auto message = next.poll_message()) {
    const auto* decision = std::get_if<Authorisation>(&*message);
    refused = refused || (decision != nullptr && !decision->granted &&
                          decision->round == request.round && decision->decided_by == "Ada");
  }
  EXPECT_TRUE(refused);
}

TEST(GroundNode, WhatIsTakenBackIsToldAsAWithdrawalAndAskedNoMore) {
  GroundNode ground = node();
  AuthorisationRequest request;
  request.round = kRound;
  request.site = kSite;
  request.deliveries = {{{{kSite, TaskKind::deliver, 0}, kVehicle, at_seconds(40.0)}, 0.0}};
  request.decide_by = at_seconds(20.0);
  ground.on_message(request, kVehicle, at_seconds(1.0));
  ASSERT_TRUE(ground.agent().authorise(kSite, "Ada", at_seconds(2.0), true));
  ASSERT_TRUE(ground.agent().take_back(kSite, "Ada", at_seconds(3.0)));
  bool withdrawn = false;
  std::optional<Authorisation> last;
  for (double s = 3.0; s < 12.0; s += 0.5) {
    ground.on_timeout(at_seconds(s));
    while (const auto message = ground.poll_message()) {
      if (const auto* decision = std::get_if<Authorisation>(&*message)) last = *decision;
      const auto* report = std::get_if<SiteReport>(&*message);
      withdrawn = withdrawn || (report != nullptr && report->withdrawn);
    }
  }
  ASSERT_TRUE(last);
  EXPECT_FALSE(last->granted);
  EXPECT_TRUE(withdrawn);
  request.round = {{{3}, {78}, 1}, 1};
  ground.on_message(request, {3}, at_seconds(13.0));
  EXPECT_FALSE(ground.agent().authorise(kSite, "Ada", at_seconds(13.0), true));
}

TEST(GroundNode, SendsNoCopterHomeThatIsInAFormation) {
  GroundNode ground = node();
  const auto home = [&](VehicleId vehicle) {
    return ground.command(vehicle, CommandKind::return_home, at_seconds(1.0));
  };
  EXPECT_TRUE(home({1}).ok()) << "it was not heard in one";
  FormationStatus status;
  for (const std::uint16_t id : {std::uint16_t{1}, std::uint16_t{2}}) {
    status.vehicle = {id};
    ground.on_message(status, {id}, at_seconds(1.0));
  }
  ASSERT_FALSE(home({1}).ok());
  EXPECT_EQ(home({1}).error().message.find("vehicle 1 flies in a formation of copters"), 0U);
  EXPECT_TRUE(ground.command({1}, CommandKind::hold, at_seconds(1.0)).ok());
  EXPECT_TRUE(home({3}).ok());
  EXPECT_TRUE(home(kGroundStation).ok()) << "the third does";
  status.vehicle = {3};
  ground.on_message(status, {3}, at_seconds(1.0));
  EXPECT_FALSE(home(kGroundStation).ok());
}

TEST(GroundNode, OrdersToLandOnlyWhoIsOrderedHomeAndRefusesOthersWithTheRemedy) {
  GroundNode ground = node();
  Telemetry telemetry = telemetry_of(Activity::searching);
  ground.on_message(telemetry, kVehicle, at_seconds(1.0));
  const auto land = [&](VehicleId vehicle, double s) {
    return ground.command(vehicle, CommandKind::land, at_seconds(s));
  };
  const auto ordered = [&](double s) {
    int told = 0;
    ground.on_timeout(at_seconds(s));
    while (const auto message = ground.poll_message()) {
      const auto* command = std::get_if<Command>(&*message);
      const bool lands = command != nullptr && command->kind == CommandKind::land;
      told += lands && command->vehicle == kVehicle ? 1 : 0;
    }
    return told;
  };
  ASSERT_FALSE(land(kVehicle, 1.0).ok());
  EXPECT_NE(land(kVehicle, 1.0).error().message.find("order 'return"), std::string::npos);
  EXPECT_FALSE(land(kGroundStation, 1.0).ok());
  EXPECT_EQ(ordered(1.5), 0);
  ASSERT_TRUE(ground.command(kVehicle, CommandKind::return_home, at_seconds(2.0)).ok());
  EXPECT_EQ(ordered(2.5), 0);
  telemetry.activity = Activity::holding;
  ground.on_message(telemetry, kVehicle, at_seconds(3.0));
  ASSERT_TRUE(land(kVehicle, 3.0).ok());
  EXPECT_GE(ordered(3.5), 1);
}

TEST(GroundNode, HearsOfAFormationAndTellsOfIt) {
  GroundNode ground = node();
  FormationStatus status;
  status.vehicle = kVehicle;
  ASSERT_TRUE(ground.on_message(status, kVehicle, at_seconds(1.0)));
  ASSERT_TRUE(ground.formation().members().contains(kVehicle));
  ground.on_timeout(at_seconds(10.0));
  // Silent: both the log and whoever listens are told.
  const auto event = ground.poll_event();
  ASSERT_TRUE(event);
  const auto* warning = std::get_if<event::FormationWarning>(&event->body);
  ASSERT_NE(warning, nullptr);
  EXPECT_EQ(warning->news, event::FormationNews::lost);
  auto message = ground.poll_message();
  if (message && std::holds_alternative<mission::Setup>(*message)) message = ground.poll_message();
  ASSERT_TRUE(message);
  EXPECT_TRUE(std::holds_alternative<MissionEvent>(*message));
}

TEST(GroundNode, TwoThatAnswerToOneIdAreFoundInTheOneFleetPicture) {
  GroundNode ground = node();
  Telemetry telemetry;
  telemetry.vehicle = kVehicle;
  const auto hear = [&](std::uint64_t instance, double seconds) {
    telemetry.instance = {instance};
    telemetry.state.time = at_seconds(seconds);
    ground.on_message(telemetry, kVehicle, at_seconds(seconds));
  };
  hear(1, 1.0);
  hear(2, 1.1);
  EXPECT_FALSE(ground.fleet().duplicate(kVehicle));  // could be a restart
  hear(1, 1.2);
  EXPECT_TRUE(ground.fleet().duplicate(kVehicle));
  EXPECT_FALSE(ground.agent().command(kVehicle, CommandKind::hold, at_seconds(1.3)).ok());
  ground.on_timeout(at_seconds(7.0));
  EXPECT_FALSE(ground.fleet().duplicate(kVehicle));
}

TEST(GroundNode, ARevokedVehicleIsNotWorkedWithUntilItIsEnrolledAnew) {
  GroundNode ground = node();
  Telemetry telemetry;
  telemetry.vehicle = kVehicle;
  telemetry.instance = {1};
  ground.on_message(telemetry, kVehicle, at_seconds(1.0));
  EXPECT_TRUE(ground.agent().command(kVehicle, CommandKind::hold, at_seconds(1.1)).ok());
  ground.set_revoked({kVehicle});
  const auto refused = ground.agent().command(kVehicle, CommandKind::hold, at_seconds(1.2));
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, testing::HasSubstr("enrol it with new keys"));
  ground.set_revoked({});
  EXPECT_TRUE(ground.agent().command(kVehicle, CommandKind::hold, at_seconds(1.3)).ok());
}

TEST(GroundNode, ALateCopyOfTelemetryGivesNobodyBack) {
  GroundNode ground = node();
  FormationStatus status;
  status.vehicle = kVehicle;
  ground.on_message(status, kVehicle, at_seconds(1.0));
  Telemetry flown = telemetry_of(Activity::holding);
  flown.state.time = at_seconds(1.0);
  Telemetry piloted = flown;
  piloted.detail = ActivityDetail::piloted;
  piloted.state.time = at_seconds(2.0);
  for (const Telemetry& heard : {flown, piloted, flown}) {
    EXPECT_TRUE(ground.on_message(heard, kVehicle, at_seconds(2.0)));
  }
  EXPECT_TRUE(ground.formation().members().at(kVehicle).piloted);
  flown.state.time = at_seconds(3.0);
  ground.on_message(flown, kVehicle, at_seconds(3.0));
  EXPECT_FALSE(ground.formation().members().at(kVehicle).piloted);
}

template <class T>
std::vector<T> said_of(GroundNode& ground) {
  std::vector<T> found;
  while (const auto message = ground.poll_message()) {
    if (const auto* wanted = std::get_if<T>(&*message)) found.push_back(*wanted);
  }
  return found;
}

Setup setup_of(VehicleId vehicle, const std::string& latitude) {
  SetupBook book{
      {.common = {{"origin.latitude_deg", setup_hash(latitude)}}}, vehicle, {5}, at_seconds(1.0)};
  return *book.poll_setup({}, at_seconds(1.0));
}

TEST(GroundNode, DoesNotWorkWithAVehicleOfAnotherSetup) {
  GroundNodeConfig config;
  config.agent.expected = {{1}, {2}, {3}};
  config.formation.vehicles = {{1}, {2}, {3}};
  config.setup = {.common = {{"origin.latitude_deg", setup_hash("48.1")}}};
  GroundNode ground{config, Instant{}};
  AuthorisationRequest request;
  request.round = kRound;
  request.site = kSite;
  request.decide_by = at_seconds(20.0);
  ASSERT_TRUE(ground.on_message(request, kVehicle, at_seconds(1.0)));

  ground.on_message(setup_of(kVehicle, "48.2"), kVehicle, at_seconds(1.0));
  const auto resumed = ground.command(kVehicle, CommandKind::resume, at_seconds(1.0));
  ASSERT_FALSE(resumed.ok());
  EXPECT_NE(resumed.error().message.find("another origin.latitude_deg"), std::string::npos);
  EXPECT_FALSE(ground.agent().authorise(kSite, "test", at_seconds(1.0)).ok());
  EXPECT_FALSE(ground.formation().preview({}).ok());
  EXPECT_NE(ground.formation().preview({}).error().message.find("origin"), std::string::npos);
  EXPECT_TRUE(ground.command(kVehicle, CommandKind::hold, at_seconds(1.0)).ok());
  const auto event = ground.poll_event();
  ASSERT_TRUE(event);
  EXPECT_EQ(event->body, EventBody{(event::SetupDiffers{kVehicle, "origin.latitude_deg", 0.0})});

  ground.on_message(setup_of(kVehicle, "48.1"), kVehicle, at_seconds(2.0));
  EXPECT_TRUE(ground.command(kVehicle, CommandKind::resume, at_seconds(2.0)).ok());
  EXPECT_TRUE(ground.agent().authorise(kSite, "test", at_seconds(2.0), true).ok());
}

TEST(GroundNode, AnIdThatWasUsedTwiceBarsNoFormationAfterASetupThatAgrees) {
  GroundNodeConfig config;
  config.agent.expected = config.formation.vehicles = {{1}, {2}, {3}};
  config.setup = {.common = {{"origin.latitude_deg", setup_hash("48.1")}}};
  GroundNode ground{config, Instant{}};
  Telemetry telemetry;
  telemetry.vehicle = kVehicle;
  for (const std::uint64_t instance : {1U, 2U, 1U}) {
    telemetry.instance = {instance};
    ground.on_message(telemetry, kVehicle, at_seconds(1.0));
  }
  ASSERT_TRUE(ground.fleet().duplicate(kVehicle));
  ground.on_message(setup_of(kVehicle, "48.2"), kVehicle, at_seconds(1.0));
  ASSERT_TRUE(ground.formation().barred().why());
  ground.on_message(setup_of(kVehicle, "48.1"), kVehicle, at_seconds(2.0));
  EXPECT_FALSE(ground.formation().barred().why());
}

TEST(GroundNode, TellsAVehicleThatStartedAnewWhichOrdersStand) {
  GroundNode ground = node();
  ASSERT_TRUE(ground.command(kGroundStation, CommandKind::hold, at_seconds(1.0)).ok());
  for (int second = 2; second < 10; ++second) ground.on_timeout(at_seconds(second));
  (void)said_of<Command>(ground);
  mission::Setup asks = setup_of(kVehicle, "");
  asks.knows_orders = false;
  ground.on_message(asks, kVehicle, at_seconds(60.0));
  auto told = said_of<Command>(ground);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].vehicle, kVehicle);
  EXPECT_EQ(told[0].kind, CommandKind::hold);
  // It has heard; another has missed the order.
  asks.knows_orders = true;
  asks.newest_order = told[0].number;
  ground.on_message(asks, kVehicle, at_seconds(61.0));
  EXPECT_TRUE(said_of<Command>(ground).empty());
  mission::Setup missed = setup_of({1}, "");
  ground.on_message(missed, {1}, at_seconds(61.0));
  EXPECT_EQ(said_of<Command>(ground).size(), 1U);
}

TEST(GroundNode, ThatStartedAnewWithoutRecollectionLetsOthersAnswerFirst) {
  GroundNodeConfig config;
  config.agent.expected = {{1}, {2}, {3}};
  GroundNode ground{config, at_seconds(100.0)};
  mission::Setup asks = setup_of(kVehicle, "");
  asks.knows_orders = false;
  ground.on_message(asks, kVehicle, at_seconds(101.0));
  EXPECT_TRUE(said_of<Command>(ground).empty());
  ground.on_message(asks, kVehicle, at_seconds(110.0));
  EXPECT_EQ(said_of<Command>(ground).size(), 1U);

  GroundNode recalls{config, at_seconds(100.0)};
  Command passed_on{kVehicle, 9, CommandKind::resume};
  passed_on.told_by = {2};
  recalls.recall(passed_on, {2}, at_seconds(1.0));  // which it has heard, and not said
  recalls.recall(Command{kVehicle, 5, CommandKind::hold}, kGroundStation, at_seconds(1.0));
  recalls.on_message(asks, kVehicle, at_seconds(101.0));
  const auto told = said_of<Command>(recalls);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].kind, CommandKind::hold);
}

/// What it says in so many steps of half a second.
std::vector<Message> said_by(GroundNode& node, double from_s, double to_s) {
  std::vector<Message> all;
  for (double s = from_s; s < to_s; s += 0.5) {
    node.on_timeout(at_seconds(s));
    while (auto message = node.poll_message()) all.push_back(*std::move(message));
  }
  return all;
}
template <class T>
std::vector<T> of(const std::vector<Message>& messages) {
  std::vector<T> all;
  for (const Message& message : messages) {
    if (const auto* one = std::get_if<T>(&message)) all.push_back(*one);
  }
  return all;
}
AuthorisationRequest request_until(double s) {
  AuthorisationRequest request;
  request.round = kRound;
  request.site = kSite;
  request.decide_by = at_seconds(s);
  request.deliveries = {{{{kSite, TaskKind::deliver, 0}, kVehicle, at_seconds(s)}, 0.0}};
  return request;
}

TEST(GroundNode, WhoWatchesSaysNothingAndGoesOnFromWhatTheOtherHasSaid) {
  GroundNode ground = node();
  ground.watch(at_seconds(1.0));
  const AuthorisationRequest request = request_until(40.0);
  ground.on_message(request, kVehicle, at_seconds(2.0));
  Authorisation grant{request.round,      kSite, true, "Ada", at_seconds(3.0),
                      request.deliveries, {},    {}};
  grant.until = at_seconds(40.0);
  grant.approval = {1, 2, 3};
  EXPECT_TRUE(ground.on_message(grant, kGroundStation, at_seconds(3.0)));
  Command hold{.vehicle = {1}, .kind = CommandKind::hold};
  set_number(hold, 4001);
  ground.on_message(hold, kGroundStation, at_seconds(4.0));
  Site site;
  site.id = {10005};
  ground.on_message(SiteReport{{}, site, true}, kGroundStation, at_seconds(5.0));
  Detection seen;
  seen.vehicle = kVehicle;
  ground.on_message(seen, kVehicle, at_seconds(5.0));
  EXPECT_TRUE(said_by(ground, 5.0, 15.0).empty());
  ASSERT_EQ(ground.agent().authorisations().size(), 1U);
  EXPECT_TRUE(ground.agent().authorisations().front().decision);
  int authorised = 0;
  while (const auto event = ground.poll_event()) {
    authorised += event->kind() == EventKind::authorised ? 1 : 0;
  }
  EXPECT_EQ(authorised, 1) << "it is shown";

  ground.take_command({99}, at_seconds(15.0));
  const auto said = said_by(ground, 15.0, 20.0);
  ASSERT_FALSE(of<mission::Setup>(said).empty());
  EXPECT_EQ(of<mission::Setup>(said).front().instance, InstanceId{99});
  const auto grants = of<Authorisation>(said);
  ASSERT_GE(grants.size(), 3U) << "who has not heard it yet";
  EXPECT_EQ(grants.front().approval, grant.approval) << "the operator's own";
  const auto sites = of<SiteReport>(said);
  ASSERT_FALSE(sites.empty());
  EXPECT_TRUE(sites.front().withdrawn);
  // Who started anew and asks is told what the other ordered, when others had their time.
  mission::Setup asks;
  asks.node = {1};
  asks.instance = {5};
  asks.knows_orders = false;
  asks.newest_order = 4001;
  ground.on_message(asks, {1}, at_seconds(21.0));
  EXPECT_TRUE(of<Command>(said_by(ground, 21.0, 22.0)).empty());
  ground.on_message(asks, {1}, at_seconds(26.0));
  const auto told = of<Command>(said_by(ground, 26.0, 27.0));
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told.front().kind, CommandKind::hold);
}

/// Said in the moment in which the command was taken, and obeyed by who heard it.
TEST(GroundNode, WhatTheOtherHasTakenBackIsNotAskedForByWhoHasTheCommandByThen) {
  GroundNode ground = node();
  ground.watch(at_seconds(1.0));
  AuthorisationRequest request = request_until(40.0);
  ground.on_message(request, kVehicle, at_seconds(2.0));
  Authorisation word{request.round,      kSite, true, "Ada", at_seconds(3.0),
                     request.deliveries, {},    {}};
  word.until = at_seconds(40.0);
  ground.on_message(word, kGroundStation, at_seconds(3.0));
  ground.take_command({99}, at_seconds(10.0));
  word.granted = false;
  word.decided_at = at_seconds(9.9);
  EXPECT_TRUE(ground.on_message(word, kGroundStation, at_seconds(10.1)));
  ++request.round.number;
  ground.on_message(request, kVehicle, at_seconds(15.0));
  EXPECT_FALSE(ground.agent().authorise(kSite, "Ben", at_seconds(16.0), true));
  const auto said = said_by(ground, 16.0, 20.0);
  for (const Authorisation& decision : of<Authorisation>(said)) EXPECT_FALSE(decision.granted);
  ASSERT_FALSE(of<SiteReport>(said).empty());
  EXPECT_TRUE(of<SiteReport>(said).front().withdrawn);
}

TEST(GroundNode, AnOlderRefusalOfTheOtherDoesNotEndWhatIsGrantedSince) {
  GroundNode ground = node();
  const AuthorisationRequest request = request_until(40.0);
  ground.on_message(request, kVehicle, at_seconds(12.0));
  ASSERT_TRUE(ground.agent().authorise(kSite, "Ben", at_seconds(13.0), true));
  const Authorisation late{request.round, kSite, false, "Ada", at_seconds(9.0), {}, {}, {}};
  ground.on_message(late, kGroundStation, at_seconds(14.0));
  ASSERT_EQ(ground.agent().authorisations().size(), 1U);
  EXPECT_TRUE(ground.agent().authorisations().front().decision->granted);
  EXPECT_TRUE(of<SiteReport>(said_by(ground, 14.0, 24.0)).empty());
}

TEST(GroundNode, WhoHasNotHeardAnOrderThatStandsLeavesTheAnswerToVehicles) {
  GroundNode ground = node();
  ground.watch(at_seconds(1.0));
  ground.take_command(InstanceId{9}, at_seconds(10.0));
  ground.on_message(telemetry_of(Activity::holding), kVehicle, at_seconds(20.0));
  mission::Setup obeys = setup_of(kVehicle, "");
  obeys.newest_order = 13'270;  // of who had the command before, out of reach of this one
  ground.on_message(obeys, kVehicle, at_seconds(20.0));
  mission::Setup asks = setup_of({1}, "");
  asks.knows_orders = false;
  ground.on_message(asks, {1}, at_seconds(20.0));
  EXPECT_TRUE(said_of<Command>(ground).empty()) << "that no order stands";
  ASSERT_TRUE(ground.command(kGroundStation, CommandKind::hold, at_seconds(21.0)).ok());
  const auto said = said_of<Command>(ground);
  ASSERT_FALSE(said.empty());
  obeys.newest_order = number_of(said.back());
  ground.on_message(obeys, kVehicle, at_seconds(22.0));
  ground.on_message(asks, {1}, at_seconds(22.0));
  const auto told = said_of<Command>(ground);
  const auto answer = std::ranges::find(told, VehicleId{1}, &Command::vehicle);
  ASSERT_NE(answer, told.end());
  EXPECT_EQ(answer->kind, CommandKind::hold);
}

TEST(GroundNode, WhoHasWatchedDoesNotGoOnWithTheLandingsOfBefore) {
  GroundNode ground = node();
  Telemetry telemetry = telemetry_of(Activity::holding);
  ground.on_message(telemetry, kVehicle, at_seconds(1.0));
  ASSERT_TRUE(ground.command(kVehicle, CommandKind::return_home, at_seconds(2.0)).ok());
  ASSERT_TRUE(ground.command(kVehicle, CommandKind::land, at_seconds(3.0)).ok());
  ground.watch(at_seconds(3.0));  // before its turn has come
  ground.take_command({99}, at_seconds(60.0));
  for (const Command& command : of<Command>(said_by(ground, 60.0, 90.0))) {
    EXPECT_NE(command.kind, CommandKind::land);
  }
}

TEST(GroundNode, WhatItHasOrderedSinceItTookTheCommandStands) {
  GroundNode ground = node();
  ground.watch(at_seconds(1.0));
  ground.take_command({99}, at_seconds(10.0));
  ASSERT_TRUE(ground.command({1}, CommandKind::hold, at_seconds(11.0)).ok());
  const auto ordered = of<Command>(said_by(ground, 11.0, 20.0));
  ASSERT_FALSE(ordered.empty());
  // Meanwhile the other one, which it cannot know to be superseded, has it resume.
  mission::Setup setup;
  setup.node = {1};
  setup.instance = {5};
  setup.knows_orders = true;
  setup.newest_order = 15'001;
  ground.on_message(setup, {1}, at_seconds(20.0));
  const auto again = of<Command>(said_by(ground, 20.0, 20.5));
  ASSERT_EQ(again.size(), 1U);
  EXPECT_EQ(again.front().kind, CommandKind::hold);
  EXPECT_GT(number_of(again.front()), 15'001U);
  (void)said_by(ground, 20.5, 29.0);  // it is said again for a while
  setup.newest_order = number_of(again.front());
  ground.on_message(setup, {1}, at_seconds(30.0));
  for (const Command& said : of<Command>(said_by(ground, 30.0, 31.0))) {
    EXPECT_EQ(number_of(said), setup.newest_order) << "the same, said again";
  }
}

TEST(GroundNode, ItsOrdersHaveGreaterNumbersThanAnyThatAVehicleHasHeardOf) {
  GroundNode ground = node();
  mission::Setup setup;
  setup.node = {1};
  setup.instance = {5};
  setup.knows_orders = true;
  setup.newest_order = 30'001;
  ground.on_message(setup, {1}, at_seconds(10.0));
  setup.newest_order = ~std::uint64_t{0};  // no order's
  ground.on_message(setup, {1}, at_seconds(10.0));
  ASSERT_TRUE(ground.command({1}, CommandKind::hold, at_seconds(11.0)).ok());
  const auto said = of<Command>(said_by(ground, 11.0, 11.5));
  ASSERT_FALSE(said.empty());
  EXPECT_EQ(number_of(said.front()), 30'002U);
}

}  // namespace
}  // namespace skein::mission
