// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/ground_return.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "agent_parts_test.hpp"
#include "return_way.hpp"
#include "skein/base/random.hpp"
#include "skein/mission/ground_node.hpp"
#include "skein/mission/vehicle_node.hpp"

namespace skein::mission {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

constexpr Duration kTick = 100ms;
constexpr double kApart_m = 30.0;

/// Exactly where its newest plan has it.
struct Plane {
  Plane(std::uint16_t number, double height_m)
      : id{number}, start{0.0, 20.0 * number, 0.0}, node{config(number, height_m), Instant{-1s}} {
    state.z_m = height_m;
  }
  static VehicleNodeConfig config(std::uint16_t number, double height_m) {
    VehicleAgentConfig agent = plane_config();
    agent.vehicle.id = {number};
    agent.vehicle.height_m = height_m;
    agent.vehicle.capabilities = {};
    agent.instance = {number};
    agent.search = {{1500.0 + 250.0 * (number % 3), 600.0 * number - 2000.0}};
    return {.agent = agent, .program = "test", .flight_controller = "none"};
  }
  void step(Instant now) {
    const Pose2 pose = plans.empty() ? start : plans.back().timed.pose_at(now);
    state.time = now;
    state.x_m = pose.x_m;
    state.y_m = pose.y_m;
    state.heading_rad = state.course_rad = pose.heading_rad;
    state.groundspeed_mps = state.airspeed_mps = kTestSpeed_mps;
    state.distance_flown_m = std::max(0.0, to_seconds(now)) * kTestSpeed_mps;
    node.on_state(state, now);
  }
  [[nodiscard]] const TimedPath& flies() const { return plans.back().timed; }

  VehicleId id;
  Pose2 start;
  VehicleState state;
  VehicleNode node;
  std::vector<FlightPlan> plans;
};

/// Planes and a ground station; what is said comes to whom it concerns at the next tick, or is
/// lost.
struct Field {
  explicit Field(std::uint16_t count, double step_m, double loss_share = 0.0,
                 std::uint64_t seed = 1)
      : loss{loss_share}, random{seed} {
    for (std::uint16_t n = 1; n <= count; ++n) {
      planes.emplace_back(n, 100.0 + step_m * n);
    }
    GroundNodeConfig config;
    for (const Plane& plane : planes) config.agent.expected.push_back(plane.id);
    ground.emplace(config, Instant{-1s});
  }

  void fly_until(Instant until) {
    for (; now < until; now += kTick) tick();
  }
  void order(CommandKind kind, VehicleId who = kGroundStation) {
    const auto given = ground->command(who, kind, now);
    EXPECT_TRUE(given.ok()) << (given ? "" : given.error().message);
  }
  /// From the moment of the order on, of any two at one height.
  [[nodiscard]] double least_m() const { return least_m_; }
  [[nodiscard]] std::size_t planned() const {
    return static_cast<std::size_t>(std::ranges::count_if(
        events, [](const MissionEvent& e) { return e.kind() == EventKind::return_planned; }));
  }
  [[nodiscard]] std::vector<event::ReturnAlone> alone() const {
    std::vector<event::ReturnAlone> all;
    for (const MissionEvent& e : events) {
      if (const auto* body = std::get_if<event::ReturnAlone>(&e.body)) all.push_back(*body);
    }
    return all;
  }
  [[nodiscard]] bool all_home() const {
    return std::ranges::all_of(planes, [&](const Plane& p) { return p.flies().end_time() <= now; });
  }
  /// Of those, in order.
  [[nodiscard]] std::vector<double> arrivals_s() const {
    std::vector<double> all;
    for (const Plane& p : planes) all.push_back(to_seconds(p.flies().end_time()));
    std::ranges::sort(all);
    return all;
  }

  double loss;
  Random random;
  Instant now{-1s};
  std::optional<GroundNode> ground;
  std::vector<Plane> planes;
  std::vector<MissionEvent> events;
  std::set<VehicleId> deaf;  ///< to ways home
  std::set<VehicleId> far;   ///< neither heard nor hears
  std::size_t told = 0;      ///< ways home
  bool judged = false;

 private:
  void tick() {
    for (const auto& [message, sender] : std::exchange(air_, {})) pass(message, sender);
    for (Plane& plane : planes) {
      plane.step(now);
      while (auto message = plane.node.poll_message()) air_.emplace_back(*message, plane.id);
      while (plane.node.poll_event()) continue;
      while (auto plan = plane.node.poll_guidance()) {
        plane.plans.push_back(std::get<FlightPlan>(*plan));
      }
    }
    ground->on_timeout(now);
    while (auto message = ground->poll_message()) air_.emplace_back(*message, kGroundStation);
    while (auto event = ground->poll_event()) events.push_back(*event);
    if (judged) judge();
  }
  void pass(const Message& message, VehicleId sender) {
    const bool way = std::holds_alternative<ReturnFlight>(message);
    told += way ? 1 : 0;
    if (far.contains(sender)) return;
    if (sender != kGroundStation) {
      if (!random.chance(loss)) ground->on_message(message, sender, now);
      return;
    }
    for (Plane& plane : planes) {
      const bool hears = !far.contains(plane.id) && !(way && deaf.contains(plane.id));
      if (hears && !random.chance(loss)) plane.node.on_message(message, sender, now);
    }
  }
  void judge() {
    for (std::size_t i = 0; i < planes.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const VehicleState& a = planes[i].state;
        const VehicleState& b = planes[j].state;
        if (std::abs(a.z_m - b.z_m) >= 4.0) continue;
        const Vec2 apart = a.pose().position() - b.pose().position();
        least_m_ = std::min(least_m_, apart.norm());
      }
    }
  }

