// SPDX-License-Identifier: Apache-2.0
// An area searched by vehicles that fly exactly what they are told.
#include "skein/mission/ground_search.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "skein/base/angles.hpp"

namespace skein::mission {
namespace {

using ::testing::HasSubstr;

constexpr VehicleId kOne{1};
constexpr VehicleId kTwo{2};
constexpr VehicleId kThree{3};

VehicleSpec spec(VehicleId id) {
  VehicleSpec spec;
  spec.id = id;
  spec.cruise_speed_mps = 20.0;
  spec.speed_min_mps = 15.0;
  spec.speed_max_mps = 25.0;
  spec.turn_radius_m = 50.0;
  spec.range_m = 50'000.0;
  spec.sensor_radius_m = id == kThree ? 0.0 : 100.0;
  return spec;
}

struct GroundSearchTest : ::testing::Test {
  GroundSearchTest() {
    for (const VehicleId id : {kOne, kTwo, kThree}) {
      Telemetry t;
      t.vehicle = id;
      t.instance = {id.value + 10U};
      t.state.x_m = 400.0 * id.value;
      t.state.y_m = -400.0;
      t.state.groundspeed_mps = 20.0;
      t.state.course_rad = kPi / 2.0;
      t.range_left_m = 80'000.0;
      heard[id] = t;
    }
    hear();
  }
  void hear() {
    for (auto& [id, t] : heard) {
      t.state.time = now;
      fleet.on_message(Message{t}, now);
      search.on_message(Message{t}, now);
    }
  }
  /// Everybody flies its route from its begin on.
  void run(double seconds) {
    for (const Instant end = now + from_seconds(seconds); now < end;) {
      now += std::chrono::milliseconds{500};
      for (auto& [id, timed] : flown) {
        if (now < timed.start_time) continue;
        const Pose2 pose = timed.pose_at(now);
        heard[id].state.x_m = pose.x_m;
        heard[id].state.y_m = pose.y_m;
        heard[id].state.course_rad = pose.heading_rad;
        if (now >= timed.end_time() && !done.contains(id)) {
          done.insert(id);
          status(id, RouteState::flown);
        }
      }
      hear();
      routes.on_timeout(fleet, now);
      search.on_timeout(hazards, fleet, routes, now);
      while (const auto message = routes.poll_message()) answer(std::get<Route>(*message));
      while (routes.poll_event()) continue;
    }
  }
  void answer(const Route& route) {
    if (deaf.contains(route.vehicle)) return;
    if (held.contains(route.vehicle)) {
      flown.erase(route.vehicle);
      return status(route.vehicle, RouteState::refused, RouteObstacle::obeys_others);
    }
    if (route.step == RouteStep::offer) {
      done.erase(route.vehicle);
      flown.erase(route.vehicle);  // it circles where that has ended
      ++offers[route.vehicle][route.plan];
      status(route.vehicle, RouteState::taken);
    } else if (route.step == RouteStep::fly) {
      if (done.contains(route.vehicle)) return;
      flown[route.vehicle] = route.timed;
      status(route.vehicle, RouteState::flies);
    } else {
      flown.erase(route.vehicle);
      status(route.vehicle, RouteState::called_off);
    }
  }
  void status(VehicleId id, RouteState state, RouteObstacle why = RouteObstacle::nothing) {
    routes.on_message(
        Message{RouteStatus{id, heard[id].instance, routes.given()->plan, state, why}}, now);
  }
  /// By order; who has begun leaves its route.
  void hold(VehicleId id) {
    held.insert(id);
    flown.erase(id);
    heard[id].activity = Activity::holding;
    status(id, RouteState::left, RouteObstacle::obeys_others);
  }
  Result<AreaSearch> give(std::vector<Vec2> corners) {
    return search.give({std::move(corners), {}, {}, {}}, hazards, fleet, routes, now);
  }
  [[nodiscard]] const AreaSearch& area() const { return *search.area(); }

