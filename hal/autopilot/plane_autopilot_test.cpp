// SPDX-License-Identifier: Apache-2.0
#include "skein/autopilot/plane_autopilot.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "flight_test.hpp"
#include "skein/base/angles.hpp"

namespace skein::autopilot {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// An autopilot in its aircraft.
class Plane {
 public:
  explicit Plane(const TestFlight::Conditions& conditions, const PlaneParams& params = {})
      : flight_{conditions}, autopilot_{params} {
    step();
  }

  void step() {
    flight_.advance(autopilot_.step(flight_.estimate(), now()));
    while (const auto notice = autopilot_.poll_notice()) said_ += notice->text + "\n";
  }
  void fly(double seconds) {
    const double end = flight_.seconds() + seconds - 1e-6;
    while (flight_.seconds() < end) step();
  }
  /// Until the condition holds; false after `seconds`.
  template <class Condition>
  bool fly_until(const Condition& condition, double seconds) {
    const double end = flight_.seconds() + seconds;
    while (!condition()) {
      if (flight_.seconds() > end) return false;
      step();
    }
    return true;
  }

  [[nodiscard]] Instant now() const { return at_seconds(flight_.seconds()); }
  [[nodiscard]] PlaneAutopilot& autopilot() { return autopilot_; }
  [[nodiscard]] const TestFlight& flight() const { return flight_; }
  [[nodiscard]] bool said(const std::string& text) const {
    return said_.find(text) != std::string::npos;
  }
  [[nodiscard]] double distance_to(const Vec2& place) const {
    return (flight_.plane().state().position_m.head<2>() - place).norm();
  }
  [[nodiscard]] double heading() const {
    return euler_angles(flight_.plane().state().attitude).yaw_rad;
  }

