// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/track_agent.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "skein/base/angles.hpp"

namespace skein::mission {
namespace {

using ::testing::HasSubstr;

/// A plane that is always where its plan has it.
class Cockpit {
 public:
  explicit Cockpit(const TrackAgentConfig& config = plane()) : agent_{config, Instant{}} {
    state_.airspeed_mps = state_.groundspeed_mps = 20.0;
    step();
  }
  static TrackAgentConfig plane() {
    TrackAgentConfig config;
    VehicleSpec& spec = config.vehicle;
    spec.id = {3};
    spec.cruise_speed_mps = 20.0;
    spec.speed_min_mps = 10.0;
    spec.speed_max_mps = 30.0;
    spec.turn_radius_m = 60.0;
    spec.range_m = 20'000.0;
    spec.height_m = 120.0;
    return config;
  }
  void step(Duration by = std::chrono::milliseconds{50}) {
    now += by;
    put(plan ? plan->timed.pose_at(now) : state_.pose());
  }
  void fly(double seconds) {
    for (const Instant until = now + from_seconds(seconds); now < until;) step();
  }
  void tell(const Message& message) {
    agent_.on_message(message, kGroundStation, now);
    drain();
  }
  /// Straight on from where the plan is then, for a kilometre.
  [[nodiscard]] TrackFlight flight(std::uint32_t number, double in_s) const {
    TrackFlight flight;
    flight.vehicle = {3};
    flight.number = number;
    TimedPath& timed = flight.plan.timed;
    timed.start_time = now + from_seconds(in_s);
    timed.speed_mps = 20.0;
    timed.path.start = plan->timed.pose_at(timed.start_time);
    EXPECT_TRUE(timed.path.append(Segment{0.0, 1000.0}));
    timed.paces.push_back(1.2);
    timed.paces.push_back(1.0);
    timed.tail_curvature_per_m = 1.0 / 200.0;
    flight.joined = timed.start_time + std::chrono::seconds{10};
    return flight;
  }
  [[nodiscard]] bool on_straight() const {
    return plan && plan->timed.path.segments.size() == 1 && plan->timed.paces.size() == 2;
  }
  [[nodiscard]] std::string keep(const Fence& fence) { return agent_.keep_fence(fence, now); }
  /// As long as its pilot has it, it is put.
  void is_piloted(bool piloted) {
    agent_.on_piloted(piloted, now);
    drain();
  }
  void put(const Pose2& pose) {
    state_.x_m = pose.x_m;
    state_.y_m = pose.y_m;
    state_.heading_rad = state_.course_rad = pose.heading_rad;
    state_.time = now;
    agent_.on_state(state_, now);
    drain();
  }
  [[nodiscard]] std::uint64_t bad_messages() const { return agent_.counters().bad_messages; }
  void battery(std::uint8_t percent) { state_.battery_percent = percent; }
  [[nodiscard]] double range_left_m() const { return agent_.telemetry().range_left_m; }
  [[nodiscard]] ActivityDetail detail() const { return agent_.telemetry().detail; }
  void distance_m(double metres) { state_.distance_flown_m = metres; }

  Instant now = at_seconds(1.0);
  std::optional<FlightPlan> plan;
  std::vector<MissionEvent> events;
  std::optional<FormationStatus> status;

 private:
  void drain() {
    while (const auto guidance = agent_.poll_guidance()) plan = std::get<FlightPlan>(*guidance);
    while (const auto event = agent_.poll_event()) events.push_back(*event);
    while (const auto message = agent_.poll_message()) {
      if (const auto* said = std::get_if<FormationStatus>(&*message)) status = *said;
    }
  }