  double least_m_ = std::numeric_limits<double>::infinity();
  std::vector<std::pair<Message, VehicleId>> air_;
};

/// Ordered home after a minute.
Field recalled(Field field) {
  field.fly_until(at_seconds(70.0));
  field.order(CommandKind::return_home);
  field.judged = true;
  return field;
}

TEST(GroundReturn, PlanesOfOneHeightComeHomeApartAndOneAfterAnother) {
  Field field = recalled(Field{8, 0.0});
  field.fly_until(at_seconds(500.0));
  EXPECT_EQ(field.planned(), 1U);
  EXPECT_TRUE(field.alone().empty());
  EXPECT_TRUE(field.all_home());
  EXPECT_GE(field.least_m(), kApart_m);
  const auto arrivals = field.arrivals_s();
  for (std::size_t i = 1; i < arrivals.size(); ++i) {
    EXPECT_GE(arrivals[i] - arrivals[i - 1], 15.0 - 1e-6);
  }
}

/// What the others show is not by chance.
TEST(GroundReturn, WithoutItPlanesOfOneHeightMeet) {
  Field field{8, 0.0};
  for (const Plane& plane : field.planes) field.deaf.insert(plane.id);
  field = recalled(std::move(field));
  field.fly_until(at_seconds(500.0));
  EXPECT_LT(field.least_m(), kApart_m);
  EXPECT_EQ(field.alone().size(), 8U) << "and the operator is told";
  EXPECT_THAT(field.alone().front().detail, HasSubstr("has not taken up"));
  EXPECT_TRUE(field.all_home()) << "each on its own way";
}

TEST(GroundReturn, ThirtyPercentOfLossKeepNobodyFromIt) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Field field = recalled(Field{8, 0.0, 0.3, seed});
    field.fly_until(at_seconds(600.0));
    for (const auto& e : field.alone())
      ADD_FAILURE() << seed << ": " << e.vehicle.value << ' ' << e.detail;
    EXPECT_TRUE(field.all_home()) << seed;
    EXPECT_GE(field.least_m(), kApart_m) << seed;
  }
}

TEST(GroundReturn, AtHeightsOfTheirOwnTheyHoldAtHome) {
  Field field = recalled(Field{8, 5.0});
  field.fly_until(at_seconds(500.0));
  EXPECT_TRUE(field.alone().empty());
  for (const Plane& plane : field.planes) {
    const Vec2 off = plane.flies().path.end().position() - plane.start.position();
    EXPECT_LT(off.norm(), 1.0);
  }
}

TEST(GroundReturn, WhoHearsNoWayIsPlannedAroundAndComesHomeByItself) {
  Field field{4, 5.0};
  field.deaf = {VehicleId{2}};
  field = recalled(std::move(field));
  field.fly_until(at_seconds(500.0));
  EXPECT_TRUE(field.all_home());
  ASSERT_EQ(field.alone().size(), 1U);
  EXPECT_EQ(field.alone()[0].vehicle, VehicleId{2});
  EXPECT_EQ(field.planned(), 4U) << "it is looked at again, and alone: the others fly theirs";
}

TEST(GroundReturn, WhoIsBackInReachIsPlannedAroundTheOthers) {
  Field field{6, 0.0};
  field = recalled(std::move(field));
  field.far = {VehicleId{3}};
  field.fly_until(at_seconds(72.0));
  field.far.clear();  // the order is said again
  field.fly_until(at_seconds(600.0));
  EXPECT_TRUE(field.alone().empty());
  EXPECT_GE(field.least_m(), kApart_m);
}

/// It flies on, for all that is known.
TEST(GroundReturn, WhoFallsSilentOnItsWayIsPlannedAround) {
  for (std::uint16_t silent = 2; silent <= 8; ++silent) {
    Field field{8, 0.0};
    field = recalled(std::move(field));
    field.judged = false;
    field.far = {VehicleId{1}};
    field.fly_until(at_seconds(85.0));
    field.far.insert(VehicleId{silent});
    field.fly_until(at_seconds(95.0));
    field.far = {VehicleId{silent}};  // the order is said again
    const auto rounds = field.planned();
    while (field.planned() == rounds && field.now < at_seconds(120.0)) {
      field.fly_until(field.now + kTick);
    }
    field.fly_until(field.now + 8s);
    field.judged = true;
    field.fly_until(at_seconds(600.0));
    EXPECT_TRUE(field.alone().empty()) << silent;
    EXPECT_GE(field.least_m(), kApart_m) << silent;
  }
}

