// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/vehicle_node.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace skein::mission {
namespace {

constexpr VehicleId kSelf{4};

VehicleNodeConfig config() {
  VehicleAgentConfig c;
  c.vehicle.id = kSelf;
  c.vehicle.cruise_speed_mps = 50.0;
  c.vehicle.speed_min_mps = 40.0;
  c.vehicle.speed_max_mps = 60.0;
  c.vehicle.turn_radius_m = 100.0;
  c.vehicle.range_m = 50000.0;
  c.vehicle.sensor_radius_m = 300.0;
  c.vehicle.assess_radius_m = 300.0;
  c.vehicle.capabilities.add(TaskKind::survey);
  c.instance = {99};
  c.search = {{3000.0, 0.0}};
  return {.agent = c, .program = "skein-onboard 1.0", .flight_controller = "ardupilot"};
}

struct Vehicle {
  explicit Vehicle(const VehicleNodeConfig& what = config(), Instant from = at_seconds(-5.0))
      : node{what, from} {}
  void step(double seconds) {
    now = at_seconds(seconds);
    node.on_state({.time = now, .groundspeed_mps = 50.0, .airspeed_mps = 50.0}, now);
    node.on_timeout(now);
    drain();
  }
  void hear(const Message& message, VehicleId sender) {
    node.on_message(message, sender, now);
    drain();
  }
  void drain() {
    while (auto message = node.poll_message()) said.push_back(std::move(*message));
    while (auto guidance = node.poll_guidance()) guided = std::get<FlightPlan>(*guidance).number;
    while (node.poll_event()) {
    }
  }
  template <class T>
  [[nodiscard]] std::vector<T> said_of() const {
    std::vector<T> found;
    for (const auto& message : said) {
      if (const auto* wanted = std::get_if<T>(&message)) found.push_back(*wanted);
    }
    return found;
  }

