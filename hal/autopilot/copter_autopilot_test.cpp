// SPDX-License-Identifier: Apache-2.0
#include "skein/autopilot/copter_autopilot.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "flight_test.hpp"
#include "skein/base/angles.hpp"

namespace skein::autopilot {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// An autopilot in its vehicle.
class Copter {
 public:
  explicit Copter(const TestHover::Conditions& conditions, const CopterParams& params = {})
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
  [[nodiscard]] CopterAutopilot& autopilot() { return autopilot_; }
  [[nodiscard]] const TestHover& flight() const { return flight_; }
  [[nodiscard]] bool said(const std::string& text) const {
    return said_.find(text) != std::string::npos;
  }
  [[nodiscard]] double distance_to(const Vec3& place) const {
    return (flight_.state().position_m - place).norm();
  }

 private:
  TestHover flight_;
  CopterAutopilot autopilot_;
  std::string said_;
};

/// From the ground to 20 m, in GUIDED.
Copter airborne(const TestHover::Conditions& conditions = {}, const CopterParams& params = {}) {
  Copter copter{conditions, params};
  EXPECT_EQ(copter.autopilot().select_mode(CopterMode::guided), CommandResult::accepted);
  EXPECT_EQ(copter.autopilot().arm(), CommandResult::accepted);
  EXPECT_EQ(copter.autopilot().take_off(20.0), CommandResult::accepted);
  EXPECT_TRUE(copter.fly_until([&] { return copter.flight().height_m() > 19.6; }, 20.0));
  copter.fly(3.0);
  return copter;
}

TEST(CopterAutopilot, RefusesToArmWithTheReason) {
  Copter copter{{}};
  copter.autopilot().set_health({.satellites = false});
  EXPECT_EQ(copter.autopilot().arm(), CommandResult::failed);
  copter.step();
  EXPECT_TRUE(copter.said("GPS 1: Bad fix"));
  copter.autopilot().set_health({});
  EXPECT_EQ(copter.autopilot().select_mode(CopterMode::land), CommandResult::accepted);
  EXPECT_EQ(copter.autopilot().arm(), CommandResult::failed);
  copter.step();
  EXPECT_TRUE(copter.said("Mode not armable"));
  EXPECT_EQ(copter.autopilot().take_off(10.0), CommandResult::failed);
}

TEST(CopterAutopilot, TakesOffWhereItStandsAndHolds) {
  Copter copter = airborne({.wind_mps = {3.0, -4.0, 0.0}, .gusts_wind_mps = 5.0, .noise = true});
  double worst = 0.0;
  for (int i = 0; i < 8000; ++i) {
    copter.step();
    worst = std::max(worst, copter.distance_to({0.0, 0.0, -20.0}));
  }
  EXPECT_LT(worst, 0.7);
  EXPECT_EQ(copter.autopilot().disarm(false), CommandResult::failed);
}

TEST(CopterAutopilot, StaysOnTheGroundUntilToldToTakeOff) {
  Copter copter{{}};
  EXPECT_EQ(copter.autopilot().select_mode(CopterMode::guided), CommandResult::accepted);
  EXPECT_EQ(copter.autopilot().arm(), CommandResult::accepted);
  EXPECT_EQ(copter.autopilot().position_target({.position_m = Vec3{5.0, 0.0, -20.0}}, copter.now()),
            CommandResult::temporarily_rejected);
  copter.fly(3.0);
  EXPECT_LT(copter.flight().height_m(), 0.1);
  EXPECT_TRUE(copter.flight().on_ground());
  EXPECT_EQ(copter.autopilot().take_off(kNan), CommandResult::denied);
}

TEST(CopterAutopilot, GoesToAPositionWithoutOvershoot) {
  Copter copter = airborne();
  EXPECT_EQ(
      copter.autopilot().position_target({.position_m = Vec3{60.0, 0.0, -30.0}}, copter.now()),
      CommandResult::accepted);
  double farthest = 0.0;
  double fastest = 0.0;
  for (int i = 0; i < 8000; ++i) {
    copter.step();
    farthest = std::max(farthest, copter.flight().state().position_m.x());
    fastest = std::max(fastest, copter.flight().state().velocity_mps.norm());
  }
  EXPECT_LT(farthest, 61.0);
  EXPECT_NEAR(fastest, 10.0, 1.0);
  EXPECT_LT(copter.distance_to({60.0, 0.0, -30.0}), 0.3);
  // A position does not grow old.
  copter.fly(5.0);
  EXPECT_LT(copter.distance_to({60.0, 0.0, -30.0}), 0.3);
}

TEST(CopterAutopilot, FliesACircleOfSetpoints) {
  Copter copter = airborne({.wind_mps = {3.0, -4.0, 0.0}, .gusts_wind_mps = 5.0, .noise = true});
  const double start = copter.flight().seconds();
  double worst = 0.0;
  for (int i = 0; i < 32000; ++i) {
    const double angle = 6.0 / 30.0 * (copter.flight().seconds() - start);
    const Vec3 place{30.0 * std::sin(angle), 30.0 * (1.0 - std::cos(angle)), -20.0};
    if (i % 40 == 0) {
      EXPECT_EQ(copter.autopilot().position_target(
                    {.position_m = place,
                     .velocity_mps = Vec3{6.0 * std::cos(angle), 6.0 * std::sin(angle), 0.0}},
                    copter.now()),
                CommandResult::accepted);
    }
    copter.step();
    if (i > 4000) worst = std::max(worst, copter.distance_to(place));
  }
  EXPECT_LT(worst, 1.2);
}

TEST(CopterAutopilot, AVelocityEndsThreeSecondsAfterTheLast) {
  Copter copter = airborne();
  for (int i = 0; i < 50; ++i) {
    EXPECT_EQ(
        copter.autopilot().position_target({.velocity_mps = Vec3{0.0, 6.0, 0.0}}, copter.now()),
        CommandResult::accepted);
    copter.fly(0.1);
  }
  const double speed = copter.flight().state().velocity_ned_mps().y();
  EXPECT_NEAR(speed, 6.0, 0.2);
  copter.fly(2.85);
  EXPECT_NEAR(copter.flight().state().velocity_ned_mps().y(), 6.0, 0.2);
  copter.fly(5.0);
  EXPECT_LT(copter.flight().state().velocity_mps.norm(), 0.1);
  EXPECT_NEAR(copter.flight().height_m(), 20.0, 0.5);
}

TEST(CopterAutopilot, AnAttitudeTargetHoldsTheHeightAndEnds) {
  Copter copter = airborne();
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(copter.autopilot().attitude_target({.pitch_rad = -0.1}, copter.now()),
              CommandResult::accepted);
    copter.fly(0.1);
  }
  EXPECT_NEAR(euler_angles(copter.flight().state().attitude).pitch_rad, -0.1, 0.02);
  EXPECT_NEAR(copter.flight().height_m(), 20.0, 0.7);
  copter.fly(8.0);
  EXPECT_LT(copter.flight().state().velocity_mps.norm(), 0.1);
  EXPECT_EQ(copter.autopilot().attitude_target({.climb = 2.0}, copter.now()),
            CommandResult::denied);
}