TEST(GroundReturn, AnotherOrderEndsIt) {
  Field field = recalled(Field{4, 0.0});
  field.fly_until(at_seconds(70.5));
  field.order(CommandKind::resume);
  field.fly_until(at_seconds(120.0));
  EXPECT_EQ(field.told, 0U);
  EXPECT_EQ(field.planned(), 0U);
}

TEST(GroundReturn, OfOneVehicleToo) {
  Field field{3, 5.0};
  field.fly_until(at_seconds(60.0));
  field.order(CommandKind::return_home, VehicleId{2});
  field.fly_until(at_seconds(80.0));
  EXPECT_EQ(field.planned(), 1U);
  EXPECT_GE(field.told, 1U);
  EXPECT_TRUE(field.alone().empty());
}

// --- on board ---

struct OnTheWay : ::testing::Test {
  OnTheWay() : flight{plane_config().vehicle, {}, {{2000.0, 0.0}}} {
    flight.start({0.0, 0.0, 0.0}, {}, 40'000.0, at_seconds(0.0));
    flight.fly_home({}, at_seconds(30.0));
    way.start_time = at_seconds(40.0);
    way.speed_mps = kTestSpeed_mps;
    way.path.start = flight.pose_at(way.start_time);
    EXPECT_TRUE(way.path.append(Segment{0.0, 600.0}));
    way.tail_curvature_per_m = 1.0 / 80.0;
  }
  [[nodiscard]] bool taken(double range_m = 10'000.0, double now_s = 32.0) const {
    return is_way_home(way, plane_config().vehicle, flight, hazards, range_m, at_seconds(now_s));
  }
  Flight flight;
  TimedPath way;
  std::vector<Hazard> hazards;
};

TEST_F(OnTheWay, AWayThatFitsIsTaken) {
  ASSERT_TRUE(taken());
  ASSERT_TRUE(flight.return_along(way, at_seconds(32.0)));
  EXPECT_TRUE(flight.homing());
  for (const double t : {40.0, 50.0, 80.0}) {
    const Vec2 off =
        flight.pose_at(at_seconds(t)).position() - way.pose_at(at_seconds(t)).position();
    EXPECT_LT(off.norm(), 1e-6) << t;
  }
}

/// Its times are those of the wind that it was planned with, whatever the vehicle has seen since.
TEST_F(OnTheWay, AWayInWindIsFlownAsItWasPlanned) {
  way.set_wind({3.0, -4.0});
  flight.set_wind({5.0, 1.0});
  ASSERT_TRUE(taken());
  ASSERT_TRUE(flight.return_along(way, at_seconds(32.0)));
  EXPECT_TRUE(flight.homing());
  for (const double t : {40.0, 50.0, 80.0, 200.0}) {
    const Vec2 off =
        flight.pose_at(at_seconds(t)).position() - way.pose_at(at_seconds(t)).position();
    EXPECT_LT(off.norm(), 1e-3) << t;
  }
}

TEST_F(OnTheWay, WhatDoesNotFitIsNot) {
  EXPECT_FALSE(taken(500.0)) << "range";
  EXPECT_FALSE(taken(10'000.0, 40.0)) << "too late";
  const TimedPath good = way;
  way.path.start.x_m += 3.0;
  EXPECT_FALSE(taken()) << "begins elsewhere";
  way = good;
  way.tail_curvature_per_m = 1.0 / 50.0;
  EXPECT_FALSE(taken()) << "too tight an orbit";
  way.tail_curvature_per_m = 0.0;
  EXPECT_FALSE(taken()) << "no orbit";
  way = good;
  EXPECT_TRUE(way.path.append(Segment{-1.0 / 30.0, 20.0}));
  EXPECT_FALSE(taken()) << "too tight a turn";
  way = good;
  EXPECT_TRUE(way.path.append(Segment{0.0, 5000.0}));
  EXPECT_FALSE(taken()) << "leads elsewhere";
  way = good;
  way.speed_mps = 31.0;
  EXPECT_FALSE(taken()) << "too fast";
  way = good;
  hazards.push_back(Hazard{{1}, way.path.pose_at(300.0).position(), 50.0});
  EXPECT_FALSE(taken()) << "into a hazard";
  hazards.front().centre += 52.0 * left_of(unit_vector(way.path.start.heading_rad));
  EXPECT_FALSE(taken()) << "nearer to one than its own would lead";
  hazards.front().centre += 10.0 * left_of(unit_vector(way.path.start.heading_rad));
  EXPECT_TRUE(taken());
  hazards.clear();
  EXPECT_TRUE(taken());
  flight.search({}, 40'000.0, at_seconds(33.0));
  EXPECT_FALSE(taken(10'000.0, 34.0)) << "not on its way home";
}

}  // namespace
}  // namespace skein::mission
