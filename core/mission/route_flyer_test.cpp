// SPDX-License-Identifier: Apache-2.0
#include "route_flyer.hpp"

#include <gtest/gtest.h>

#include "agent_parts_test.hpp"

namespace skein::mission {
namespace {

/// East for 1.5 km with a bend, from 1.5 km east and 300 m north.
TimedPath route(double begins_s) {
  TimedPath timed;
  timed.start_time = at_seconds(begins_s);
  timed.speed_mps = kTestSpeed_mps;
  timed.path.start = {1500.0, 300.0, 0.0};
  EXPECT_TRUE(timed.path.append(Segment{0.0, 700.0}));
  EXPECT_TRUE(timed.path.append(Segment{1.0 / 70.0, 70.0}));
  EXPECT_TRUE(timed.path.append(Segment{0.0, 730.0}));
  return timed;
}

struct RouteFlyerTest : ::testing::Test {
  explicit RouteFlyerTest(const VehicleAgentConfig& config = plane_config()) : bench{config} {}
  void hear(RouteStep step, const TimedPath& timed, std::uint32_t plan = 1) {
    flyer.on_route({{4}, plan, step, timed}, standing, bench.now);
    answer = bench.sent<RouteStatus>();
  }
  void fly_until(double seconds) {
    while (bench.now < at_seconds(seconds)) {
      bench.be_at(to_seconds(bench.now) + 0.25);
      flyer.step(standing, bench.now);
      if (const auto said = bench.sent<RouteStatus>()) answer = said;
    }
  }
  [[nodiscard]] Vec2 at() const { return {bench.ownship.state().x_m, bench.ownship.state().y_m}; }
  [[nodiscard]] RouteObstacle refusal(const TimedPath& timed) {
    hear(RouteStep::offer, timed, ++newest);
    EXPECT_EQ(answer.value().state == RouteState::refused,
              answer.value().why != RouteObstacle::nothing);
    return answer.value().why;
  }