  VehicleNode node;
  Instant now{};
  std::vector<Message> said;
  std::uint32_t guided = 0;
};

TEST(VehicleNode, IsOnTheNetworkBeforeTheMissionButDoesNotFly) {
  Vehicle vehicle;
  for (int i = 0; i < 98; ++i) vehicle.step(-5.0 + 0.05 * i);
  EXPECT_NEAR(static_cast<double>(vehicle.said_of<Telemetry>().size()), 10.0, 1.0);
  EXPECT_EQ(vehicle.said_of<Health>().size(), 5U);
  EXPECT_EQ(vehicle.guided, 0U);
  vehicle.step(0.05);
  EXPECT_NE(vehicle.guided, 0U);  // the search begins
}

TEST(VehicleNode, TellsOfItself) {
  Vehicle vehicle;
  vehicle.node.on_condition({.mode = "GUIDED", .overruns = 7, .dropped = 3});
  vehicle.step(1.0);
  const auto telemetry = vehicle.said_of<Telemetry>();
  ASSERT_EQ(telemetry.size(), 1U);
  EXPECT_EQ(telemetry[0].vehicle, kSelf);
  EXPECT_EQ(telemetry[0].instance, InstanceId{99});
  EXPECT_EQ(telemetry[0].state.time, at_seconds(1.0));
  EXPECT_EQ(telemetry[0].control_overruns, 7U);
  EXPECT_EQ(telemetry[0].messages_dropped, 3U);
  const auto health = vehicle.said_of<Health>();
  ASSERT_EQ(health.size(), 1U);
  EXPECT_EQ(health[0].vehicle, kSelf);
  EXPECT_EQ(health[0].instance, InstanceId{99});
  EXPECT_EQ(health[0].program, "skein-onboard 1.0");
  EXPECT_EQ(health[0].flight_controller, "ardupilot");
  EXPECT_EQ(health[0].mode, "GUIDED");
  EXPECT_EQ(health[0].problems, (std::vector<std::string>{"7 control periods missed",
                                                          "3 messages or records dropped"}));
  ASSERT_EQ(vehicle.said_of<PlanReport>().size(), 1U);
  EXPECT_EQ(vehicle.said_of<PlanReport>()[0].plan.number, vehicle.guided);
}

TEST(VehicleNode, RefusesWhatIsNotItsSendersToSay) {
  Vehicle vehicle;
  vehicle.step(0.0);
  const Command hold{kSelf, 10, CommandKind::hold};
  vehicle.hear(hold, {9});
  vehicle.hear(Authorisation{}, {9});
  Telemetry namesake;
  namesake.vehicle = kSelf;
  vehicle.hear(namesake, {9});  // its id is not used twice: another says so
  EXPECT_EQ(vehicle.node.counters().refused, 3U);
  EXPECT_TRUE(vehicle.said_of<MissionEvent>().empty());
  vehicle.step(1.0);
  EXPECT_EQ(vehicle.said_of<Health>().back().problems,
            std::vector<std::string>{"3 messages refused: not their sender's to say"});
  EXPECT_TRUE(vehicle.said_of<Health>().back().heard.empty());
  // From the ground station it is obeyed: the number was not used up.
  vehicle.hear(hold, kGroundStation);
  EXPECT_EQ(vehicle.node.counters().refused, 3U);
  EXPECT_FALSE(vehicle.said_of<MissionEvent>().empty());
}

TEST(VehicleNode, IsGivenBackByThatCommandToThisVehicleOnceEach) {
  Vehicle vehicle;
  std::vector<Instant> given_back;
  const auto hear = [&](const Command& command, VehicleId sender) {
    vehicle.hear(command, sender);
    while (const auto issued = vehicle.node.poll_give_back()) given_back.push_back(*issued);
  };
  hear({kSelf, 9'001, CommandKind::give_back}, {9});
  hear({kSelf, 10'001, CommandKind::give_back}, kGroundStation);
  hear({kSelf, 10'001, CommandKind::give_back}, kGroundStation);
  hear({kGroundStation, 10'002, CommandKind::give_back}, kGroundStation);
  hear({{5}, 10'003, CommandKind::give_back}, kGroundStation);
  hear({kGroundStation, 10'004, CommandKind::resume}, kGroundStation);
  hear({kSelf, 10'005, CommandKind::resume}, kGroundStation);
  EXPECT_EQ(given_back, std::vector{at_seconds(10.0)});
}

TEST(VehicleNode, TheFlightControllersWarningsAreForTheOperator) {
  Vehicle vehicle;
  vehicle.node.on_notice({at_seconds(0.5), false, {AutopilotNews::found}}, at_seconds(0.5));
  vehicle.node.on_notice({at_seconds(0.7), true, {AutopilotNews::rebooted}}, at_seconds(0.7));
  vehicle.drain();
  const auto events = vehicle.said_of<MissionEvent>();
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events[0].vehicle, kSelf);
  EXPECT_EQ(events[0].time, at_seconds(0.7));
  EXPECT_EQ(events[0].body, EventBody{(event::FlightWarning{{AutopilotNews::rebooted}})});
}

TEST(VehicleNode, AMultirotorIsANodeTheSame) {
  FormationAgentConfig agent;
  agent.vehicle = kSelf;
  agent.instance = {5};
  VehicleNode node{{.agent = agent, .program = "p", .flight_controller = "simulated"}, Instant{}};
  node.on_state({.time = at_seconds(0.0), .z_m = 2.0}, at_seconds(0.0));
  node.on_timeout(at_seconds(0.0));
  int told = 0;
  while (const auto message = node.poll_message()) {
    if (const auto* telemetry = std::get_if<Telemetry>(&*message)) {
      EXPECT_EQ(telemetry->state.z_m, 2.0);
      EXPECT_EQ(telemetry->instance, InstanceId{5});
      ++told;
    }
    if (std::holds_alternative<Health>(*message)) ++told;
    EXPECT_FALSE(std::holds_alternative<PlanReport>(*message));
  }
  EXPECT_EQ(told, 2);
}

// --- what all have in common ---

SetupParams setup(const std::string& latitude) {
  return {.common = {{"origin.latitude_deg", setup_hash(latitude)}}};
}
Setup said_by(VehicleId node, const std::string& latitude, Instant when) {
  SetupBook book{setup(latitude), node, {1}, when};
  return *book.poll_setup({}, when);
}
VehicleNodeConfig config_at(const std::string& latitude) {
  VehicleNodeConfig c = config();
  c.setup = setup(latitude);
  return c;
}

TEST(VehicleNode, HoldsWhileItsSetupIsNotTheGroundStations) {
  Vehicle vehicle{config_at("48.1"), at_seconds(-5.0)};
  vehicle.step(0.0);
  vehicle.step(1.0);
  EXPECT_EQ(vehicle.node.agent().telemetry().activity, Activity::searching);

  vehicle.hear(said_by(kGroundStation, "48.2", vehicle.now), kGroundStation);
  vehicle.step(1.1);
  EXPECT_EQ(vehicle.node.agent().telemetry().activity, Activity::holding);
  const auto events = vehicle.said_of<MissionEvent>();
  ASSERT_FALSE(events.empty());
  EXPECT_EQ(events.back().body,
            EventBody{(event::SetupDiffers{kGroundStation, "origin.latitude_deg", 0.0})});
  vehicle.step(2.2);
  EXPECT_EQ(
      vehicle.said_of<Health>().back().problems,
      std::vector<std::string>{"the ground station has another origin.latitude_deg: it holds"});

  vehicle.hear(said_by(kGroundStation, "48.1", vehicle.now), kGroundStation);
  vehicle.step(2.3);
  EXPECT_EQ(vehicle.node.agent().telemetry().activity, Activity::searching);
}

TEST(VehicleNode, AnOrderAndTheWayHomeComeBeforeADifference) {
  Vehicle vehicle{config_at("48.1"), at_seconds(-5.0)};
  vehicle.step(0.0);
  vehicle.hear(Command{kSelf, 2'001, CommandKind::return_home}, kGroundStation);
  const std::uint32_t homeward = vehicle.guided;
  vehicle.hear(said_by(kGroundStation, "48.2", vehicle.now), kGroundStation);
  vehicle.step(0.1);
  EXPECT_EQ(vehicle.guided, homeward) << "it flies home";
  vehicle.hear(Command{kSelf, 3'001, CommandKind::resume}, kGroundStation);
  vehicle.step(0.2);
  EXPECT_EQ(vehicle.node.agent().telemetry().activity, Activity::holding) << "and no search";
}

coalition::Announcement announcement(VehicleId leader) {
  coalition::Announcement call;
  call.round = {{leader, {1}, 1}, 1};
  call.site.id = {3};
  call.site.position = {500.0, 0.0};
  call.tasks = {{{3}, TaskKind::assess, 0}};
  call.site.assessments = {{.dwell = std::chrono::seconds{5}}};
  call.announced_at = at_seconds(1.0);
  call.bids_until = at_seconds(1.5);
  call.formed_at = at_seconds(2.5);
  call.reward = 1.0;
  return call;
}

TEST(VehicleNode, DoesNotBidForALeaderOfAnotherSetup) {
  for (const bool differs : {false, true}) {
    VehicleNodeConfig c = config_at("48.1");
    std::get<VehicleAgentConfig>(c.agent).vehicle.capabilities.add(TaskKind::assess);
    Vehicle vehicle{c, at_seconds(-5.0)};
    vehicle.step(1.0);
    vehicle.hear(said_by({9}, differs ? "48.2" : "48.1", vehicle.now), {9});
    vehicle.hear(coalition::Message{announcement({9})}, {9});
    vehicle.step(1.1);
    EXPECT_EQ(vehicle.said_of<coalition::Message>().empty(), differs);
  }
}

TEST(VehicleNode, ThatStartsAnewHoldsUntilItIsToldWhichOrdersStand) {
  Vehicle vehicle{config(), at_seconds(100.0)};
  vehicle.step(100.0);
  vehicle.step(101.5);
  EXPECT_EQ(vehicle.node.agent().telemetry().activity, Activity::holding);
  const auto asked = vehicle.said_of<mission::Setup>();
  ASSERT_EQ(asked.size(), 2U);
  EXPECT_FALSE(asked.back().knows_orders);

  Command other{{5}, 0, CommandKind::resume};
  vehicle.hear(other, kGroundStation);
  vehicle.hear(Command{kGroundStation, 99'001, CommandKind::resume}, kGroundStation);
  EXPECT_EQ(vehicle.node.agent().telemetry().activity, Activity::holding) << "not said to it";

  Command none{kSelf, 0, CommandKind::resume};
  none.told_by = {9};
  vehicle.hear(none, {9});
  EXPECT_EQ(vehicle.node.agent().telemetry().activity, Activity::searching);
  EXPECT_EQ(vehicle.said_of<MissionEvent>().back().body, EventBody{event::OrdersKnown{{9}}});
  vehicle.step(110.0);
  EXPECT_TRUE(vehicle.said_of<mission::Setup>().back().knows_orders);
}

TEST(VehicleNode, ThatStartsAnewUnderAHoldGoesOnHolding) {
  Vehicle vehicle{config(), at_seconds(100.0)};
  vehicle.step(100.0);
  Command hold{kSelf, 50'001, CommandKind::hold};
  hold.told_by = {9};
  vehicle.hear(hold, {9});
  vehicle.step(110.0);
  EXPECT_EQ(vehicle.node.agent().telemetry().activity, Activity::holding);
  // No other vehicle can order it from now on.
  Command resume{kSelf, 60'001, CommandKind::resume};
  resume.told_by = {9};
  vehicle.hear(resume, {9});
  EXPECT_EQ(vehicle.node.agent().telemetry().activity, Activity::holding);
  vehicle.hear(Command{kGroundStation, 60'002, CommandKind::resume}, kGroundStation);
  EXPECT_EQ(vehicle.node.agent().telemetry().activity, Activity::searching);
}

TEST(VehicleNode, TellsWhoDoesNotKnowWhichOrdersStandFromTheSecondTimeOn) {
  Vehicle vehicle;
  vehicle.step(0.0);
  vehicle.hear(Command{{7}, 5, CommandKind::hold}, kGroundStation);
  mission::Setup asks = said_by({7}, "", vehicle.now);
  asks.knows_orders = false;
  vehicle.hear(asks, {7});
  EXPECT_TRUE(vehicle.said_of<Command>().empty()) << "the ground station may answer";
  vehicle.hear(asks, {7});
  ASSERT_EQ(vehicle.said_of<Command>().size(), 1U);
  const Command told = vehicle.said_of<Command>().front();
  EXPECT_EQ(told.vehicle, VehicleId{7});
  EXPECT_EQ(told.number, 5U);
  EXPECT_EQ(told.kind, CommandKind::hold);
  EXPECT_EQ(told.told_by, kSelf);
}

HazardReport hazard(std::uint16_t id, double east_m) { return {{{id}, {east_m, 0.0}, 60.0}}; }

TEST(VehicleNode, PassesOnHazardsAndWithdrawnSitesToWhoStartsAnew) {
  Vehicle vehicle;
  vehicle.step(0.0);
  vehicle.hear(hazard(10'001, 9'000.0), kGroundStation);
  vehicle.hear(hazard(10'002, 9'500.0), kGroundStation);
  HazardReport gone = hazard(10'002, 9'500.0);
  gone.withdrawn = true;
  vehicle.hear(gone, kGroundStation);
  vehicle.hear(hazard(10'002, 9'500.0), kGroundStation);  // a late copy
  SiteReport withdrawn{{}, {}, true};
  withdrawn.site.id = {10'007};
  vehicle.hear(withdrawn, kGroundStation);
  SiteReport open = withdrawn;
  open.withdrawn = false;
  open.site.id = {10'008};
  vehicle.hear(open, kGroundStation);
  mission::Setup asks = said_by({7}, "", vehicle.now);
  asks.knows_orders = false;
  vehicle.hear(asks, {7});
  vehicle.hear(asks, {7});
  vehicle.step(1.0);  // its turn
  const auto hazards = vehicle.said_of<HazardReport>();
  ASSERT_EQ(hazards.size(), 1U) << "one is gone";
  EXPECT_EQ(hazards[0].hazard.id, HazardId{10'001});
  EXPECT_EQ(hazards[0].told_by, kSelf);
  const auto sites = vehicle.said_of<SiteReport>();
  ASSERT_EQ(sites.size(), 1U);
  EXPECT_EQ(sites[0].site.id, SiteId{10'007});

  // What another has passed on is not said once more.
  vehicle.hear(asks, {7});
  HazardReport of_other = hazard(10'001, 9'000.0);
  of_other.told_by = {9};
  vehicle.hear(of_other, {9});
  vehicle.step(3.0);
  EXPECT_EQ(vehicle.said_of<HazardReport>().size(), 1U);
  vehicle.hear(asks, {7});
  of_other.hazard.radius_m = 1.0;  // which is another one
  vehicle.hear(of_other, {9});
  vehicle.step(5.0);
  EXPECT_EQ(vehicle.said_of<HazardReport>().size(), 2U);
}

TEST(VehicleNode, TakesWhatIsPassedOnOnlyWhileItDoesNotKnowTheOrders) {
  Vehicle vehicle{config(), at_seconds(100.0)};
  vehicle.step(100.0);
  const auto knows = [&vehicle] {
    std::size_t known = 0;
    for (const MissionEvent& event : vehicle.said_of<MissionEvent>()) {
      known += event.kind() == EventKind::hazard_known ? 1U : 0U;
    }
    return known;
  };
  HazardReport told = hazard(10'001, 9'000.0);
  told.told_by = {9};
  vehicle.hear(told, {9});
  EXPECT_EQ(knows(), 1U);
  Command none{kSelf, 0, CommandKind::resume};
  none.told_by = {9};
  vehicle.hear(none, {9});
  told.hazard.id = {10'002};
  vehicle.hear(told, {9});
  EXPECT_EQ(knows(), 2U) << "others may answer for a while";
  vehicle.step(110.0);
  told.hazard.id = {10'003};
  vehicle.hear(told, {9});
  EXPECT_EQ(knows(), 2U);
  told.told_by = {8};
  vehicle.hear(told, {9});
  EXPECT_EQ(vehicle.node.counters().refused, 1U) << "in another's name";
}

TEST(VehicleNode, WhoPassesOrdersOnCannotTakeTheVehicleOver) {
  Vehicle vehicle{config(), at_seconds(100.0)};
  vehicle.step(100.0);
  Command endless{kSelf, 0, CommandKind::hold};
  set_number(endless, ~0ULL);
  endless.told_by = {9};
  vehicle.hear(endless, {9});
  Command give{kSelf, 50'001, CommandKind::give_back};
  give.told_by = {9};
  vehicle.hear(give, {9});
  EXPECT_EQ(vehicle.node.bar(), Bar::orders_unknown);
  vehicle.hear(Command{kSelf, 60'001, CommandKind::resume}, kGroundStation);
  EXPECT_EQ(vehicle.node.agent().telemetry().activity, Activity::searching);
  Command hold{kSelf, 70'001, CommandKind::hold};
  hold.told_by = {9};
  vehicle.hear(hold, {9});
  EXPECT_EQ(vehicle.node.agent().telemetry().activity, Activity::searching)
      << "the ground station has answered";
}

TEST(VehicleNode, OfTwoGroundStationsItTakesNothingButHoldAndReturn) {
  Vehicle vehicle{config(), at_seconds(0.0)};
  const auto setup_of_ground = [](std::uint64_t instance, double seconds) {
    mission::Setup setup;
    setup.node = kGroundStation;
    setup.instance = {instance};
    setup.time = at_seconds(seconds);
    setup.clock_guard = std::chrono::milliseconds{500};
    setup.knows_orders = true;
    return setup;
  };
  for (const auto& [instance, seconds] :
       {std::pair{1ULL, 1.0}, std::pair{2ULL, 2.0}, std::pair{1ULL, 6.0}}) {
    vehicle.hear(setup_of_ground(instance, seconds), kGroundStation);
    vehicle.step(seconds);
  }
  EXPECT_EQ(vehicle.node.bar(), Bar::setup_differs);
  EXPECT_EQ(vehicle.node.agent().telemetry().activity, Activity::holding);
}

TEST(VehicleNode, OrdersHaveNumbersAfterMoreThanFortyNineDays) {
  const Instant late = at_seconds(60.0 * 86'400.0);
  Command before{kSelf, 0, CommandKind::hold};
  set_number(before, 59ULL * 86'400'000ULL);
  Command after{kSelf, 0, CommandKind::resume};
  set_number(after, 60ULL * 86'400'000ULL + 1);
  EXPECT_EQ(issued_at(after), late);
  CommandFilter filter;
  EXPECT_TRUE(filter.take(before, kSelf));
  EXPECT_TRUE(filter.take(after, kSelf));
  EXPECT_FALSE(filter.take(before, kSelf));
  Command endless;
  set_number(endless, ~0ULL);
  EXPECT_GT(issued_at(endless), late);
}

TEST(VehicleNode, ThatIsToldThatNoneStandsHearsWhoKnowsBetterForAWhile) {
  Vehicle vehicle{config(), at_seconds(100.0)};
  vehicle.step(100.0);
  Command none{kSelf, 0, CommandKind::resume};
  none.told_by = {8};
  vehicle.hear(none, {8});
  vehicle.step(101.0);
  EXPECT_EQ(vehicle.node.agent().telemetry().activity, Activity::searching);
  Command hold{kSelf, 50'001, CommandKind::hold};
  hold.told_by = {9};
  vehicle.hear(hold, {9});
  EXPECT_EQ(vehicle.node.agent().telemetry().activity, Activity::holding);

  // And who has it from others alone tells nobody that none stands.
  mission::Setup asks = said_by({7}, "", vehicle.now);
  asks.knows_orders = false;
  vehicle.hear(asks, {7});
  vehicle.hear(asks, {7});
  EXPECT_TRUE(vehicle.said_of<Command>().empty());
}

TEST(VehicleNode, AnAircraftThatIsGivenBackBuriesNoHoldThatItMissed) {
  Vehicle vehicle;
  vehicle.step(1.0);
  vehicle.hear(Command{kSelf, 2'001, CommandKind::give_back}, kGroundStation);
  vehicle.step(10.0);
  EXPECT_EQ(vehicle.said_of<mission::Setup>().back().newest_order, 0U);
  vehicle.hear(Command{kSelf, 1'501, CommandKind::hold}, kGroundStation);
  EXPECT_EQ(vehicle.node.agent().telemetry().activity, Activity::holding);
}

TEST(VehicleNode, ACopterObeysWhatItHeardOnItsWayUp) {
  VehicleNodeConfig what = config();
  auto& agent = std::get<VehicleAgentConfig>(what.agent);
  agent.vehicle.airframe = Airframe::copter;
  agent.vehicle.height_m = 100.0;
  agent.vehicle.cruise_speed_mps = 8.0;
  agent.vehicle.speed_min_mps = 0.5;
  agent.vehicle.speed_max_mps = 10.0;
  agent.vehicle.turn_radius_m = 30.0;
  VehicleNode node{what, at_seconds(-1.0)};
  const auto at = [&node](double seconds, double height_m) {
    const Instant now = at_seconds(seconds);
    node.on_state({.time = now, .z_m = height_m}, now);
    node.on_timeout(now);
    while (node.poll_message()) {
    }
  };
  at(0.0, 0.0);
  at(1.0, 2.0);
  node.on_message(Command{kGroundStation, 1'001, CommandKind::hold}, kGroundStation,
                  at_seconds(1.0));
  for (int i = 0; i <= 200; ++i) at(1.5 + 0.5 * i, std::min(100.0, 2.0 + i));
  EXPECT_EQ(node.agent().telemetry().activity, Activity::holding);
}

Fence square(double half_m) {
  Fence fence;
  fence.corners = {{-half_m, -half_m}, {half_m, -half_m}, {half_m, half_m}, {-half_m, half_m}};
  return fence;
}

FenceOrder order_of(std::uint32_t number, const Fence& fence) {
  return {number, fence.corners, fence.height_max_m};
}

TEST(VehicleNode, KeepsTheFenceThatIsOrdered) {
  Vehicle vehicle;
  vehicle.step(1.0);
  EXPECT_EQ(vehicle.said_of<Health>().back().fence, 0U);
  const Message order{order_of(7, square(5000.0))};
  vehicle.hear(order, {2});
  EXPECT_FALSE(vehicle.node.poll_fence()) << "it is the ground station's to order";
  vehicle.hear(order, kGroundStation);
  vehicle.hear(order, kGroundStation);
  EXPECT_EQ(vehicle.node.poll_fence(), square(5000.0)) << "for its autopilot";
  EXPECT_FALSE(vehicle.node.poll_fence()) << "once";
  vehicle.hear(Message{order_of(6, square(4000.0))}, kGroundStation);
  EXPECT_FALSE(vehicle.node.poll_fence()) << "an older order";
  vehicle.step(3.0);
  EXPECT_EQ(vehicle.said_of<Health>().back().fence, digest_of(square(5000.0)));
  std::vector<event::FenceAnswered> answers;
  for (const auto& told : vehicle.said_of<MissionEvent>()) {
    if (const auto* answer = std::get_if<event::FenceAnswered>(&told.body)) {
      answers.push_back(*answer);
    }
  }
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_EQ(answers[0].number, 7U);
  EXPECT_TRUE(answers[0].taken);
}

TEST(VehicleNode, AFenceThatItIsOutsideOfIsAnsweredOnceAndLookedAtAgain) {
  Vehicle vehicle;
  vehicle.step(1.0);
  Fence aside = square(1000.0);
  for (Vec2& corner : aside.corners) corner.x() += 5000.0;
  Fence low = square(5000.0);
  low.height_max_m = 50.0;
  for (int i = 0; i < 3; ++i) vehicle.hear(Message{order_of(7, aside)}, kGroundStation);
  EXPECT_FALSE(vehicle.node.poll_fence());
  Fence crossed = square(1000.0);
  std::swap(crossed.corners[0], crossed.corners[1]);
  vehicle.hear(Message{order_of(8, crossed)}, kGroundStation);
  vehicle.node.on_state({.time = at_seconds(2.0), .z_m = 60.0}, at_seconds(2.0));
  vehicle.hear(Message{order_of(9, low)}, kGroundStation);
  vehicle.node.on_state({.time = at_seconds(3.0), .z_m = 40.0}, at_seconds(3.0));
  vehicle.hear(Message{order_of(9, low)}, kGroundStation);
  EXPECT_EQ(vehicle.node.poll_fence(), low);
  std::vector<std::string> answers;
  for (const auto& told : vehicle.said_of<MissionEvent>()) {
    if (const auto* answer = std::get_if<event::FenceAnswered>(&told.body)) {
      answers.push_back(answer->taken ? "taken" : answer->detail);
    }
  }
  EXPECT_EQ(answers,
            (std::vector<std::string>{"it is outside of it", "its edges cross or touch each other",
                                      "it flies above its height", "taken"}));
}

}  // namespace
}  // namespace skein::mission