TEST(CopterAutopilot, ChangesSpeedAfterARepositionOnly) {
  Copter copter = airborne();
  EXPECT_EQ(copter.autopilot().change_speed(3.0), CommandResult::accepted);
  EXPECT_EQ(copter.autopilot().reposition({200.0, 0.0, -20.0}, {}, false), CommandResult::accepted);
  copter.fly(6.0);
  EXPECT_NEAR(copter.flight().state().velocity_ned_mps().x(), 10.0, 0.5);
  EXPECT_EQ(copter.autopilot().change_speed(3.0), CommandResult::accepted);
  copter.fly(6.0);
  EXPECT_NEAR(copter.flight().state().velocity_ned_mps().x(), 3.0, 0.3);
  EXPECT_EQ(copter.autopilot().change_speed(-1.0), CommandResult::denied);
}

TEST(CopterAutopilot, ReturnsAndLands) {
  Copter copter = airborne({.wind_mps = {2.0, 2.0, 0.0}, .gusts_wind_mps = 3.0, .noise = true});
  EXPECT_EQ(copter.autopilot().reposition({40.0, -30.0, -10.0}, {}, false),
            CommandResult::accepted);
  copter.fly(15.0);
  EXPECT_EQ(copter.autopilot().select_mode(CopterMode::rtl), CommandResult::accepted);
  double highest = 0.0;
  double hardest = 0.0;
  ASSERT_TRUE(copter.fly_until(
      [&] {
        highest = std::max(highest, copter.flight().height_m());
        if (copter.flight().on_ground()) {
          hardest = std::max(hardest, copter.flight().state().velocity_ned_mps().z());
        }
        return !copter.autopilot().armed();
      },
      90.0));
  EXPECT_NEAR(highest, 15.0, 1.0);
  EXPECT_LT(hardest, 1.0);
  copter.fly(1.0);
  EXPECT_TRUE(copter.flight().on_ground());
  EXPECT_LT(copter.distance_to({0.0, 0.0, -0.08}), 1.0);
  EXPECT_TRUE(copter.said("Landed"));
}