 private:
  TestFlight flight_;
  PlaneAutopilot autopilot_;
  std::string said_;
};

/// Armed in flight, in GUIDED.
Plane guided(const TestFlight::Conditions& conditions = {}, const PlaneParams& params = {}) {
  Plane plane{conditions, params};
  EXPECT_EQ(plane.autopilot().arm(), CommandResult::accepted);
  EXPECT_EQ(plane.autopilot().select_mode(PlaneMode::guided), CommandResult::accepted);
  return plane;
}

TEST(PlaneAutopilot, RefusesToArmWithTheReason) {
  Plane plane{{.height_m = 0.0}};
  plane.autopilot().set_health({.position = false});
  EXPECT_EQ(plane.autopilot().arm(), CommandResult::failed);
  plane.step();
  EXPECT_TRUE(plane.said("Arm: Need Position Estimate"));
  EXPECT_FALSE(plane.autopilot().armed());
  EXPECT_EQ(plane.autopilot().select_mode(PlaneMode::guided), CommandResult::failed);
  plane.autopilot().set_health({});
  EXPECT_EQ(plane.autopilot().select_mode(PlaneMode::rtl), CommandResult::accepted);
  EXPECT_EQ(plane.autopilot().arm(), CommandResult::failed);
  EXPECT_EQ(plane.autopilot().select_mode(PlaneMode::takeoff), CommandResult::accepted);
  EXPECT_EQ(plane.autopilot().arm(), CommandResult::accepted);
  EXPECT_EQ(plane.autopilot().disarm(false), CommandResult::accepted);
}

TEST(PlaneAutopilot, DoesNotMoveBeforeItIsArmedOrTakesOff) {
  Plane plane{{.height_m = 0.0}};
  plane.autopilot().set_sticks({.throttle = 1.0});
  EXPECT_EQ(plane.autopilot().select_mode(PlaneMode::takeoff), CommandResult::accepted);
  plane.fly(3.0);
  EXPECT_LT(plane.distance_to({0.0, 0.0}), 0.1);
  EXPECT_EQ(plane.autopilot().select_mode(PlaneMode::guided), CommandResult::accepted);
  EXPECT_EQ(plane.autopilot().arm(), CommandResult::accepted);
  plane.fly(3.0);  // on the ground GUIDED keeps the throttle shut
  EXPECT_LT(plane.distance_to({0.0, 0.0}), 0.1);
}

TEST(PlaneAutopilot, TakesOffAndCircles) {
  Plane plane{{.heading_rad = 1.0, .height_m = 0.0, .wind_mps = {-2.0, -3.0, 0.0}}};
  EXPECT_EQ(plane.autopilot().select_mode(PlaneMode::takeoff), CommandResult::accepted);
  EXPECT_EQ(plane.autopilot().arm(), CommandResult::accepted);
  ASSERT_TRUE(plane.fly_until([&] { return plane.flight().height_m() > 55.0; }, 40.0));
  EXPECT_NEAR(wrap_pi(plane.flight().course_rad() - 1.0), 0.0, 0.15);
  plane.fly(60.0);
  EXPECT_NEAR(plane.flight().height_m(), 60.0, 5.0);
  EXPECT_NEAR(plane.distance_to(plane.autopilot().status().goal_m), 165.0, 10.0);
  EXPECT_EQ(plane.autopilot().mode(), PlaneMode::takeoff);
  EXPECT_EQ(plane.autopilot().disarm(false), CommandResult::failed);  // not in the air
}

TEST(PlaneAutopilot, FliesAMissionAndLands) {
  using Kind = MissionItem::Kind;
  const std::array mission{
      MissionItem{.kind = Kind::takeoff, .height_m = 60.0},
      MissionItem{.kind = Kind::waypoint, .north_m = 1500.0, .height_m = 100.0},
      MissionItem{.kind = Kind::change_speed, .airspeed_mps = 55.0},
      MissionItem{.kind = Kind::waypoint, .north_m = 1500.0, .east_m = 1500.0, .height_m = 100.0},
      MissionItem{.kind = Kind::waypoint, .north_m = -1500.0, .east_m = 1500.0, .height_m = 100.0},
      MissionItem{.kind = Kind::waypoint, .north_m = -1500.0, .east_m = 0.0, .height_m = 60.0},
      MissionItem{.kind = Kind::land, .north_m = 0.0, .east_m = 0.0, .height_m = 0.4},
  };
  Plane plane{
      {.height_m = 0.0, .wind_mps = {-3.0, 1.0, 0.0}, .gusts_wind_mps = 3.0, .noise = true}};
  EXPECT_EQ(plane.autopilot().select_mode(PlaneMode::mission), CommandResult::failed);
  EXPECT_EQ(plane.autopilot().load_mission(mission), CommandResult::accepted);
  EXPECT_EQ(plane.autopilot().select_mode(PlaneMode::mission), CommandResult::accepted);
  EXPECT_EQ(plane.autopilot().arm(), CommandResult::accepted);
  for (std::size_t i = 1; i < mission.size(); ++i) {
    ASSERT_TRUE(
        plane.fly_until([&] { return plane.autopilot().status().mission_item >= i; }, 120.0))
        << i;
  }
  double hardest = 0.0;
  double touched_m = 1e9;
  ASSERT_TRUE(plane.fly_until(
      [&] {
        if (plane.flight().plane().on_ground() && plane.autopilot().status().flying) {
          touched_m = std::min(touched_m, plane.flight().plane().state().position_m.x());
          hardest = std::max(hardest, plane.flight().plane().state().velocity_ned_mps().z());
        }
        return !plane.autopilot().armed();
      },
      150.0));
  EXPECT_TRUE(plane.said("Landed"));
  EXPECT_EQ(plane.autopilot().mode_refusal(), kLandingSequence);
  EXPECT_TRUE(plane.flight().plane().on_ground());
  EXPECT_LT(hardest, 1.5);
  EXPECT_NEAR(plane.flight().plane().state().position_m.y(), 0.0, 15.0);
  EXPECT_NEAR(touched_m, 0.0, 200.0);
  EXPECT_LT(plane.distance_to({0.0, 0.0}), 1000.0);  // it has no brakes
}

TEST(PlaneAutopilot, AMissionWithoutALandingReturns) {
  const std::array mission{MissionItem{.north_m = 800.0, .height_m = 300.0}};
  Plane plane{{}};
  EXPECT_EQ(plane.autopilot().load_mission(mission), CommandResult::accepted);
  EXPECT_EQ(plane.autopilot().arm(), CommandResult::accepted);
  EXPECT_EQ(plane.autopilot().select_mode(PlaneMode::mission), CommandResult::accepted);
  ASSERT_TRUE(plane.fly_until([&] { return plane.autopilot().mode() == PlaneMode::rtl; }, 30.0));
  plane.fly(90.0);
  EXPECT_NEAR(plane.distance_to({0.0, 0.0}), 165.0, 10.0);
  EXPECT_NEAR(plane.flight().height_m(), 100.0, 5.0);
}

TEST(PlaneAutopilot, BadMissionsAreDenied) {
  Plane plane{{}};
  EXPECT_EQ(plane.autopilot().load_mission({}), CommandResult::denied);
  const std::array nowhere{MissionItem{.north_m = kNan}};
  EXPECT_EQ(plane.autopilot().load_mission(nowhere), CommandResult::denied);
  const std::array slow{MissionItem{.kind = MissionItem::Kind::change_speed, .airspeed_mps = 5.0}};
  EXPECT_EQ(plane.autopilot().load_mission(slow), CommandResult::denied);
  EXPECT_EQ(plane.autopilot().set_mission_item(0), CommandResult::denied);
}

TEST(PlaneAutopilot, RepositionsAndOrbitsEitherWay) {
  Plane plane = guided({.wind_mps = {0.0, 5.0, 0.0}});
  EXPECT_EQ(plane.autopilot().reposition({.centre_m = {600.0, 300.0}, .height_m = 330.0}),
            CommandResult::accepted);
  plane.fly(60.0);
  EXPECT_NEAR(plane.distance_to({600.0, 300.0}), 165.0, 8.0);
  EXPECT_NEAR(plane.flight().height_m(), 330.0, 4.0);
  EXPECT_EQ(plane.autopilot().reposition({.centre_m = {600.0, 300.0},
                                          .radius_m = 220.0,
                                          .clockwise = false,
                                          .airspeed_mps = 55.0}),
            CommandResult::accepted);
  plane.fly(60.0);
  EXPECT_NEAR(plane.distance_to({600.0, 300.0}), 220.0, 8.0);
  EXPECT_NEAR(plane.flight().airspeed_mps(), 55.0, 1.0);
}

TEST(PlaneAutopilot, RepositionChangesTheModeOnlyWhereAsked) {
  Plane plane{{}};
  EXPECT_EQ(plane.autopilot().arm(), CommandResult::accepted);
  EXPECT_EQ(plane.autopilot().select_mode(PlaneMode::loiter), CommandResult::accepted);
  EXPECT_EQ(plane.autopilot().reposition({.centre_m = {600.0, 0.0}}), CommandResult::denied);
  EXPECT_EQ(plane.autopilot().reposition({.centre_m = {kNan, 0.0}, .change_mode = true}),
            CommandResult::denied);
  EXPECT_EQ(plane.autopilot().mode(), PlaneMode::loiter);
  EXPECT_EQ(plane.autopilot().reposition({.centre_m = {600.0, 0.0}, .change_mode = true}),
            CommandResult::accepted);
  EXPECT_EQ(plane.autopilot().mode(), PlaneMode::guided);
}

TEST(PlaneAutopilot, FliesACourseOrAHeading) {
  for (const HeadingKind kind : {HeadingKind::course, HeadingKind::heading}) {
    Plane plane = guided({.wind_mps = {5.0, 0.0, 0.0}});
    EXPECT_EQ(plane.autopilot().guided_heading(kind, kPi / 2, 0.0), CommandResult::accepted);
    plane.fly(20.0);
    const double flown =
        kind == HeadingKind::course ? plane.flight().course_rad() : plane.heading();
    EXPECT_NEAR(degrees(wrap_pi(flown - kPi / 2)), 0.0, 0.5);
    // The wind makes the other differ.
    EXPECT_NEAR(degrees(std::abs(wrap_pi(plane.flight().course_rad() - plane.heading()))), 5.7,
                0.7);
  }
}

TEST(PlaneAutopilot, TurnsWithinTheLateralAcceleration) {
  Plane plane = guided();
  EXPECT_EQ(plane.autopilot().guided_heading(HeadingKind::heading, kPi / 2, 3.0),
            CommandResult::accepted);
  double steepest = 0.0;
  for (int i = 0; i < 600; ++i) {
    plane.step();
    steepest = std::max(steepest, euler_angles(plane.flight().plane().state().attitude).roll_rad);
  }
  EXPECT_NEAR(steepest, std::atan(3.0 / kGravity_mps2), 0.03);
}

TEST(PlaneAutopilot, AHeadingOutranksARepositionUntilGuidedIsEnteredAnew) {
  Plane plane = guided();
  EXPECT_EQ(plane.autopilot().guided_heading(HeadingKind::course, 0.0, 0.0),
            CommandResult::accepted);
  EXPECT_EQ(plane.autopilot().reposition({.centre_m = {0.0, 2000.0}}), CommandResult::accepted);
  plane.fly(15.0);
  EXPECT_NEAR(degrees(plane.flight().course_rad()), 0.0, 1.0);
  EXPECT_EQ(plane.autopilot().select_mode(PlaneMode::loiter), CommandResult::accepted);
  EXPECT_EQ(plane.autopilot().select_mode(PlaneMode::guided), CommandResult::accepted);
  EXPECT_EQ(plane.autopilot().reposition({.centre_m = {0.0, 2000.0}}), CommandResult::accepted);
  const double before = plane.distance_to({0.0, 2000.0});
  plane.fly(20.0);
  EXPECT_LT(plane.distance_to({0.0, 2000.0}), before - 500.0);
}

TEST(PlaneAutopilot, SpeedsHaveLimitsAndSlew) {
  Plane plane = guided();
  PlaneAutopilot& autopilot = plane.autopilot();
  EXPECT_EQ(autopilot.guided_heading(HeadingKind::course, 0.0, 0.0), CommandResult::accepted);
  EXPECT_EQ(autopilot.guided_speed(20.0, 0.0), CommandResult::denied);
  EXPECT_EQ(autopilot.guided_speed(kNan, 0.0), CommandResult::denied);
  EXPECT_EQ(autopilot.change_speed(90.0), CommandResult::denied);
  EXPECT_EQ(autopilot.change_speed(55.0), CommandResult::accepted);
  plane.fly(15.0);
  EXPECT_NEAR(plane.flight().airspeed_mps(), 55.0, 0.5);
  EXPECT_EQ(autopilot.guided_speed(45.0, 0.5), CommandResult::accepted);
  plane.fly(10.0);
  EXPECT_NEAR(plane.flight().airspeed_mps(), 50.0, 1.5);  // half a metre a second each second
  plane.fly(20.0);
  EXPECT_NEAR(plane.flight().airspeed_mps(), 45.0, 0.5);
  EXPECT_EQ(autopilot.change_speed(60.0), CommandResult::accepted);  // outranked
  plane.fly(10.0);
  EXPECT_NEAR(plane.flight().airspeed_mps(), 45.0, 0.5);
  EXPECT_EQ(autopilot.guided_height(330.0, 2.0), CommandResult::accepted);
  plane.fly(10.0);
  EXPECT_NEAR(plane.flight().height_m(), 317.0, 5.0);
  plane.fly(20.0);
  EXPECT_NEAR(plane.flight().height_m(), 330.0, 2.0);
  EXPECT_EQ(autopilot.select_mode(PlaneMode::loiter), CommandResult::accepted);
  EXPECT_EQ(autopilot.guided_speed(50.0, 0.0), CommandResult::failed);
  EXPECT_EQ(autopilot.guided_heading(HeadingKind::course, 0.0, 0.0), CommandResult::failed);
  EXPECT_EQ(autopilot.guided_height(300.0, 0.0), CommandResult::failed);
}

TEST(PlaneAutopilot, AnAttitudeTargetEndsThreeSecondsAfterTheLast) {
  Plane plane = guided();
  const auto roll = [&] { return euler_angles(plane.flight().plane().state().attitude).roll_rad; };
  EXPECT_EQ(plane.autopilot().guided_heading(HeadingKind::course, 0.0, 0.0),
            CommandResult::accepted);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(plane.autopilot().attitude_target({.roll_rad = radians(25.0)}, plane.now()),
              CommandResult::accepted);
    plane.fly(0.05);
  }
  EXPECT_NEAR(degrees(roll()), 25.0, 1.0);
  plane.fly(2.9);
  EXPECT_NEAR(degrees(plane.autopilot().status().roll_rad), 25.0, 1e-9);
  plane.fly(0.15);
  EXPECT_LT(degrees(plane.autopilot().status().roll_rad), 0.0);  // back to its course
}

