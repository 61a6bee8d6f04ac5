// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "emulator_test.hpp"

namespace skein::hil {
namespace {

using mavlink::Command;
using mavlink::CommandResult;

constexpr std::uint32_t kStabilize = 0;
constexpr std::uint32_t kGuided = 4;
constexpr std::uint32_t kLoiter = 5;
constexpr std::uint32_t kRtl = 6;

EmulatorConfig copter() {
  EmulatorConfig config;
  config.airframe = Airframe::copter;
  config.airspeed_mps = 10.0;
  config.origin = {31.5, 105.0, 480.0};
  config.start = {100.0, 200.0, kPi / 2.0};
  config.noise = false;
  return config;
}
EmulatorConfig hovering() {
  EmulatorConfig config = copter();
  config.airborne = true;
  config.height_m = 20.0;
  return config;
}

mavlink::LocalPositionNed place(const Companion& c) {
  return c.last<mavlink::LocalPositionNed>().value();
}
void watch(Companion& c) {
  EXPECT_EQ(c.stream(mavlink::LocalPositionNed::kDefinition.id, 20.0), CommandResult::accepted);
  EXPECT_EQ(c.stream(mavlink::Attitude::kDefinition.id, 20.0), CommandResult::accepted);
  EXPECT_EQ(c.stream(mavlink::Heartbeat::kDefinition.id, 20.0), CommandResult::accepted);
  c.run(0.1);
}
mavlink::SetPositionTargetLocalNed target(std::uint16_t mask) {
  mavlink::SetPositionTargetLocalNed t;
  t.coordinate_frame = static_cast<std::uint8_t>(mavlink::Frame::local_ned);
  t.type_mask = mask;
  return t;
}

TEST(EmulatedCopter, TellsNothingUnaskedButItsHeartbeat) {
  Companion c{copter()};
  c.run(5.5);
  EXPECT_EQ(c.last<mavlink::Heartbeat>().value().type, 13);
  EXPECT_EQ(c.mode_now(), kStabilize);
  EXPECT_FALSE(c.armed());
  for (const mavlink::Packet& packet : c.packets()) {
    EXPECT_TRUE(packet.id == mavlink::Heartbeat::kDefinition.id ||
                packet.id == mavlink::Statustext::kDefinition.id)
        << packet.id;
  }
  EXPECT_EQ(c.stream(mavlink::Attitude::kDefinition.id, 200.0), CommandResult::accepted);
  EXPECT_EQ(c.stream(mavlink::Attitude::kDefinition.id, 400.0), CommandResult::denied);
}

TEST(EmulatedCopter, TakesOffFliesAndLands) {
  Companion c{copter()};
  watch(c);
  mavlink::CommandLong take_off;
  take_off.command = static_cast<std::uint16_t>(Command::nav_takeoff);
  take_off.param7 = 15.0F;
  EXPECT_EQ(c.command(take_off), CommandResult::failed) << "neither GUIDED nor armed";
  EXPECT_EQ(c.mode(kGuided), CommandResult::accepted);
  EXPECT_EQ(c.command(Command::component_arm_disarm, 1.0F), CommandResult::accepted);
  EXPECT_EQ(c.command(take_off), CommandResult::accepted);
  ASSERT_TRUE(c.run_until([&] { return place(c).z < -14.5F; }, 20.0));
  c.run(1.0);  // before it is up it takes no setpoints

  auto there = target(0xDF8);
  there.x = 20.0F;
  there.y = -10.0F;
  there.z = -20.0F;
  c.send(there);
  c.run(15.0);
  EXPECT_NEAR(static_cast<double>(place(c).x), 20.0, 0.5);
  EXPECT_NEAR(static_cast<double>(place(c).y), -10.0, 0.5);
  EXPECT_NEAR(static_cast<double>(place(c).z), -20.0, 0.5);

  EXPECT_EQ(c.command(Command::nav_return_to_launch), CommandResult::accepted);
  ASSERT_TRUE(c.run_until([&] { return !c.armed(); }, 90.0));
  EXPECT_NEAR(static_cast<double>(place(c).x), 0.0, 1.0);
  EXPECT_NEAR(static_cast<double>(place(c).y), 0.0, 1.0);
}

TEST(EmulatedCopter, AVelocityThatIsNotRenewedEndsAfterThreeSeconds) {
  Companion c{hovering()};
  watch(c);
  EXPECT_EQ(c.mode_now(), kGuided);
  EXPECT_TRUE(c.armed());
  c.run(2.0);
  EXPECT_NEAR(static_cast<double>(place(c).z), -20.0, 0.3) << "it hovers";
  auto velocity = target(0xDC7);
  velocity.vx = 6.0F;
  c.send(velocity);
  c.run(2.9);
  EXPECT_NEAR(static_cast<double>(place(c).vx), 6.0, 0.5);
  c.run(4.0);
  EXPECT_NEAR(static_cast<double>(place(c).vx), 0.0, 0.3);
  EXPECT_GT(place(c).x, 15.0F);
}

TEST(EmulatedCopter, FollowsAMovingPointRoundACircle) {
  Companion c{hovering()};
  watch(c);
  double worst = 0.0;
  for (int i = 0; i < 300; ++i) {
    const double angle = 0.2 * 0.1 * i;
    auto point = target(0xDC0);
    point.x = static_cast<float>(30.0 * std::sin(angle));
    point.y = static_cast<float>(30.0 - 30.0 * std::cos(angle));
    point.z = -20.0F;
    point.vx = static_cast<float>(6.0 * std::cos(angle));
    point.vy = static_cast<float>(6.0 * std::sin(angle));
    c.send(point);
    c.run(0.1);
    if (i < 100) continue;
    const auto at = place(c);
    worst = std::max(
        worst,
        std::abs(std::hypot(static_cast<double>(at.x), static_cast<double>(at.y) - 30.0) - 30.0));
  }
  EXPECT_LT(worst, 1.5);
}

TEST(EmulatedCopter, RepositionsAndHoldsAnAttitude) {
  Companion c{hovering()};
  watch(c);
  const auto origin = MissionOrigin::make({31.5, 105.0, 480.0}).value();
  const Wgs84 goal = origin.to_wgs84({130.0, 200.0, 25.0});
  mavlink::CommandInt there;
  there.command = static_cast<std::uint16_t>(Command::do_reposition);
  there.frame = static_cast<std::uint8_t>(mavlink::Frame::global_relative_alt_int);
  there.x = static_cast<std::int32_t>(std::lround(goal.latitude_deg * 1e7));
  there.y = static_cast<std::int32_t>(std::lround(goal.longitude_deg * 1e7));
  there.z = 25.0F;
  there.param1 = -1.0F;
  EXPECT_EQ(c.command(there), CommandResult::accepted);
  c.run(15.0);
  EXPECT_NEAR(static_cast<double>(place(c).y), 30.0, 0.5);
  EXPECT_NEAR(static_cast<double>(place(c).z), -25.0, 0.5);
  mavlink::SetAttitudeTarget tilt;
  const Eigen::Quaterniond q = attitude_from({.roll_rad = radians(10.0)});
  tilt.q = {static_cast<float>(q.w()), static_cast<float>(q.x()), static_cast<float>(q.y()),
            static_cast<float>(q.z())};
  tilt.thrust = 0.5F;
  tilt.type_mask =
      mavlink::ignore_roll_rate | mavlink::ignore_pitch_rate | mavlink::ignore_body_yaw_rate;
  c.send(tilt);
  c.run(2.0);
  EXPECT_NEAR(degrees(static_cast<double>(c.last<mavlink::Attitude>()->roll)), 10.0, 1.0);
  EXPECT_NEAR(static_cast<double>(place(c).z), -25.0, 1.0);
  c.run(3.0);
  EXPECT_NEAR(degrees(static_cast<double>(c.last<mavlink::Attitude>()->roll)), 0.0, 9.0);
}

TEST(EmulatedCopter, ALostCompanionAndAPilotAndARestart) {
  EmulatorConfig config = hovering();
  config.companion_failsafe = true;
  Companion c{config};
  watch(c);
  c.run(2.0);
  c.interfere("mode LOITER");
  c.run(3.0);
  EXPECT_EQ(c.mode_now(), kLoiter);
  EXPECT_NEAR(static_cast<double>(place(c).z), -20.0, 0.5);
  EXPECT_FALSE(c.controller().interfere("mode MANUAL", c.now()).ok()) << "a plane's";
  EXPECT_EQ(c.mode(kGuided), CommandResult::accepted);
  c.heartbeats = false;
  c.run(5.5);
  EXPECT_EQ(c.mode_now(), kRtl);
  c.heartbeats = true;
  c.interfere("mode LOITER");
  c.interfere("reboot");
  c.run(5.5);
  EXPECT_EQ(c.mode_now(), kLoiter);
  EXPECT_TRUE(c.armed());
  watch(c);
  EXPECT_LT(place(c).z, -10.0F);
}

TEST(EmulatedCopter, FliesNoFasterThanItsAirframe) {
  EmulatorConfig config = copter();
  config.airspeed_mps = 50.0;
  EXPECT_EQ(EmulatedFlightController::make(config, Instant{}).error().message,
            "speed 50 m/s: the copter flies at 1 to 10");
}

}  // namespace
}  // namespace skein::hil