TEST(CopterAutopilot, ALostCompanionMeansReturn) {
  Copter copter = airborne({}, {.companion_failsafe = true});
  copter.autopilot().companion_heard(copter.now());
  copter.fly(4.9);
  EXPECT_EQ(copter.autopilot().mode(), CopterMode::guided);
  copter.fly(0.2);
  EXPECT_EQ(copter.autopilot().mode(), CopterMode::rtl);
  copter.autopilot().companion_heard(copter.now());
  copter.fly(1.0);
  EXPECT_EQ(copter.autopilot().mode(), CopterMode::rtl);
}

TEST(CopterAutopilot, WithoutAPositionItLandsWhereItIs) {
  Copter copter = airborne({.wind_mps = {2.0, 0.0, 0.0}});
  copter.autopilot().set_health({.position = false});
  copter.fly(0.1);
  EXPECT_EQ(copter.autopilot().mode(), CopterMode::land);
  EXPECT_TRUE(copter.said("EKF Failsafe"));
  ASSERT_TRUE(copter.fly_until([&] { return !copter.autopilot().armed(); }, 60.0));
  EXPECT_TRUE(copter.flight().on_ground());
}

TEST(CopterAutopilot, APilotFliesBySticks) {
  Copter copter{{}};
  CopterAutopilot& autopilot = copter.autopilot();
  EXPECT_EQ(autopilot.arm(), CommandResult::accepted);
  copter.fly(1.0);
  EXPECT_TRUE(copter.flight().on_ground());
  autopilot.set_sticks({.throttle = 0.65});
  copter.fly(2.5);
  EXPECT_GT(copter.flight().height_m(), 2.0);
  EXPECT_EQ(autopilot.select_mode(CopterMode::loiter), CommandResult::accepted);
  autopilot.set_sticks({.pitch = -1.0, .throttle = 0.5});  // stick forward
  copter.fly(5.0);
  EXPECT_NEAR(copter.flight().state().velocity_ned_mps().x(), 5.0, 0.5);
  autopilot.set_sticks({.throttle = 0.5});
  copter.fly(6.0);
  EXPECT_LT(copter.flight().state().velocity_mps.norm(), 0.1);
  autopilot.set_sticks({.yaw = 1.0, .throttle = 0.5});
  copter.fly(1.0);
  EXPECT_GT(copter.flight().state().rates_radps.z(), 1.0);
}

}  // namespace
}  // namespace skein::autopilot