  PartsBench bench;
  RouteStanding standing;
  RouteFlyer flyer{bench.ownship, bench.outbox};
  std::optional<RouteStatus> answer;
  std::uint32_t newest = 10;
};

TEST_F(RouteFlyerTest, IsOnItsRouteInTimeAndFliesItToItsEnd) {
  bench.be_at(10.0);
  hear(RouteStep::offer, route(120.0));
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->state, RouteState::taken);
  EXPECT_EQ(answer->instance, InstanceId{9});
  const auto number = bench.ownship.flight().plan().number;
  fly_until(12.0);
  EXPECT_EQ(bench.ownship.flight().plan().number, number) << "nobody flies before all have taken";
  hear(RouteStep::fly, route(120.0));
  EXPECT_EQ(answer.value().state, RouteState::flies);
  hear(RouteStep::fly, route(120.0));
  EXPECT_EQ(answer.value().state, RouteState::flies) << "asked again, it answers again";
  EXPECT_EQ(bench.ownship.flight().plan().number, number + 1);
  EXPECT_EQ(bench.reported(EventKind::route_answered), 2);
  fly_until(120.0);
  EXPECT_LT((at() - Vec2{1500.0, 300.0}).norm(), 0.1);
  EXPECT_TRUE(bench.ownship.flight().en_route(bench.now));
  const TimedPath flown = route(120.0);
  fly_until(150.0);
  EXPECT_LT((at() - flown.pose_at(at_seconds(150.0)).position()).norm(), 0.1);
  fly_until(179.0);
  EXPECT_LT((at() - flown.pose_at(at_seconds(179.0)).position()).norm(), 0.1);
  fly_until(200.0);
  EXPECT_EQ(answer.value().state, RouteState::flown);
}

TEST_F(RouteFlyerTest, RefusesByItsOwnConfigurationWhateverWasPlanned) {
  bench.be_at(10.0);
  EXPECT_EQ(refusal(route(120.0)), RouteObstacle::nothing);
  TimedPath timed = route(120.0);
  timed.path.segments[1].curvature_per_m = 1.0 / 60.0;  // paths are planned at 66 m
  EXPECT_EQ(refusal(timed), RouteObstacle::too_tight);
  timed = route(120.0);
  timed.speed_mps = 31.0;
  EXPECT_EQ(refusal(timed), RouteObstacle::wrong_speed);
  timed = route(120.0);
  timed.path.segments.clear();
  EXPECT_EQ(refusal(timed), RouteObstacle::no_route);
  timed = route(120.0);
  timed.path.segments[2].length_m = 60'000.0;
  EXPECT_EQ(refusal(timed), RouteObstacle::out_of_range);
  EXPECT_EQ(refusal(route(30.0)), RouteObstacle::out_of_reach) << "1.5 km in 20 s";
  EXPECT_EQ(refusal(route(5.0)), RouteObstacle::out_of_reach) << "it began without it, elsewhere";
  bench.ownship.on_hazard({{{3}, {2000.0, 300.0}, 20.0}, false});
  EXPECT_EQ(refusal(route(120.0)), RouteObstacle::into_hazard);
  bench.ownship.on_hazard({{{3}, {2000.0, 300.0}, 20.0}, true});
  standing.has_task = true;
  EXPECT_EQ(refusal(route(120.0)), RouteObstacle::has_task);
  standing.obeys_others = true;
  EXPECT_EQ(refusal(route(120.0)), RouteObstacle::obeys_others);
  standing.setup_differs = true;
  EXPECT_EQ(refusal(route(120.0)), RouteObstacle::setup_differs);
  standing.orders_unknown = true;
  hear(RouteStep::offer, route(120.0), 50);
  EXPECT_FALSE(answer) << "it is told again";
}

struct FencedRouteFlyerTest : RouteFlyerTest {
  static VehicleAgentConfig fenced() {
    VehicleAgentConfig config = plane_config();
    config.fence = {{{-3000, -3000}, {3200, -3000}, {3200, 3000}, {-3000, 3000}}, 150.0};
    return config;
  }
  FencedRouteFlyerTest() : RouteFlyerTest{fenced()} {}
};

TEST_F(FencedRouteFlyerTest, RefusesWhatLeadsOutOfItsFence) {
  bench.be_at(10.0);
  EXPECT_EQ(refusal(route(120.0)), RouteObstacle::nothing);
  TimedPath timed = route(120.0);
  timed.path.segments[2].length_m = 2000.0;
  EXPECT_EQ(refusal(timed), RouteObstacle::into_hazard);
}

TEST_F(RouteFlyerTest, GivesUpWhatItIsNotToldToFly) {
  hear(RouteStep::offer, route(120.0));
  ASSERT_EQ(answer.value().state, RouteState::taken);
  fly_until(121.0);
  EXPECT_EQ(answer.value().state, RouteState::refused);
  EXPECT_EQ(answer.value().why, RouteObstacle::not_told);
  hear(RouteStep::fly, route(120.0));
  EXPECT_EQ(answer.value().state, RouteState::refused);
}

TEST_F(RouteFlyerTest, ACallEndsItAndWhatComesFirstLeavesIt) {
  hear(RouteStep::offer, route(120.0));
  hear(RouteStep::fly, route(120.0));
  hear(RouteStep::call_off, route(120.0));
  EXPECT_EQ(answer.value().state, RouteState::called_off);
  EXPECT_FALSE(bench.ownship.flight().en_route(bench.now));
  EXPECT_TRUE(bench.ownship.flight().searching());
  hear(RouteStep::fly, route(120.0));
  EXPECT_EQ(answer.value().state, RouteState::called_off) << "an old word";

  hear(RouteStep::offer, route(120.0), 2);
  hear(RouteStep::fly, route(120.0), 2);
  ASSERT_EQ(answer.value().state, RouteState::flies);
  bench.ownship.hold(bench.now);
  standing.obeys_others = true;
  flyer.step(standing, bench.now);
  answer = bench.sent<RouteStatus>();
  EXPECT_EQ(answer.value().state, RouteState::left);
  EXPECT_EQ(answer.value().why, RouteObstacle::obeys_others);
}

/// One whose program starts anew is told to fly at once.
TEST(RouteFlyer, WhoStartsAnewGoesOnWhereItIsNearAndElseSaysThatItDoesNot) {
  for (const double off_m : {90.0, 900.0}) {
    const VehicleAgentConfig config = plane_config();
    Ownship ownship{config};
    Outbox outbox{config.vehicle.id};
    RouteFlyer flyer{ownship, outbox};
    const TimedPath timed = route(0.0);
    VehicleState state;
    state.time = at_seconds(20.0);
    const Vec2 there = timed.pose_at(state.time).position();
    state.x_m = there.x();
    state.y_m = there.y() + off_m;
    ownship.on_state(state, state.time);
    flyer.on_route({{4}, 1, RouteStep::fly, timed}, {}, state.time);
    std::optional<RouteStatus> answer;
    while (auto message = outbox.messages.pop()) {
      if (const auto* status = std::get_if<RouteStatus>(&*message)) answer = *status;
    }
    ASSERT_TRUE(answer);
    if (off_m < 250.0) {
      EXPECT_EQ(answer->state, RouteState::flies);
      const Instant later = at_seconds(50.0);
      const Vec2 off = ownship.flight().pose_at(later).position() - timed.pose_at(later).position();
      EXPECT_LT(off.norm(), 0.1) << "on it again, and on time";
    } else {
      EXPECT_EQ(answer->state, RouteState::left);
      EXPECT_EQ(answer->why, RouteObstacle::out_of_reach);
    }
  }
}

TEST(RouteFlyer, ToldBeforeItFliesItBeginsWithItsRoute) {
  const VehicleAgentConfig config = plane_config();
  Ownship ownship{config};
  Outbox outbox{config.vehicle.id};
  RouteFlyer flyer{ownship, outbox};
  flyer.on_route({{4}, 1, RouteStep::offer, route(0.0)}, {}, at_seconds(-20.0));
  flyer.on_route({{4}, 1, RouteStep::fly, route(0.0)}, {}, at_seconds(-19.0));
  EXPECT_TRUE(flyer.flies());
  VehicleState state;
  state.x_m = 1500.0;
  state.y_m = 300.0;
  ownship.on_state(state, Instant{});
  flyer.step({}, Instant{});
  EXPECT_TRUE(flyer.flies());
  EXPECT_TRUE(ownship.flight().en_route(Instant{}));
  EXPECT_EQ(ownship.flight().plan().timed.path.start.position(), (Vec2{1500.0, 300.0}));
}

}  // namespace
}  // namespace skein::mission