  VehicleState state_;
  TrackAgent agent_;
};

TEST(TrackAgent, OrbitsUntilItIsGivenAFlight) {
  Cockpit cockpit;
  cockpit.fly(2.0);
  ASSERT_TRUE(cockpit.plan);
  EXPECT_NE(cockpit.plan->timed.tail_curvature_per_m, 0.0);
  ASSERT_TRUE(cockpit.status);
  EXPECT_TRUE(cockpit.status->at_rest);
  EXPECT_EQ(cockpit.status->progress.change, 0U);
}

TEST(TrackAgent, FliesItsFlightFromTheMomentItBegins) {
  Cockpit cockpit;
  cockpit.fly(2.0);
  cockpit.tell(cockpit.flight(7, 2.0));
  EXPECT_EQ(cockpit.status->progress.change, 7U);
  EXPECT_FALSE(cockpit.on_straight());
  cockpit.fly(1.9);
  EXPECT_FALSE(cockpit.on_straight());
  cockpit.fly(0.3);
  EXPECT_TRUE(cockpit.on_straight());
  cockpit.fly(11.0);
  EXPECT_EQ(cockpit.events.back().kind(), EventKind::place_reached);
  EXPECT_FALSE(cockpit.status->at_rest);
  // To the end, 1000 m at 24 m/s, and around the orbit there.
  cockpit.fly(40.0);
  EXPECT_TRUE(cockpit.status->at_rest);
  EXPECT_LT(cockpit.status->progress.off_m, 1e-6);
}

TEST(TrackAgent, RefusesWhatItCannotFlyOrWhatBeginsElsewhere) {
  Cockpit cockpit;
  cockpit.fly(2.0);
  TrackFlight elsewhere = cockpit.flight(1, 2.0);
  elsewhere.plan.timed.path.start.x_m += 5.0;
  TrackFlight fast = cockpit.flight(2, 2.0);
  fast.plan.timed.paces[0] = 1.6;
  TrackFlight late = cockpit.flight(3, -1.5);
  const std::vector<TrackFlight> bad{elsewhere, fast, late};
  const std::vector<event::ChangeRefusal> why{event::ChangeRefusal::begins_elsewhere,
                                              event::ChangeRefusal::too_fast,
                                              event::ChangeRefusal::begins_elsewhere};
  for (std::size_t i = 0; i < bad.size(); ++i) {
    cockpit.tell(bad[i]);
    cockpit.tell(bad[i]);  // it is said once
    ASSERT_EQ(cockpit.events.size(), i + 1);
    EXPECT_EQ(std::get<event::ChangeRefused>(cockpit.events.back().body).why, why[i]);
  }
  // Tighter than it turns, or without an orbit at its end, it was planned by nobody.
  TrackFlight tight = cockpit.flight(4, 2.0);
  tight.plan.timed.tail_curvature_per_m = 1.0 / 50.0;
  TrackFlight endless = cockpit.flight(5, 2.0);
  endless.plan.timed.tail_curvature_per_m = 0.0;
  TrackFlight unpaced = cockpit.flight(6, 2.0);
  unpaced.plan.timed.paces.pop_back();
  TrackFlight still = cockpit.flight(7, 2.0);
  still.plan.timed.speed_mps = 1e-300;
  for (const TrackFlight& flight : {tight, endless, unpaced, still}) cockpit.tell(flight);
  EXPECT_EQ(cockpit.bad_messages(), 4U);
  cockpit.fly(3.0);
  EXPECT_EQ(cockpit.events.size(), bad.size());
  EXPECT_FALSE(cockpit.on_straight());
}

TEST(TrackAgent, HoldsAtOnceAndTakesNothingUpUntilItMayGoOn) {
  Cockpit cockpit;
  cockpit.fly(2.0);
  cockpit.tell(cockpit.flight(1, 1.0));
  cockpit.fly(5.0);
  ASSERT_TRUE(cockpit.on_straight());
  cockpit.tell(Command{{3}, 9000, CommandKind::hold});
  cockpit.fly(1.0);
  EXPECT_FALSE(cockpit.on_straight());
  EXPECT_TRUE(cockpit.status->at_rest);
  EXPECT_EQ(cockpit.detail(), ActivityDetail::ordered);
  cockpit.tell(cockpit.flight(2, 1.0));
  EXPECT_EQ(std::get<event::ChangeRefused>(cockpit.events.back().body).why,
            event::ChangeRefusal::obeys_others);
  cockpit.tell(Command{{3}, 9001, CommandKind::resume});
  cockpit.tell(cockpit.flight(2, 1.0));
  cockpit.fly(2.0);
  EXPECT_TRUE(cockpit.on_straight());
}

TEST(TrackAgent, LeavesTheFormationWithItsPilotAndGoesOnWhereItIsGivenBack) {
  for (const bool homes : {false, true}) {
    Cockpit cockpit;
    cockpit.fly(2.0);
    cockpit.tell(cockpit.flight(1, 1.0));
    cockpit.fly(5.0);
    ASSERT_TRUE(cockpit.on_straight());
    cockpit.is_piloted(true);
    EXPECT_FALSE(cockpit.on_straight());
    EXPECT_EQ(cockpit.detail(), ActivityDetail::piloted);
    cockpit.tell(cockpit.flight(2, 1.0));
    EXPECT_EQ(std::get<event::ChangeRefused>(cockpit.events.back().body).why,
              event::ChangeRefusal::obeys_others);
    if (homes) cockpit.tell(Command{{3}, 9000, CommandKind::return_home});
    const Pose2 there{-700.0, 300.0, 2.0};
    cockpit.now += std::chrono::seconds{20};
    cockpit.put(there);
    cockpit.is_piloted(false);
    const Pose2 led = cockpit.plan->timed.pose_at(cockpit.now);
    EXPECT_LT((led.position() - there.position()).norm(), 1e-6);
    EXPECT_NEAR(led.heading_rad, there.heading_rad, 1e-9);
    EXPECT_EQ(cockpit.detail(), homes ? ActivityDetail::returning : ActivityDetail::none);
    cockpit.fly(1.0);
    EXPECT_TRUE(cockpit.status->at_rest);
    if (homes) continue;
    cockpit.tell(cockpit.flight(3, 1.0));
    cockpit.fly(2.0);
    EXPECT_TRUE(cockpit.on_straight());
  }
}

TEST(TrackAgent, LeavesTheFormationForAHazardInItsWay) {
  Cockpit cockpit;
  cockpit.fly(2.0);
  cockpit.tell(cockpit.flight(1, 1.0));
  cockpit.fly(2.0);
  ASSERT_TRUE(cockpit.on_straight());
  const Vec2 aside = cockpit.plan->timed.pose_at(cockpit.now).position() + Vec2{5000.0, 5000.0};
  cockpit.tell(HazardReport{{{1}, aside, 100.0}});
  EXPECT_TRUE(cockpit.on_straight());
  const Vec2 ahead = cockpit.plan->timed.pose_at_distance(900.0).position();
  cockpit.tell(HazardReport{{{2}, ahead, 50.0}});
  EXPECT_FALSE(cockpit.on_straight());
  cockpit.fly(1.0);
  EXPECT_TRUE(cockpit.status->at_rest);
}

TEST(TrackAgent, DoesNotBeginAFlightIntoAHazardToldMeanwhile) {
  Cockpit cockpit;
  cockpit.fly(2.0);
  const TrackFlight next = cockpit.flight(1, 2.0);
  cockpit.tell(next);
  cockpit.tell(HazardReport{{{2}, next.plan.timed.pose_at_distance(900.0).position(), 50.0}});
  cockpit.fly(3.0);
  EXPECT_FALSE(cockpit.on_straight());
  EXPECT_TRUE(cockpit.status->at_rest);
}

TEST(TrackAgent, KeepsAFenceWhereNothingThatItFliesLeadsOut) {
  Cockpit cockpit;
  cockpit.fly(2.0);
  Fence around;
  around.corners = {{-700.0, -700.0}, {700.0, -700.0}, {700.0, 700.0}, {-700.0, 700.0}};
  around.height_max_m = 200.0;
  EXPECT_EQ(cockpit.keep(around), "");
  Fence low = around;
  low.height_max_m = 100.0;
  EXPECT_NE(cockpit.keep(low), "");
  cockpit.tell(cockpit.flight(1, 1.0));
  EXPECT_THAT(cockpit.keep(around), HasSubstr("to fly next"));
  cockpit.fly(2.0);
  ASSERT_TRUE(cockpit.on_straight());
  EXPECT_THAT(cockpit.keep(around), HasSubstr("what it flies leads out"));
}

TEST(TrackAgent, ComesHomeWhenItsRangeIsSpent) {
  Cockpit cockpit;
  cockpit.fly(2.0);
  cockpit.tell(cockpit.flight(1, 1.0));
  cockpit.fly(20.0);
  cockpit.distance_m(19'900.0);
  cockpit.fly(2.0);
  EXPECT_EQ(cockpit.events.back().kind(), EventKind::range_spent);
  EXPECT_FALSE(cockpit.on_straight());
}

TEST(TrackAgent, ComesHomeWhenItsBatteryFalls) {
  Cockpit cockpit;
  cockpit.battery(90);
  cockpit.fly(2.0);
  cockpit.tell(cockpit.flight(1, 1.0));
  cockpit.fly(20.0);
  EXPECT_TRUE(cockpit.on_straight());
  cockpit.battery(21);  // 250 m above its reserve
  cockpit.fly(5.0);
  EXPECT_LE(cockpit.range_left_m(), 250.0);
  ASSERT_EQ(cockpit.events.back().kind(), EventKind::range_spent);
  const auto& spent = std::get<event::RangeSpent>(cockpit.events.back().body);
  EXPECT_TRUE(spent.by_battery && spent.comes_home);
  EXPECT_GT(spent.home_m, 0.0);
  EXPECT_FALSE(cockpit.on_straight());
  EXPECT_EQ(cockpit.detail(), ActivityDetail::range_reserve);
}

TEST(TrackAgent, HoldsWhenItsRangeIsSpentWhereItIsRecoveredAnywhere) {
  TrackAgentConfig config = Cockpit::plane();
  config.vehicle.recovery = Recovery::anywhere;
  Cockpit cockpit{config};
  cockpit.fly(2.0);
  cockpit.tell(cockpit.flight(1, 1.0));
  cockpit.fly(20.0);
  ASSERT_TRUE(cockpit.on_straight());
  cockpit.distance_m(19'990.0);
  cockpit.fly(2.0);
  EXPECT_EQ(cockpit.events.back().kind(), EventKind::range_spent);
  EXPECT_FALSE(cockpit.on_straight());
  EXPECT_TRUE(cockpit.status->at_rest);
}

TEST(TrackAgent, OnItsWayHomeByOrderItTakesUpTheWayThatIsPlannedWithTheOthers) {
  TrackAgentConfig fenced = Cockpit::plane();
  fenced.fence.corners = {{-900.0, -900.0}, {900.0, -900.0}, {900.0, 900.0}, {-900.0, 900.0}};
  fenced.fence.height_max_m = 200.0;
  Cockpit cockpit{fenced};
  cockpit.fly(60.0);
  ReturnFlight way;
  way.vehicle = {3};
  way.plan = 1;
  const auto way_from = [&](double in_s) {
    way.timed.start_time = cockpit.now + from_seconds(in_s);
    way.timed.speed_mps = 20.0;
    way.timed.path = Path{cockpit.plan->timed.pose_at(way.timed.start_time), {}};
    EXPECT_TRUE(way.timed.path.append(Segment{1.0 / 90.0, 400.0}));
    way.timed.tail_curvature_per_m = 1.0 / 90.0;
  };
  way_from(5.0);
  cockpit.tell(way);
  const auto number = cockpit.plan->number;
  cockpit.fly(1.0);
  EXPECT_EQ(cockpit.plan->number, number) << "it was not ordered home";
  Command home;
  home.vehicle = {3};
  home.number = 61'001;
  home.kind = CommandKind::return_home;
  cockpit.tell(home);
  EXPECT_GT(cockpit.plan->number, number);
  EXPECT_EQ(cockpit.detail(), ActivityDetail::returning);
  way_from(5.0);
  ReturnFlight out = way;
  EXPECT_TRUE(out.timed.path.append(Segment{0.0, 2000.0}));
  EXPECT_TRUE(out.timed.path.append(Segment{1.0 / 90.0, 90.0 * kPi}));
  EXPECT_TRUE(out.timed.path.append(Segment{0.0, 2000.0}));
  const auto own = cockpit.plan->number;
  cockpit.tell(out);
  EXPECT_EQ(cockpit.plan->number, own) << "it leads out of the fence";
  cockpit.tell(way);
  const Instant later = way.timed.start_time + std::chrono::seconds{10};
  const Vec2 there = way.timed.pose_at(later).position();
  EXPECT_LT((cockpit.plan->timed.pose_at(later).position() - there).norm(), 1e-6);
  const auto taken = cockpit.plan->number;
  cockpit.tell(way);
  EXPECT_EQ(cockpit.plan->number, taken) << "once";
}

}  // namespace
}  // namespace skein::mission
