// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/ground_routes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace skein::mission {
namespace {

using ::testing::HasSubstr;

constexpr VehicleId kOne{1};
constexpr VehicleId kTwo{2};

/// North from there for 1 km, at 20 m/s.
TimedPath north(double east_m, double begins_s) {
  TimedPath timed;
  timed.start_time = at_seconds(begins_s);
  timed.speed_mps = 20.0;
  timed.path.start = {east_m, 0.0, 1.5707963};
  EXPECT_TRUE(timed.path.append(Segment{0.0, 900.0}));
  EXPECT_TRUE(timed.path.append(Segment{0.01, 100.0}));
  return timed;
}

struct GroundRoutesTest : ::testing::Test {
  GroundRoutesTest() {
    for (const VehicleId id : {kOne, kTwo}) {
      Telemetry t;
      t.vehicle = id;
      t.instance = {id.value + 10U};
      t.state.x_m = id == kOne ? 0.0 : 300.0;
      t.range_left_m = 20'000.0;
      heard[id] = t;
      hear(id);
    }
  }
  void hear(VehicleId id) {
    heard[id].state.time = now;
    fleet.on_message(Message{heard[id]}, now);
  }
  void run_until(double seconds) {
    while (now < at_seconds(seconds)) {
      now += std::chrono::milliseconds{250};
      for (const auto& [id, t] : heard) hear(id);
      routes.on_timeout(fleet, now);
      while (const auto message = routes.poll_message()) {
        said.push_back(std::get<Route>(*message));
        record.push_back(*message);
        answer(said.back());
      }
      while (auto event = routes.poll_event()) events.push_back(*event);
    }
  }
  /// What vehicles that hear everything say.
  void answer(const Route& route) {
    if (deaf.contains(route.vehicle)) return;
    RouteState state = RouteState::taken;
    if (route.step == RouteStep::fly) state = RouteState::flies;
    if (route.step == RouteStep::call_off) state = RouteState::called_off;
    status(route.vehicle, state);
  }
  void status(VehicleId id, RouteState state, RouteObstacle why = RouteObstacle::nothing) {
    const Message message{RouteStatus{id, heard[id].instance, routes.given()->plan, state, why}};
    record.push_back(message);
    routes.on_message(message, now);
  }
  std::uint32_t give(double begins_s) {
    const auto plan =
        routes.give({{kOne, north(0.0, begins_s)}, {kTwo, north(300.0, begins_s)}}, {}, fleet, now);
    EXPECT_TRUE(plan.ok()) << (plan ? "" : plan.error().message);
    return plan ? *plan : 0;
  }
  [[nodiscard]] std::size_t told(VehicleId id, RouteStep step) const {
    return static_cast<std::size_t>(std::ranges::count_if(
        said, [&](const Route& r) { return r.vehicle == id && r.step == step; }));
  }
  /// The only plan that was called off.
  [[nodiscard]] std::optional<event::RoutesCalledOff> called_off() const {
    std::optional<event::RoutesCalledOff> found;
    for (const auto& event : events) {
      const auto* off = std::get_if<event::RoutesCalledOff>(&event.body);
      if (off == nullptr) continue;
      EXPECT_FALSE(found) << "it is told once";
      found = *off;
    }
    return found;
  }

