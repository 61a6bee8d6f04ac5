// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "companion_bench.hpp"
#include "skein/base/angles.hpp"

/// A companion that must say a Remote ID, and an autopilot with a transmitter that wants to be
/// told.
namespace skein::hil {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

EmulatorConfig on_ground() {
  EmulatorConfig config;
  config.airframe = Airframe::quadplane;
  config.origin = kOrigin;
  config.start = {100.0, 200.0, kPi / 2.0};
  config.companion_failsafe = true;
  config.airspeed_mps = 25.0;
  config.airspeed_min_mps = 17.5;
  config.airspeed_max_mps = 30.0;
  config.turn_radius_m = 80.0;
  config.remote_id = true;
  return config;
}

ardupilot::CanLinkParams params_of(const EmulatorConfig& config, const std::string& uas_id) {
  auto params = Bench::params(config);
  params.companion.take_over = ardupilot::TakeOver::from_ground;
  params.companion.takeoff_height_m = 40.0;
  params.companion.unix_us = 1'700'000'000'000'000;
  params.companion.remote_id.uas_id = uas_id;
  params.companion.remote_id.operator_id = "SWE1234567890abc";
  params.companion.remote_id.required = !uas_id.empty();
  return params;
}

TEST(RemoteIdOnTheBus, AVehicleThatSaysWhoItIsIsArmedAndFlies) {
  const EmulatorConfig config = on_ground();
  Bench bench{config, params_of(config, "1ABCD0123456789")};
  ASSERT_TRUE(bench.run_until(State::climbing, 90.0)) << bench.log();
  EXPECT_EQ(*bench.companion().facts(bench.now())->remote_id, "");
}

TEST(RemoteIdOnTheBus, WithoutItsTransmitterItStaysOnTheGroundAndSaysWhy) {
  const EmulatorConfig config = on_ground();
  Bench bench{config, params_of(config, "1ABCD0123456789")};
  bench.interfere("remote-id off");
  EXPECT_FALSE(bench.run_until(State::climbing, 90.0));
  EXPECT_EQ(bench.companion().state(), State::standing_by) << bench.log();
  EXPECT_THAT(*bench.companion().facts(bench.now())->remote_id,
              HasSubstr("no transmitter is heard"));
  // The autopilot itself, too, would not arm.
  EXPECT_THAT(bench.log(), HasSubstr("ARM_STATUS not available"));
  bench.interfere("remote-id on");
  EXPECT_TRUE(bench.run_until(State::climbing, 30.0)) << bench.log();
}

TEST(RemoteIdOnTheBus, AnAutopilotThatIsNotToldWhoItIsDoesNotArm) {
  const EmulatorConfig config = on_ground();
  Bench bench{config, params_of(config, "")};
  EXPECT_FALSE(bench.run_until(State::climbing, 60.0));
  EXPECT_THAT(bench.log(), HasSubstr("OpenDroneID"));
  EXPECT_THAT(bench.log(), Not(HasSubstr("no transmitter is heard"))) << "it was not asked for";
}

TEST(RemoteIdOnTheBus, ATransmitterThatFailsInTheAirLandsNobody) {
  const EmulatorConfig config = on_ground();
  Bench bench{config, params_of(config, "1ABCD0123456789")};
  bench.setpoint = {.heading_rad = kPi / 2.0, .airspeed_mps = 25.0, .height_m = 100.0};
  ASSERT_TRUE(bench.run_until(State::flying, 150.0)) << bench.log();
  bench.interfere("remote-id off");
  bench.run(20.0);
  EXPECT_EQ(bench.companion().state(), State::flying);
}

}  // namespace
}  // namespace skein::hil