  Instant now = at_seconds(10.0);
  Fleet fleet{{.expected = {kOne, kTwo, kThree}}};
  GroundRoutes routes;
  GroundSearch search{{.vehicles = {spec(kOne), spec(kTwo), spec(kThree)}}};
  std::vector<Hazard> hazards;
  std::map<VehicleId, Telemetry> heard;
  std::map<VehicleId, TimedPath> flown;
  std::map<VehicleId, std::map<std::uint32_t, int>> offers;
  std::set<VehicleId> done;
  std::set<VehicleId> deaf;
  std::set<VehicleId> held;
};

const std::vector<Vec2> kSmall{{0.0, 0.0}, {1200.0, 0.0}, {1200.0, 1000.0}, {0.0, 1000.0}};
const std::vector<Vec2> kLarge{{0.0, 0.0}, {4500.0, 0.0}, {4500.0, 4500.0}, {0.0, 4500.0}};

TEST_F(GroundSearchTest, AnAreaIsSharedOutFlownAndSeen) {
  const auto preview = search.preview({kSmall, {}, {}, {}}, hazards, fleet, routes, now);
  ASSERT_TRUE(preview.ok()) << preview.error().message;
  EXPECT_FALSE(search.area());
  EXPECT_EQ(preview->shares.size(), 2U);
  EXPECT_THAT(preview->without.at(kThree), HasSubstr("no sensor"));
  EXPECT_EQ(preview->planned, 1.0);
  EXPECT_EQ(preview->parts, 1U);
  const auto given = give(kSmall);
  ASSERT_TRUE(given.ok()) << given.error().message;
  const double takes_s = to_seconds(given->ends - now);
  run(0.4 * takes_s);
  EXPECT_EQ(area().state, AreaSearch::State::flown);
  EXPECT_GT(search.seen(), 0.1);
  EXPECT_LT(search.seen(), 0.9);
  run(0.6 * takes_s + 30.0);
  EXPECT_EQ(area().state, AreaSearch::State::over);
  EXPECT_GT(search.seen(), 0.999);
  EXPECT_FALSE(search.leaves_rest());
  for (const auto& [id, share] : area().shares) EXPECT_EQ(share.state, SearchShare::State::done);
}

TEST_F(GroundSearchTest, WhatIsTooLongForOneRouteIsGivenInSeveralOneAfterAnother) {
  const auto given = give(kLarge);
  ASSERT_TRUE(given.ok()) << given.error().message;
  EXPECT_GE(given->parts, 2U);
  const double takes_s = to_seconds(given->ends - now);
  run(1.15 * takes_s + 60.0);
  EXPECT_EQ(area().state, AreaSearch::State::over) << area().why;
  EXPECT_GT(search.seen(), 0.999);
  for (const auto& [id, share] : area().shares) {
    EXPECT_EQ(share.state, SearchShare::State::done) << share.why;
  }
  EXPECT_GE(offers[kOne].size(), 2U);
  EXPECT_GE(offers[kTwo].size(), 2U);
}

TEST_F(GroundSearchTest, WhoFindsASiteIsReleasedAndTheRestCanBeSharedOut) {
  ASSERT_TRUE(give(kSmall).ok());
  run(90.0);
  MissionEvent event;
  event.vehicle = kOne;
  event.body = event::SiteDetected{50.0};
  search.on_message(Message{event}, now);
  run(5.0);
  EXPECT_EQ(area().shares.at(kOne).state, SearchShare::State::left);
  EXPECT_THAT(area().shares.at(kOne).why, HasSubstr("site"));
  EXPECT_FALSE(flown.contains(kOne)) << "it was told";
  EXPECT_TRUE(flown.contains(kTwo)) << "the other flies on";
  EXPECT_EQ(routes.given()->step, RouteStep::fly);
  EXPECT_FALSE(give({}).ok()) << "the other still flies";
  run(400.0);
  EXPECT_EQ(area().state, AreaSearch::State::over);
  EXPECT_TRUE(search.leaves_rest());
  const double before = search.seen();
  EXPECT_LT(before, 0.95);
  heard[kOne].activity = Activity::leading;
  hear();
  const auto rest = give({});
  ASSERT_TRUE(rest.ok()) << rest.error().message;
  EXPECT_EQ(rest->shares.size(), 1U) << "the other leads at its site";
  run(to_seconds(rest->ends - now) + 30.0);
  EXPECT_EQ(area().state, AreaSearch::State::over);
  EXPECT_GT(search.seen(), 0.995);
  const auto none = give({});
  ASSERT_FALSE(none.ok());
  EXPECT_THAT(none.error().message, HasSubstr("nothing of the area is left"));
}

TEST_F(GroundSearchTest, TheOperatorCallsItOff) {
  ASSERT_TRUE(give(kSmall).ok());
  run(60.0);
  ASSERT_TRUE(routes.call_off(now).ok());
  run(5.0);
  EXPECT_EQ(area().state, AreaSearch::State::called_off);
  EXPECT_TRUE(area().by_operator);
  EXPECT_TRUE(search.leaves_rest());
  EXPECT_TRUE(flown.empty());
}

TEST_F(GroundSearchTest, WhoIsHeldBeforeItBeginsLeavesItAlone) {
  ASSERT_TRUE(give(kSmall).ok());
  run(3.0);
  ASSERT_FALSE(routes.given()->begun);
  hold(kOne);
  run(60.0);
  EXPECT_EQ(area().state, AreaSearch::State::flown) << area().why;
  EXPECT_EQ(area().shares.at(kOne).state, SearchShare::State::left);
  EXPECT_THAT(area().shares.at(kOne).why, HasSubstr("it holds"));
  EXPECT_TRUE(flown.contains(kTwo));
  EXPECT_EQ(search.searching(), std::vector<VehicleId>{kTwo});
  run(400.0);
  EXPECT_EQ(area().state, AreaSearch::State::over);
  EXPECT_EQ(area().shares.at(kTwo).state, SearchShare::State::done);
  EXPECT_TRUE(search.leaves_rest());
}

TEST_F(GroundSearchTest, WhoDoesNotAnswerLeavesItAloneAndNobodyIsWaitedForForever) {
  deaf = {kTwo};
  ASSERT_TRUE(give(kSmall).ok());
  run(60.0);
  EXPECT_EQ(area().shares.at(kTwo).state, SearchShare::State::left);
  EXPECT_THAT(area().shares.at(kTwo).why, HasSubstr("not answered"));
  EXPECT_TRUE(flown.contains(kOne));
  run(400.0);
  EXPECT_EQ(area().state, AreaSearch::State::over);
}

TEST_F(GroundSearchTest, WhereNobodyFliesItIsCalledOffAndSaysWhyOfEach) {
  held = {kOne, kTwo};
  ASSERT_TRUE(give(kSmall).ok());
  run(5.0);
  EXPECT_EQ(area().state, AreaSearch::State::called_off);
  EXPECT_FALSE(area().by_operator);
  EXPECT_THAT(area().why, HasSubstr("vehicle 1: it holds"));
  EXPECT_THAT(area().why, HasSubstr("vehicle 2: it holds"));
}

TEST_F(GroundSearchTest, WhoHoldsBetweenTwoRoutesKeepsNobodyFromTheNext) {
  const auto given = give(kLarge);
  ASSERT_TRUE(given.ok()) << given.error().message;
  run(3.0);
  run(to_seconds(area().shares.at(kOne).route.end_time() - now) - 10.0);
  hold(kOne);
  const auto first = routes.given()->plan;
  run(to_seconds(given->ends - given->begins));
  EXPECT_NE(routes.given()->plan, first);
  EXPECT_EQ(area().state, AreaSearch::State::over) << area().why;
  EXPECT_EQ(area().shares.at(kTwo).state, SearchShare::State::done);
  EXPECT_THAT(area().shares.at(kOne).why, HasSubstr("it holds"));
  EXPECT_GE(offers[kTwo].size(), 2U);
}

TEST_F(GroundSearchTest, TellsHowFarEachIsAndWhenItIsDone) {
  const auto given = give(kSmall);
  ASSERT_TRUE(given.ok()) << given.error().message;
  const SearchShare& share = area().shares.at(kOne);
  const auto whole = progress_of(area(), share, now);
  EXPECT_EQ(whole.lanes_left, share.all);
  EXPECT_EQ(whole.ends, share.route.end_time());
  double lanes_m = 0.0;
  for (const auto& lane : share.lanes) lanes_m += lane.length_m;
  EXPECT_NEAR(whole.left_m, lanes_m, 1e-6);
  run(to_seconds(given->begins - now));
  run(0.5 * to_seconds(share.route.end_time() - now));
  const auto half = progress_of(area(), share, now);
  EXPECT_LT(half.left_m, 0.75 * lanes_m);
  EXPECT_GT(half.left_m, 0.25 * lanes_m);
  EXPECT_LE(half.lanes_left, whole.lanes_left);
  EXPECT_EQ(*expected_end(area(), now),
            std::max(share.route.end_time(), area().shares.at(kTwo).route.end_time()));
  hold(kOne);
  run(20.0);
  const auto left = progress_of(area(), share, now);
  EXPECT_FALSE(left.ends);
  EXPECT_NEAR(left.left_m, half.left_m, 20.0) << "what it has not flown stays so";
  run(400.0);
  EXPECT_EQ(progress_of(area(), area().shares.at(kTwo), now).lanes_left, 0U);
  EXPECT_FALSE(expected_end(area(), now));
}

TEST_F(GroundSearchTest, KnowsWhomAHazardWouldBar) {
  ASSERT_TRUE(give(kSmall).ok());
  const Vec2 on_its_way = area()
                              .shares.at(kOne)
                              .route.pose_at_distance(area().shares.at(kOne).route.path.length_m())
                              .position();
  EXPECT_EQ(search.barred_by({{HazardId{9}, on_its_way, 20.0}}, now), std::vector<VehicleId>{kOne});
  EXPECT_TRUE(search.barred_by({{HazardId{9}, {9000.0, 9000.0}, 20.0}}, now).empty());
  run(to_seconds(area().ends - now) + 30.0);
  EXPECT_TRUE(search.barred_by({{HazardId{9}, on_its_way, 20.0}}, now).empty());
}

TEST_F(GroundSearchTest, SaysWhyNot) {
  EXPECT_THAT(give({{0.0, 0.0}, {1.0, 1.0}}).error().message, HasSubstr("corners"));
  EXPECT_THAT(give({}).error().message, HasSubstr("no area was searched yet"));
  const auto by = [&](VehicleId id) {
    return search.preview({kSmall, {id}, {}, {}}, hazards, fleet, routes, now);
  };
  EXPECT_THAT(by(kThree).error().message, HasSubstr("vehicle 3: it has no sensor"));
  EXPECT_THAT(by({9}).error().message, HasSubstr("not in the fleet"));
  heard[kOne].activity = Activity::holding;
  hear();
  EXPECT_THAT(by(kOne).error().message, HasSubstr("it holds"));
  const auto without = search.preview({kSmall, {}, {}, {}}, hazards, fleet, routes, now);
  ASSERT_TRUE(without.ok());
  EXPECT_EQ(without->shares.size(), 1U);
  EXPECT_THAT(search.preview({kSmall, {}, 500.0, {}}, hazards, fleet, routes, now).error().message,
              HasSubstr("200 m"));
  for (auto& [id, t] : heard) t.range_left_m = 1500.0;
  hear();
  EXPECT_FALSE(give(kSmall).ok());
}

}  // namespace
}  // namespace skein::mission