  Instant now = at_seconds(100.0);
  Fleet fleet{{.expected = {kOne, kTwo}}};
  GroundRoutes routes;
  std::map<VehicleId, Telemetry> heard;
  std::set<VehicleId> deaf;
  std::vector<Route> said;
  std::vector<Message> record;
  std::vector<MissionEvent> events;
};

TEST_F(GroundRoutesTest, AllTakeTheirsBeforeAnybodyIsToldToFly) {
  deaf = {kTwo};
  const auto plan = give(130.0);
  EXPECT_EQ(plan, 100'001U);
  run_until(110.0);
  EXPECT_EQ(told(kOne, RouteStep::fly), 0U);
  EXPECT_GE(told(kTwo, RouteStep::offer), 8U) << "until it answers";
  EXPECT_EQ(told(kOne, RouteStep::offer), 10U) << "who has answered is told with the others";
  deaf.clear();
  run_until(115.0);
  EXPECT_GE(told(kOne, RouteStep::fly), 1U);
  EXPECT_GE(told(kTwo, RouteStep::fly), 1U);
  EXPECT_EQ(routes.given()->step, RouteStep::fly);
  for (const VehicleId id : {kOne, kTwo}) {
    EXPECT_EQ(routes.given()->routes.at(id).answer, RouteState::flies);
  }
  EXPECT_FALSE(called_off());
  run_until(185.0);
  status(kOne, RouteState::flown);
  status(kTwo, RouteState::flown);
  run_until(186.0);
  EXPECT_TRUE(routes.given()->over);
  EXPECT_GT(give(300.0), plan);
}

TEST_F(GroundRoutesTest, OneThatRefusesCallsThePlanOffForAll) {
  deaf = {kTwo};
  give(130.0);
  run_until(102.0);
  status(kTwo, RouteState::refused, RouteObstacle::too_tight);
  run_until(105.0);
  EXPECT_EQ(called_off(), (event::RoutesCalledOff{100'001U, RoutesEnd::route_refused, kTwo,
                                                  RouteObstacle::too_tight}));
  EXPECT_EQ(told(kOne, RouteStep::fly), 0U);
  EXPECT_GE(told(kOne, RouteStep::call_off), 1U);
  EXPECT_TRUE(routes.given()->over) << "all have ended";
}

TEST_F(GroundRoutesTest, GivesUpWhereSomebodyDoesNotAnswerOrHasNotBegunInTime) {
  deaf = {kTwo};
  give(130.0);
  run_until(140.0);
  EXPECT_EQ(called_off(), (event::RoutesCalledOff{100'001U, RoutesEnd::not_answered, kTwo,
                                                  RouteObstacle::nothing}));
  EXPECT_EQ(told(kOne, RouteStep::fly), 0U);
  run_until(210.0);
  EXPECT_TRUE(routes.given()->over);
  events.clear();
  deaf.clear();
  give(240.0);
  run_until(210.25);
  deaf = {kTwo};  // it has taken its route, and hears nothing more
  run_until(230.0);
  EXPECT_EQ(routes.given()->step, RouteStep::fly);
  run_until(250.0);
  ASSERT_TRUE(called_off());
  EXPECT_EQ(called_off()->end, RoutesEnd::not_begun);
  EXPECT_EQ(called_off()->vehicle, kTwo);
  EXPECT_GE(told(kOne, RouteStep::call_off), 1U);
}

TEST_F(GroundRoutesTest, AfterItsBeginOneThatLeavesLeavesAloneAndOneThatStartsAnewIsToldAgain) {
  give(110.0);
  run_until(120.0);
  ASSERT_TRUE(routes.given()->begun);
  status(kTwo, RouteState::left, RouteObstacle::has_task);
  said.clear();
  heard[kOne].instance = {99};
  run_until(122.0);
  EXPECT_GE(told(kOne, RouteStep::fly), 1U);
  EXPECT_EQ(told(kTwo, RouteStep::fly), 0U);
  EXPECT_EQ(routes.given()->routes.at(kOne).instance, InstanceId{99});
  EXPECT_FALSE(called_off());
}

TEST_F(GroundRoutesTest, ANewGroundStationGoesOnWithWhatWasRecorded) {
  give(130.0);
  run_until(105.0);
  GroundRoutes next;
  for (const Message& message : record) {
    const bool own = std::holds_alternative<Route>(message);
    next.recall(message, own ? kGroundStation : kOne, now);
  }
  ASSERT_TRUE(next.given());
  EXPECT_EQ(next.given()->step, RouteStep::fly);
  EXPECT_EQ(next.given()->plan, 100'001U);
  EXPECT_EQ(next.given()->routes.at(kTwo).answer, RouteState::flies);
  EXPECT_FALSE(next.given()->over);
  next.on_timeout(fleet, now);
  EXPECT_TRUE(next.poll_message()) << "it asks how far they are";
}

TEST_F(GroundRoutesTest, TheOperatorCallsThemOff) {
  EXPECT_FALSE(routes.call_off(now).ok());
  give(130.0);
  run_until(105.0);
  EXPECT_TRUE(routes.call_off(now).ok());
  EXPECT_FALSE(routes.call_off(now).ok());
  run_until(107.0);
  ASSERT_TRUE(called_off());
  EXPECT_EQ(called_off()->end, RoutesEnd::by_operator);
  EXPECT_EQ(routes.given()->routes.at(kOne).answer, RouteState::called_off);
}

TEST_F(GroundRoutesTest, RefusesWhatItKnowsToBeWrong) {
  const auto refusal = [this](const GroundRoutes::Routes& asked,
                              const std::vector<Hazard>& hazards = {}) {
    const auto good = routes.check(asked, hazards, fleet, now);
    return good ? std::string{} : good.error().message;
  };
  EXPECT_EQ(refusal({{kOne, north(0.0, 130.0)}}), "");
  EXPECT_THAT(refusal({}), HasSubstr("no routes"));
  EXPECT_THAT(refusal({{kOne, north(0.0, 104.0)}}), HasSubstr("begins too soon"));
  EXPECT_THAT(refusal({{VehicleId{7}, north(0.0, 130.0)}}), HasSubstr("not in the fleet"));
  EXPECT_THAT(refusal({{kOne, north(0.0, 130.0)}}, {{{4}, {0.0, 500.0}, 50.0}}),
              HasSubstr("enters hazard 4"));
  EXPECT_THAT(refusal({{kOne, north(2000.0, 130.0)}}), HasSubstr("cannot be there in time"));
  const GroundRoutes fenced{{{{-400, -400}, {400, -400}, {400, 600}, {-400, 600}}, 120.0}};
  const auto out = fenced.check({{kOne, north(0.0, 130.0)}}, {}, fleet, now);
  ASSERT_FALSE(out.ok());
  EXPECT_THAT(out.error().message,
              HasSubstr("the route of vehicle 1 leads out of the fence at [0, 600]"));
  heard[kOne].range_left_m = 900.0;
  hear(kOne);
  EXPECT_THAT(refusal({{kOne, north(0.0, 130.0)}}), HasSubstr("left of its range"));
  heard[kOne].activity = Activity::holding;
  hear(kOne);
  EXPECT_THAT(refusal({{kOne, north(0.0, 130.0)}}), HasSubstr("holds"));
  heard[kOne].range_left_m = 20'000.0;
  heard[kOne].activity = Activity::searching;
  hear(kOne);
  give(130.0);
  EXPECT_THAT(refusal({{kTwo, north(300.0, 130.0)}}), HasSubstr("withdraw routes"));
}

/// One of a long row, 50 m apart.
Telemetry in_a_row(VehicleId id, Instant now) {
  Telemetry t;
  t.vehicle = id;
  t.instance = {id.value};
  t.state.time = now;
  t.state.x_m = 50.0 * id.value;
  t.range_left_m = 20'000.0;
  return t;
}

TEST(GroundRoutes, AsManyAsThereMayBeAreToldInTurnAndAllFly) {
  GroundRoutes routes;
  std::set<VehicleId> ids;
  for (std::uint16_t id = 1; id <= GroundRoutes::kVehiclesMax + 1; ++id) ids.insert(VehicleId{id});
  Fleet fleet{{.expected = {ids.begin(), ids.end()}}};
  Instant now = at_seconds(100.0);
  GroundRoutes::Routes plan;
  const auto hear_all = [&] {
    for (const VehicleId id : ids) fleet.on_message(Message{in_a_row(id, now)}, now);
  };
  hear_all();
  const TimedPath ahead = north(0.0, 120.0);
  const auto add = [&](VehicleId id) {
    plan[id] = ahead;
    plan[id].path.start.x_m = in_a_row(id, now).state.x_m;
  };
  for (const VehicleId id : ids) add(id);
  const auto refused = routes.give(plan, {}, fleet, now);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().message,
            "the plan is of 1025 vehicles, and 1024 are the most of one; give it in several");
  plan.erase(*ids.rbegin());
  const auto early = routes.give(plan, {}, fleet, now + std::chrono::seconds{14});
  ASSERT_FALSE(early.ok());
  EXPECT_THAT(early.error().message, HasSubstr("begins too soon"));
  ASSERT_TRUE(routes.give(plan, {}, fleet, now).ok());

  std::vector<std::uint16_t> given;
  std::map<VehicleId, std::size_t> offers;
  for (int step = 0; step < 2400; ++step) {
    now += std::chrono::milliseconds{10};
    if (step % 100 == 0) hear_all();
    if (routes.next_timeout() > now) continue;
    routes.on_timeout(fleet, now);
    std::size_t told = 0;
    while (const auto message = routes.poll_message()) {
      const auto& route = std::get<Route>(*message);
      ++told;
      const bool offer = route.step == RouteStep::offer;
      if (offer) ++offers[route.vehicle];
      routes.on_message(Message{RouteStatus{route.vehicle,
                                            {route.vehicle.value},
                                            route.plan,
                                            offer ? RouteState::taken : RouteState::flies,
                                            RouteObstacle::nothing}},
                        now);
    }
    EXPECT_LE(told, 32U) << "at once";
    while (const auto event = routes.poll_event()) {
      if (const auto* e = std::get_if<event::RoutesGiven>(&event->body))
        given.push_back(e->vehicles);
      EXPECT_NE(event->kind(), EventKind::routes_called_off);
    }
  }
  EXPECT_EQ(given, (std::vector<std::uint16_t>{1024, 1024})) << "offered, and taken by all";
  ASSERT_EQ(offers.size(), GroundRoutes::kVehiclesMax);
  for (const auto& [id, times] : offers) {
    EXPECT_LE(times, 4U) << id.value << ": told again only while others have not answered";
  }
  for (const auto& [id, route] : routes.given()->routes) {
    EXPECT_EQ(route.answer, RouteState::flies) << id.value;
  }
  EXPECT_TRUE(routes.given()->begun);
  EXPECT_EQ(routes.dropped(), 0U);
}

TEST_F(GroundRoutesTest, WhereEachFliesForItselfWhoCannotIsLeftOut) {
  deaf = {kTwo};
  ASSERT_TRUE(routes
                  .give({{kOne, north(0.0, 130.0)}, {kTwo, north(300.0, 130.0)}}, {}, fleet, now,
                        RouteBond::each_alone)
                  .ok());
  run_until(140.0);
  EXPECT_FALSE(called_off());
  EXPECT_EQ(routes.given()->routes.at(kOne).answer, RouteState::flies);
  EXPECT_TRUE(routes.given()->routes.at(kTwo).released);
  EXPECT_GE(told(kTwo, RouteStep::call_off), 1U) << "it may hear that it is too late";
  EXPECT_EQ(told(kOne, RouteStep::call_off), 0U);
  status(kOne, RouteState::flown);
  run_until(191.0);
  EXPECT_TRUE(routes.given()->over) << "who is not heard is not waited for";
}

}  // namespace
}  // namespace skein::mission
