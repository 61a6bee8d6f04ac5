// SPDX-License-Identifier: Apache-2.0
// A vehicle that was given a route before the mission.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "agent_parts_test.hpp"
#include "skein/base/angles.hpp"
#include "skein/planning/avoidance.hpp"

namespace skein::mission {
namespace {

constexpr double kSpeed_mps = 20.0;
constexpr double kStep_s = 0.5;
const Vec2 kSite{1000.0, 1000.0};

/// East for 1 km, a left turn of 100 m, north over the site, and on.
TimedPath route() {
  TimedPath timed;
  timed.start_time = at_seconds(0.0);
  timed.speed_mps = kSpeed_mps;
  timed.tail_curvature_per_m = 1.0 / 55.0;
  timed.path.start = {0.0, 100.0, 0.0};
  EXPECT_TRUE(timed.path.append(Segment{0.0, 900.0}));
  EXPECT_TRUE(timed.path.append(Segment{0.01, 50.0 * kPi}));
  EXPECT_TRUE(timed.path.append(Segment{0.0, 900.0}));
  return timed;
}
constexpr double kToSite_m = 900.0 + 50.0 * kPi + 800.0;

VehicleAgentConfig on_route() {
  VehicleAgentConfig config;
  config.vehicle.id = {1};
  config.vehicle.cruise_speed_mps = kSpeed_mps;
  config.vehicle.speed_min_mps = 15.0;
  config.vehicle.speed_max_mps = 25.0;
  config.vehicle.turn_radius_m = 50.0;
  config.vehicle.range_m = 20'000.0;
  config.instance = {7};
  config.protocol.radio_range_m = 5'000.0;
  config.route = route();
  return config;
}

/// A vehicle that is exactly where its newest plan has it, and what its agent said.
class Flown : public HeardAgent {
 public:
  explicit Flown(const VehicleAgentConfig& config) : HeardAgent{config, at_seconds(-2.0)} {}

  void be_at(const Pose2& pose, double seconds) {
    state_.time = at_seconds(seconds);
    state_.x_m = pose.x_m;
    state_.y_m = pose.y_m;
    state_.heading_rad = state_.course_rad = pose.heading_rad;
    state_.groundspeed_mps = state_.airspeed_mps = kSpeed_mps;
    see(state_);
  }
  /// Along its plans until that time.
  void fly_until(double seconds) {
    const double begin_s = to_seconds(state_.time);
    const auto steps = static_cast<int>((seconds - begin_s) / kStep_s + 1e-6);
    for (int k = 1; k <= steps; ++k) {
      const double t = begin_s + k * kStep_s;
      if (t > 0.0) state_.distance_flown_m += kSpeed_mps * kStep_s;
      be_at(plan.timed.pose_at(at_seconds(t)), t);
    }
  }
  void tell(const Message& message) { HeardAgent::tell(message, state_.time); }
  [[nodiscard]] bool said(EventKind kind) const {
    return std::any_of(events.begin(), events.end(),
                       [kind](const MissionEvent& event) { return event.kind() == kind; });
  }
  [[nodiscard]] bool said(const EventBody& body) const {
    return std::any_of(events.begin(), events.end(),
                       [&](const MissionEvent& event) { return event.body == body; });
  }
  [[nodiscard]] Vec2 at(double seconds) const {
    return plan.timed.pose_at(at_seconds(seconds)).position();
  }

