// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "companion_bench.hpp"
#include "skein/base/angles.hpp"

namespace skein::hil {
namespace {

EmulatorConfig quadplane() {
  EmulatorConfig config;
  config.airframe = Airframe::quadplane;
  config.origin = kOrigin;
  config.start = {100.0, 200.0, kPi / 2.0};
  config.companion_failsafe = true;
  config.airspeed_mps = 25.0;
  config.airspeed_min_mps = 17.5;
  config.airspeed_max_mps = 30.0;
  config.turn_radius_m = 80.0;
  config.wind_mps = {4.0, -3.0};
  config.turbulence_mps = 1.0;
  return config;
}

constexpr double kTakeOff_m = 40.0;

Bench on_the_ground() {
  const EmulatorConfig config = quadplane();
  ardupilot::CanLinkParams companion = Bench::params(config);
  companion.companion.take_over = ardupilot::TakeOver::from_ground;
  companion.companion.takeoff_height_m = kTakeOff_m;
  return Bench{config, companion};
}

/// Into the wind, 200 m before it.
constexpr Landing kPlace{.x_m = 150.0,
                         .y_m = 300.0,
                         .heading_rad = 2.5,
                         .approach_m = 300.0,
                         .approach_height_m = 30.0,
                         .radius_m = 90.0};

TEST(Quadplane, IsLiftedOffWhereItStandsAndFlownOnItsWings) {
  Bench bench = on_the_ground();
  bench.setpoint = {.heading_rad = kPi / 2.0, .airspeed_mps = 25.0, .height_m = 100.0};
  ASSERT_TRUE(bench.run_until(State::climbing, 20.0)) << bench.log();
  double off_m = 0.0;
  for (int i = 0; i < 600 && bench.companion().state() != State::flying; ++i) {
    bench.run(0.1);
    off_m = std::max(off_m, (bench.state().position().horizontal() - Vec2{100.0, 200.0}).norm());
  }
  ASSERT_EQ(bench.companion().state(), State::flying) << bench.log();
  EXPECT_LT(off_m, 2.0) << "straight up, in 3.6 m/s of wind";
  EXPECT_GT(bench.state().z_m, 0.9 * kTakeOff_m);
  double lowest_m = 1e3;
  for (int i = 0; i < 200; ++i) {
    bench.run(0.1);
    lowest_m = std::min(lowest_m, bench.state().z_m);
  }
  EXPECT_GT(lowest_m, 0.8 * kTakeOff_m) << "while its wings take over";
  bench.run(30.0);
  for (int i = 0; i < 20; ++i) {
    bench.run(0.5);
    EXPECT_NEAR(degrees(bench.state().heading_rad), 90.0, 4.0) << bench.log();
    EXPECT_NEAR(bench.state().airspeed_mps, 25.0, 2.0);
    EXPECT_NEAR(bench.state().z_m, 100.0, 4.0);
  }
}

/// Whichever way the wind comes to its hover.
class SetDown : public testing::TestWithParam<double> {};

TEST_P(SetDown, OnItsRotorsAndDisarmed) {
  EmulatorConfig config = quadplane();
  config.wind_mps = 6.0 * unit_vector(radians(GetParam()));
  config.airborne = true;
  config.height_m = 100.0;
  Bench bench{config};
  bench.setpoint = {.heading_rad = kPi / 2.0, .airspeed_mps = 25.0, .height_m = 100.0};
  ASSERT_TRUE(bench.run_until(State::flying, 10.0)) << bench.log();
  bench.setpoint.landing = kPlace;
  ASSERT_TRUE(bench.run_until(State::landing, 5.0)) << bench.log();
  double last_metres_s = 0.0;  // that the way from 6 m down to 2 m takes, as it believes
  for (int i = 0; i < 3000 && bench.companion().state() == State::landing; ++i) {
    bench.run(0.1);
    const double height_m = bench.state().z_m;
    if (height_m > 2.0 && height_m < 6.0) last_metres_s += 0.1;
  }
  EXPECT_EQ(bench.companion().state(), State::standing_by) << bench.log();
  bench.run(1.0);  // EXTENDED_SYS_STATE comes twice a second
  EXPECT_EQ(bench.state().phase, FlightPhase::disarmed);
  EXPECT_GT(last_metres_s, 4.0 / 1.2) << "not as fast as above, 1.5 m/s";
  const Vec2 off = bench.state().position().horizontal() - Vec2{kPlace.x_m, kPlace.y_m};
  EXPECT_LT(off.norm(), 2.0) << bench.log();
}

INSTANTIATE_TEST_SUITE_P(Winds, SetDown, testing::Values(0.0, 80.0, 150.0, 240.0, 300.0));

TEST(Quadplane, ThatIsSetDownGoesAroundAndFliesOn) {
  EmulatorConfig config = quadplane();
  config.airborne = true;
  config.height_m = 100.0;
  Bench bench{config};
  bench.setpoint = {.heading_rad = kPi / 2.0, .airspeed_mps = 25.0, .height_m = 100.0};
  ASSERT_TRUE(bench.run_until(State::flying, 10.0)) << bench.log();
  bench.setpoint.landing = kPlace;
  ASSERT_TRUE(bench.run_until(State::landing, 5.0)) << bench.log();
  for (int i = 0; i < 3000 && bench.state().z_m > 20.0; ++i) bench.run(0.1);
  ASSERT_EQ(bench.companion().state(), State::landing) << bench.log();
  bench.setpoint.landing.reset();
  ASSERT_TRUE(bench.run_until(State::flying, 3.0)) << bench.log();
  bench.run(60.0);
  EXPECT_NEAR(bench.state().z_m, 100.0, 5.0) << bench.log();
  EXPECT_NEAR(bench.state().airspeed_mps, 25.0, 3.0);
  EXPECT_EQ(bench.companion().state(), State::flying);
}

TEST(Quadplane, ItsPilotHoversAndReturnsOnRotors) {
  EmulatorConfig config = quadplane();
  config.airborne = true;
  config.height_m = 60.0;
  Bench bench{config};
  bench.setpoint = {.heading_rad = kPi / 2.0, .airspeed_mps = 25.0, .height_m = 60.0};
  ASSERT_TRUE(bench.run_until(State::flying, 10.0)) << bench.log();
  bench.run(5.0);
  bench.interfere("mode QLOITER");
  ASSERT_TRUE(bench.run_until(State::piloted, 1.0)) << bench.log();
  bench.run(40.0);
  const Vec2 there = bench.state().position().horizontal();
  bench.run(10.0);
  EXPECT_LT((bench.state().position().horizontal() - there).norm(), 1.5) << "in gusts of 1 m/s";
  EXPECT_NEAR(bench.state().z_m, 60.0, 1.0);
  bench.interfere("mode QRTL");
  bench.run(150.0);
  EXPECT_EQ(bench.state().phase, FlightPhase::disarmed) << bench.state().z_m;
}

TEST(Quadplane, WhosePilotSwitchesToManualInHoverFallsOffItsRotors) {
  EmulatorConfig config = quadplane();
  config.airborne = true;
  config.height_m = 100.0;
  Bench bench{config};
  bench.setpoint = {.heading_rad = kPi / 2.0, .airspeed_mps = 25.0, .height_m = 100.0};
  ASSERT_TRUE(bench.run_until(State::flying, 10.0)) << bench.log();
  bench.interfere("mode QLOITER");
  bench.run(40.0);
  EXPECT_NEAR(bench.state().z_m, 100.0, 2.0);
  bench.interfere("mode MANUAL");
  bench.run(3.0);
  EXPECT_LT(bench.state().z_m, 90.0);
}

TEST(Quadplane, DoesNotArmInAModeThatBringsItDown) {
  auto controller = EmulatedFlightController::make(quadplane(), Instant{}).value();
  controller.step(at_seconds(12.0));
  ASSERT_TRUE(controller.interfere("mode QRTL", at_seconds(12.0)));
  EXPECT_FALSE(controller.interfere("arm", at_seconds(12.0)));
  ASSERT_TRUE(controller.interfere("mode QLOITER", at_seconds(12.0)));
  EXPECT_TRUE(controller.interfere("arm", at_seconds(12.0)));
}

TEST(Quadplane, AloneIsStartedInAModeOfItsRotors) {
  EmulatorConfig config = quadplane();
  config.airborne = true;
  config.height_m = 100.0;
  config.mode = "QLOITER";
  EXPECT_TRUE(check(config));
  config.airframe = Airframe::plane;
  EXPECT_FALSE(check(config));
}

}  // namespace
}  // namespace skein::hil