TEST(PlaneAutopilot, ALostCompanionMeansReturn) {
  Plane plane = guided({}, {.companion_failsafe = true});
  PlaneAutopilot& autopilot = plane.autopilot();
  EXPECT_EQ(autopilot.guided_heading(HeadingKind::course, 0.0, 0.0), CommandResult::accepted);
  for (int i = 0; i < 10; ++i) {
    autopilot.companion_heard(plane.now());
    plane.fly(1.0);
  }
  EXPECT_EQ(autopilot.mode(), PlaneMode::guided);
  plane.fly(3.9);
  EXPECT_EQ(autopilot.mode(), PlaneMode::guided);
  plane.fly(0.2);
  EXPECT_EQ(autopilot.mode(), PlaneMode::rtl);
  EXPECT_TRUE(plane.said("GCS Failsafe On"));
  // Its return does not end it; a command does.
  autopilot.companion_heard(plane.now());
  plane.fly(1.0);
  EXPECT_EQ(autopilot.mode(), PlaneMode::rtl);
  EXPECT_EQ(autopilot.reposition({.centre_m = {0.0, 0.0}, .change_mode = true}),
            CommandResult::accepted);
  EXPECT_EQ(autopilot.mode(), PlaneMode::guided);
}

TEST(PlaneAutopilot, WithoutTheFailsafeItFliesOn) {
  Plane plane = guided();
  plane.autopilot().companion_heard(plane.now());
  plane.fly(10.0);
  EXPECT_EQ(plane.autopilot().mode(), PlaneMode::guided);
}

TEST(PlaneAutopilot, APilotFliesBySticks) {
  Plane plane{{}};
  EXPECT_EQ(plane.autopilot().arm(), CommandResult::accepted);
  EXPECT_EQ(plane.autopilot().select_mode(PlaneMode::fbwa), CommandResult::accepted);
  plane.autopilot().set_sticks({.roll = 0.5, .pitch = 0.1, .throttle = 0.65});
  plane.fly(5.0);
  const EulerAngles angles = euler_angles(plane.flight().plane().state().attitude);
  EXPECT_NEAR(angles.roll_rad, 0.5 * plane.autopilot().params().tuning.roll_max_rad, 0.03);
  EXPECT_NEAR(angles.pitch_rad, 0.1 * plane.autopilot().params().tuning.pitch_max_rad, 0.03);
  EXPECT_EQ(plane.autopilot().select_mode(PlaneMode::manual), CommandResult::accepted);
  plane.autopilot().set_sticks({.roll = -1.0, .throttle = 0.6});
  plane.fly(0.3);
  EXPECT_LT(plane.flight().plane().actuators().aileron_rad, -0.4);
}

}  // namespace
}  // namespace skein::autopilot