 private:
  VehicleState state_;
};

TEST(VehicleWithRoute, FliesItFromMissionTimeZeroAndIsOverTheSiteOnTime) {
  Flown vehicle{on_route()};
  vehicle.be_at({0.0, 100.0, 0.0}, -2.0);
  EXPECT_EQ(vehicle.agent.activity(), Activity::en_route);
  EXPECT_EQ(vehicle.plan.number, 1U);
  EXPECT_EQ(vehicle.at(0.0), (Vec2{0.0, 100.0}));
  const double arrival_s = kToSite_m / kSpeed_mps;
  vehicle.fly_until(arrival_s - kStep_s);
  EXPECT_EQ(vehicle.agent.activity(), Activity::en_route);
  EXPECT_EQ(vehicle.plan.number, 1U) << "no other plan came between";
  EXPECT_LT((vehicle.at(arrival_s) - kSite).norm(), 1e-6);
  EXPECT_NEAR(vehicle.plan.timed.pose_at(at_seconds(arrival_s)).heading_rad, kPi / 2.0, 1e-9);
  // Beyond its end it has no route any more, and its plan leads on from there.
  vehicle.fly_until(arrival_s + 20.0);
  EXPECT_EQ(vehicle.agent.activity(), Activity::searching);
  EXPECT_LT((vehicle.at(arrival_s + 6.0) - Vec2{1000.0, 1100.0}).norm(), 25.0);
  EXPECT_FALSE(vehicle.said(EventKind::vehicle_trouble));
}

TEST(VehicleWithRoute, TakesItUpInTheMiddleWhereItIsThereAtThatTime) {
  Flown vehicle{on_route()};
  const Pose2 there = route().pose_at(at_seconds(50.0));
  vehicle.be_at({there.x_m + 30.0, there.y_m - 30.0, there.heading_rad + 0.5}, 50.0);
  EXPECT_EQ(vehicle.agent.activity(), Activity::en_route);
  EXPECT_LT((vehicle.at(kToSite_m / kSpeed_mps) - kSite).norm(), 1e-6);
  EXPECT_FALSE(vehicle.said(EventKind::vehicle_trouble));
}

TEST(VehicleWithRoute, ElsewhereAtThatTimeItSaysSoAndSearches) {
  const Pose2 there = route().pose_at(at_seconds(50.0));
  for (const Pose2& pose : {Pose2{0.0, 100.0, 0.0},  // too late at the start
                            Pose2{there.x_m + 60.0, there.y_m, there.heading_rad},
                            Pose2{there.x_m, there.y_m, there.heading_rad + 1.0}}) {
    VehicleAgentConfig config = on_route();
    config.search = {{500.0, -500.0}};
    Flown vehicle{config};
    vehicle.be_at(pose, 50.0);
    EXPECT_EQ(vehicle.agent.activity(), Activity::searching);
    EXPECT_TRUE(vehicle.said(event::VehicleTrouble{event::Trouble::route_not_flown}));
    // From where it is.
    EXPECT_LT((vehicle.at(50.0) - pose.position()).norm(), 1e-6);
  }
}

TEST(VehicleWithRoute, AHazardThatDoesNotBarTheWayChangesNothing) {
  VehicleAgentConfig config = on_route();
  // Known before: the planner has kept clear of it, by less than the agent itself would.
  config.hazards = {{{1}, {450.0, 161.0}, 60.0}};
  Flown vehicle{config};
  vehicle.be_at({0.0, 100.0, 0.0}, 0.0);
  vehicle.fly_until(10.0);
  vehicle.tell(HazardReport{{{2}, {800.0, 39.0}, 60.0}});   // beside the way
  vehicle.tell(HazardReport{{{3}, {100.0, 100.0}, 60.0}});  // behind
  EXPECT_TRUE(vehicle.said(event::HazardKnown{{2}, 60.0}));
  vehicle.fly_until(80.0);
  EXPECT_EQ(vehicle.agent.activity(), Activity::en_route);
  EXPECT_EQ(vehicle.plan.number, 1U);
}

TEST(VehicleWithRoute, AHazardOnTheWayEndsIt) {
  Flown vehicle{on_route()};
  vehicle.be_at({0.0, 100.0, 0.0}, 0.0);
  vehicle.fly_until(10.0);
  const Hazard hazard{{4}, {1000.0, 600.0}, 80.0};
  vehicle.tell(HazardReport{hazard});
  EXPECT_NE(vehicle.agent.activity(), Activity::en_route);
  EXPECT_GT(vehicle.plan.number, 1U);
  for (int k = 20; k < 300; ++k) {
    const double t = k * kStep_s;
    vehicle.fly_until(t);
    ASSERT_GT((vehicle.at(t) - hazard.centre).norm(), hazard.radius_m) << t << " s";
    ASSERT_NE(vehicle.agent.activity(), Activity::en_route) << t << " s";
  }
}

TEST(VehicleWithRoute, AHazardToldWhileItWaitsEndsItAtItsStart) {
  Flown vehicle{on_route()};
  vehicle.tell(HazardReport{{{4}, {1000.0, 600.0}, 80.0}});
  vehicle.be_at({0.0, 100.0, 0.0}, -1.0);
  EXPECT_NE(vehicle.agent.activity(), Activity::en_route);
  vehicle.fly_until(60.0);
  EXPECT_NE(vehicle.agent.activity(), Activity::en_route);
}

TEST(VehicleWithRoute, RangeIsKeptForTheWayHome) {
  // To the site and on it needs 1957 m, and back some 1490 m more.
  for (const double range_m : {4'500.0, 2'600.0}) {
    VehicleAgentConfig config = on_route();
    config.vehicle.range_m = range_m;
    Flown vehicle{config};
    vehicle.be_at({0.0, 100.0, 0.0}, 0.0);
    vehicle.fly_until(90.0);
    const bool enough = range_m > 4'000.0;
    EXPECT_EQ(vehicle.said(EventKind::range_spent), !enough) << range_m;
    EXPECT_EQ(vehicle.agent.activity() == Activity::en_route, enough) << range_m;
  }
  VehicleAgentConfig config = on_route();
  config.vehicle.range_m = 2'600.0;
  config.vehicle.recovery = Recovery::anywhere;
  Flown vehicle{config};
  vehicle.be_at({0.0, 100.0, 0.0}, 0.0);
  vehicle.fly_until(90.0);
  EXPECT_EQ(vehicle.agent.activity(), Activity::en_route);
}

TEST(VehicleWithRoute, TheOperatorsOrderEndsItForGood) {
  Flown vehicle{on_route()};
  vehicle.be_at({0.0, 100.0, 0.0}, 0.0);
  vehicle.fly_until(10.0);
  vehicle.tell(Command{{1}, 1, CommandKind::hold});
  EXPECT_EQ(vehicle.agent.activity(), Activity::holding);
  vehicle.fly_until(20.0);
  vehicle.tell(Command{{1}, 2, CommandKind::resume});
  vehicle.fly_until(30.0);
  EXPECT_EQ(vehicle.agent.activity(), Activity::searching);
  EXPECT_LT((vehicle.at(30.0) - Vec2{200.0, 100.0}).norm(), 400.0);
}

TEST(VehicleWithRoute, BidsForATaskOnItsWayAndGoesOnUntilItIsAwarded) {
  VehicleAgentConfig config = on_route();
  config.vehicle.capabilities.add(TaskKind::deliver);
  config.vehicle.loads = 1;
  Flown vehicle{config};
  vehicle.be_at({0.0, 100.0, 0.0}, 0.0);
  vehicle.fly_until(10.0);
  coalition::Announcement announcement;
  announcement.round = {{{2}, {9}, 1}, 1};
  announcement.site.id = {5};
  announcement.site.position = {600.0, 900.0};
  announcement.site.deliveries.resize(1);
  announcement.tasks = tasks_after_survey(announcement.site);
  announcement.announced_at = at_seconds(10.0);
  announcement.bids_until = at_seconds(12.0);
  announcement.formed_at = at_seconds(16.0);
  announcement.reward = 1.0;
  announcement.leader_at_formation = {600.0, 800.0};
  vehicle.tell(coalition::Message{announcement});
  EXPECT_TRUE(vehicle.said(EventKind::bid_sent));
  EXPECT_EQ(vehicle.agent.activity(), Activity::bidding);
  // Nobody answers.
  vehicle.fly_until(70.0);
  EXPECT_EQ(vehicle.plan.number, 1U);
  EXPECT_EQ(vehicle.agent.activity(), Activity::en_route);
}

TEST(VehicleWithRoute, ASiteThatItFindsWaitsForTheEndOfTheRoute) {
  VehicleAgentConfig config = on_route();
  config.vehicle.sensor_radius_m = 100.0;
  config.vehicle.capabilities.add(TaskKind::survey);
  Flown vehicle{config};
  vehicle.be_at({0.0, 100.0, 0.0}, 0.0);
  vehicle.fly_until(10.0);
  Site site;
  site.id = {5};
  site.position = {400.0, 500.0};
  vehicle.tell(SiteReport{{1}, site});
  vehicle.fly_until(90.0);
  EXPECT_EQ(vehicle.agent.activity(), Activity::en_route);
  vehicle.fly_until(110.0);
  EXPECT_EQ(vehicle.agent.activity(), Activity::surveying);
}

}  // namespace
}  // namespace skein::mission
