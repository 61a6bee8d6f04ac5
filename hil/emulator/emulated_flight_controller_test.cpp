// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/emulated_flight_controller.hpp"

#include <gtest/gtest.h>

#include "emulator_test.hpp"

namespace skein::hil {
namespace {

using mavlink::Command;
using mavlink::CommandResult;

constexpr std::uint32_t kManual = 0;
constexpr std::uint32_t kRtl = 11;
constexpr std::uint32_t kLoiter = 12;
constexpr std::uint32_t kGuided = 15;

constexpr std::uint8_t kRollOnly = 0xC6;
constexpr std::uint8_t kRollAndPitch = 0x46;

double course_deg(const Companion& c) {
  const auto at = c.last<mavlink::GlobalPositionInt>().value();
  return degrees(std::atan2(static_cast<double>(at.vy), static_cast<double>(at.vx)));
}
double height_m(const Companion& c) {
  return c.last<mavlink::GlobalPositionInt>().value().relative_alt * 1e-3;
}
double airspeed_mps(const Companion& c) {
  return static_cast<double>(c.last<mavlink::VfrHud>().value().airspeed);
}
double roll_deg(const Companion& c) {
  return degrees(static_cast<double>(c.last<mavlink::Attitude>().value().roll));
}
/// Horizontal, from a place north and east of the origin.
double distance_m(const Companion& c, double north_m, double east_m) {
  const auto origin = MissionOrigin::make({31.5, 105.0, 480.0}).value();
  const auto at = c.last<mavlink::GlobalPositionInt>().value();
  const auto enu = origin.to_enu({at.lat * 1e-7, at.lon * 1e-7, at.alt * 1e-3});
  return std::hypot(enu.y() - north_m, enu.x() - east_m);
}
/// A command with a place, height above home.
mavlink::CommandInt to_place(Command command, double north_m, double east_m, double up_m) {
  const auto origin = MissionOrigin::make({31.5, 105.0, 480.0}).value();
  const Wgs84 place = origin.to_wgs84({east_m, north_m, up_m});
  mavlink::CommandInt c;
  c.command = static_cast<std::uint16_t>(command);
  c.frame = static_cast<std::uint8_t>(mavlink::Frame::global_relative_alt_int);
  c.x = static_cast<std::int32_t>(std::lround(place.latitude_deg * 1e7));
  c.y = static_cast<std::int32_t>(std::lround(place.longitude_deg * 1e7));
  c.z = static_cast<float>(up_m);
  return c;
}
/// Fast enough to see what it does.
void watch(Companion& c) {
  EXPECT_EQ(c.stream(mavlink::Attitude::kDefinition.id, 20.0), CommandResult::accepted);
  EXPECT_EQ(c.stream(mavlink::GlobalPositionInt::kDefinition.id, 20.0), CommandResult::accepted);
  EXPECT_EQ(c.stream(mavlink::VfrHud::kDefinition.id, 10.0), CommandResult::accepted);
  EXPECT_EQ(c.stream(mavlink::Heartbeat::kDefinition.id, 20.0), CommandResult::accepted);
  c.run(0.1);
}

TEST(EmulatedFlightController, IsANodeOnTheBus) {
  Companion c{in_flight()};
  c.run(4.0);
  const auto* node = c.node().find(10);
  ASSERT_NE(node, nullptr);
  EXPECT_TRUE(node->online);
  EXPECT_EQ(node->status.uptime_sec, 4U);
  EXPECT_EQ(node->status.health, dronecan::Health::ok);
  ASSERT_TRUE(node->info);
  const auto& name = node->info->name;
  EXPECT_EQ((std::string{name.begin(), name.end()}), "org.skein.fc");
  EXPECT_EQ(c.node().reassembly().broken(), 0U);
  // A second one never has the same identity.
  EmulatorConfig other = in_flight();
  other.system_id = other.companion_system = 2;
  Companion d{other};
  d.run(4.0);
  EXPECT_NE(node->info->hardware_version.unique_id,
            d.node().find(10)->info->hardware_version.unique_id);
}

TEST(EmulatedFlightController, StreamsAsAPlaneDoesUnasked) {
  Companion c{in_flight()};
  c.run(10.5);
  EXPECT_EQ(c.parser().bad_crc, 0U);
  EXPECT_EQ(c.parser().lost, 0U);
  EXPECT_EQ(c.parser().unknown, 0U);
  EXPECT_EQ(c.parser().skipped_bytes, 6U) << "the greeting to radios";
  EXPECT_NEAR(static_cast<double>(c.count<mavlink::Heartbeat>()), 11.0, 1.0);
  EXPECT_NEAR(static_cast<double>(c.count<mavlink::Attitude>()), 11.0, 1.0);
  EXPECT_NEAR(static_cast<double>(c.count<mavlink::GlobalPositionInt>()), 11.0, 1.0);
  EXPECT_EQ(c.count<mavlink::AutopilotVersion>(), 0U);
  const auto heartbeat = c.last<mavlink::Heartbeat>().value();
  EXPECT_EQ(heartbeat.custom_mode, kGuided);
  EXPECT_EQ(heartbeat.type, 1);
  EXPECT_EQ(heartbeat.autopilot, 3);
  EXPECT_EQ(heartbeat.base_mode, 217) << "as recorded from ArduPlane";
  EXPECT_EQ(heartbeat.system_status, 4);
  const auto status = c.last<mavlink::SysStatus>().value();
  EXPECT_NE(status.onboard_control_sensors_health & mavlink::sensor_prearm_check, 0U);
}

TEST(EmulatedFlightController, TellsWhereItIs) {
  EmulatorConfig config = in_flight();
  config.start = {2200.0, 2000.0, kPi / 2.0};
  config.hold_until = at_seconds(2.0);
  Companion c{config};
  watch(c);
  EXPECT_LT(distance_m(c, 2000.0, 2200.0), 0.05);
  EXPECT_NEAR(height_m(c), 300.0, 0.01);
  const auto global = c.last<mavlink::GlobalPositionInt>().value();
  EXPECT_EQ(global.alt, 780000);
  EXPECT_EQ(global.vx, 5000);
  EXPECT_EQ(global.hdg % 36000, 0);
  // From where the filter began, not from the mission's origin.
  EXPECT_EQ(c.command(Command::request_message, 32.0F), CommandResult::accepted);
  const auto local = c.last<mavlink::LocalPositionNed>().value();
  EXPECT_NEAR(static_cast<double>(local.x), 0.0, 0.01);
  EXPECT_NEAR(static_cast<double>(local.z), -300.0, 0.01);
  // It has stood still until now.
  c.run(1.9);
  EXPECT_LT(distance_m(c, 2000.0, 2200.0), 30.0);
  c.run(1.0);
  EXPECT_GT(distance_m(c, 2000.0, 2200.0), 40.0);
}

TEST(EmulatedFlightController, AnswersWhoItIsAndWhatTimeItIs) {
  EmulatorConfig config = in_flight();
  config.unix_us = 1'700'000'000'000'000;
  Companion c{config};
  c.run(1.0);
  EXPECT_EQ(c.command(Command::request_message, 148.0F), CommandResult::accepted);
  EXPECT_EQ(c.last<mavlink::AutopilotVersion>().value().flight_sw_version, 0x040603FFU);
  EXPECT_EQ(c.command(Command::request_autopilot_capabilities, 1.0F), CommandResult::accepted);
  EXPECT_EQ(c.count<mavlink::AutopilotVersion>(), 2U);
  EXPECT_EQ(c.command(Command::request_message, 9999.0F), CommandResult::failed);
  mavlink::Timesync question;
  question.ts1 = 123456789;
  c.send(question);
  c.run(0.1);
  const auto answer = c.last<mavlink::Timesync>().value();
  EXPECT_EQ(answer.ts1, 123456789);
  EXPECT_NEAR(static_cast<double>(answer.tc1) * 1e-9, c.seconds(), 0.11);
  const auto time = c.last<mavlink::SystemTime>().value();
  EXPECT_NEAR(static_cast<double>(time.time_unix_usec) * 1e-6 - 1.7e9, c.seconds(), 1.1);
}

TEST(EmulatedFlightController, IntervalsEndAtFourFifthsOfTheLoop) {
  Companion c{in_flight()};
  EXPECT_EQ(c.stream(mavlink::Attitude::kDefinition.id, 50.0), CommandResult::denied);
  EXPECT_EQ(c.stream(mavlink::Attitude::kDefinition.id, 25.0), CommandResult::accepted);
  EXPECT_EQ(c.command(Command::set_message_interval, 9999.0F, 1e5F), CommandResult::failed);
  c.run(1.0);
  c.forget();
  c.run(10.0);
  EXPECT_NEAR(static_cast<double>(c.count<mavlink::Attitude>()), 250.0, 2.0);
  EXPECT_EQ(c.command(Command::get_message_interval, 30.0F), CommandResult::accepted);
  EXPECT_EQ(c.last<mavlink::MessageInterval>().value().interval_us, 40000);
  EXPECT_EQ(c.command(Command::set_message_interval, 30.0F, -1.0F), CommandResult::accepted);
  c.run(0.1);
  c.forget();
  c.run(3.0);
  EXPECT_EQ(c.count<mavlink::Attitude>(), 0U);
  EXPECT_EQ(c.parser().lost, 0U);
}

TEST(EmulatedFlightController, HearsOnlyItsCompanionOnItsPort) {
  EmulatorConfig config = in_flight();
  Companion stranger{config, 43};
  stranger.run(1.0);
  EXPECT_EQ(stranger.mode(kLoiter), std::nullopt);
  config.serial_id = 1;
  Companion c{config};
  c.run(1.0);
  EXPECT_EQ(c.mode(kLoiter), CommandResult::accepted);
  dronecan::TunnelParams wrong;
  wrong.remote_node = 10;
  wrong.serial_id = 0;
  c.port() = dronecan::TunnelPort{wrong, c.now()};
  EXPECT_EQ(c.mode(kGuided), std::nullopt);
  // Commands to another system, or another component of it, are not its business.
  Companion d{in_flight()};
  mavlink::CommandLong command;
  command.command = static_cast<std::uint16_t>(Command::do_set_mode);
  command.param1 = 1.0F;
  command.param2 = 12.0F;
  command.target_system = 9;
  d.send(command);
  d.run(1.0);
  EXPECT_EQ(d.count<mavlink::CommandAck>(), 0U);
}

TEST(EmulatedFlightController, ArmsOnTheGroundAndSaysWhyNot) {
  EmulatorConfig config = in_flight();
  config.airborne = false;
  Companion c{config};
  c.run(1.5);
  EXPECT_EQ(c.mode_now(), kManual);
  EXPECT_FALSE(c.armed());
  c.interfere("position lost");
  c.run(1.1);
  EXPECT_TRUE(c.said("PreArm: Need Position Estimate"));
  EXPECT_EQ(
      c.last<mavlink::SysStatus>()->onboard_control_sensors_health & mavlink::sensor_prearm_check,
      0U);
  EXPECT_EQ(c.command(Command::component_arm_disarm, 1.0F), CommandResult::failed);
  EXPECT_TRUE(c.said("Arm: Need Position Estimate"));
  EXPECT_EQ(c.mode(kGuided), CommandResult::failed);
  c.interfere("position good");
  c.run(1.1);
  EXPECT_NE(
      c.last<mavlink::SysStatus>()->onboard_control_sensors_health & mavlink::sensor_prearm_check,
      0U);
  // So has the mode, in which the failsafe leaves it.
  EXPECT_EQ(c.mode(kRtl), CommandResult::accepted);
  c.run(1.1);
  EXPECT_EQ(
      c.last<mavlink::SysStatus>()->onboard_control_sensors_health & mavlink::sensor_prearm_check,
      0U);
  EXPECT_EQ(c.command(Command::component_arm_disarm, 1.0F), CommandResult::failed);
  EXPECT_TRUE(c.said("Arm: RTL mode not armable"));
  EXPECT_EQ(c.mode(kManual), CommandResult::accepted);
  // The bus has a word, too.
  c.node().set_status(dronecan::Health::warning, dronecan::Mode::operational);
  c.run(1.1);
  EXPECT_EQ(c.command(Command::component_arm_disarm, 1.0F), CommandResult::failed);
  EXPECT_TRUE(c.said("Arm: DroneCAN: Node 42 unhealthy!"));
  c.node().set_status(dronecan::Health::ok, dronecan::Mode::operational);
  c.run(1.1);
  EXPECT_EQ(c.command(Command::component_arm_disarm, 1.0F), CommandResult::accepted);
  c.run(1.1);
  EXPECT_TRUE(c.armed());
  EXPECT_TRUE(c.said("Throttle armed"));
  EXPECT_EQ(c.command(Command::component_arm_disarm, 0.0F), CommandResult::accepted);
  c.run(1.1);
  EXPECT_FALSE(c.armed());
}

TEST(EmulatedFlightController, DoesNotDisarmInFlightUnlessForced) {
  Companion c{in_flight()};
  EXPECT_EQ(c.command(Command::component_arm_disarm, 0.0F), CommandResult::failed);
  EXPECT_EQ(c.command(Command::component_arm_disarm, 0.0F, 21196.0F), CommandResult::accepted);
}

TEST(EmulatedFlightController, TakesOff) {
  EmulatorConfig config = in_flight();
  config.airborne = false;
  Companion c{config};
  EXPECT_EQ(c.mode(13), CommandResult::accepted);
  EXPECT_EQ(c.command(Command::component_arm_disarm, 1.0F), CommandResult::accepted);
  EXPECT_TRUE(c.run_until([&] { return height_m(c) > 50.0; }, 40.0));
  EXPECT_EQ(c.mode(kGuided), CommandResult::accepted);
}

TEST(EmulatedFlightController, RollCommandsTurnItAtItsHeight) {
  Companion c{in_flight()};
  watch(c);
  for (int i = 0; i < 100; ++i) {
    c.hold_roll(radians(25.0), 0.0, kRollOnly);
    c.run(0.05);
  }
  EXPECT_NEAR(roll_deg(c), 25.0, 1.0);
  EXPECT_NEAR(height_m(c), 300.0, 3.0);
  // g tan(25 deg) / 50 m/s for five seconds, less the time to roll in.
  EXPECT_NEAR(course_deg(c), 24.0, 3.0);
  // Three seconds after the last it goes back to its orbit.
  c.run(2.8);
  EXPECT_NEAR(roll_deg(c), 25.0, 1.0);
  c.run(1.2);
  EXPECT_GT(std::abs(roll_deg(c) - 25.0), 10.0);
}

TEST(EmulatedFlightController, AWholeAttitudeSetsThePitchToo) {
  Companion c{in_flight()};
  watch(c);
  for (int i = 0; i < 100; ++i) {
    c.hold_roll(radians(10.0), radians(-5.0), kRollAndPitch);
    c.run(0.05);
  }
  EXPECT_NEAR(degrees(static_cast<double>(c.last<mavlink::Attitude>()->pitch)), -5.0, 1.0);
  EXPECT_LT(height_m(c), 285.0);
}

TEST(EmulatedFlightController, TheBankLimitIsThatOfItsCircle) {
  EmulatorConfig config = in_flight();
  config.turn_radius_m = 300.0;
  Companion c{config};
  watch(c);
  for (int i = 0; i < 60; ++i) {
    c.hold_roll(radians(80.0), 0.0, kRollOnly);
    c.run(0.05);
  }
  EXPECT_NEAR(roll_deg(c), degrees(std::atan(2500.0 / (kGravity_mps2 * 300.0))) + 5.0, 1.0);
}

TEST(EmulatedFlightController, RepositionsAndIgnoresItAfterAHeading) {
  Companion c{in_flight()};
  watch(c);
  mavlink::CommandInt there = to_place(Command::do_reposition, 1500.0, 500.0, 320.0);
  there.param2 = 1.0F;
  there.param3 = 200.0F;
  EXPECT_EQ(c.command(there), CommandResult::accepted);
  c.run(60.0);
  EXPECT_NEAR(distance_m(c, 1500.0, 500.0), 200.0, 10.0);
  EXPECT_NEAR(height_m(c), 320.0, 3.0);

  mavlink::CommandInt heading;
  heading.command = static_cast<std::uint16_t>(Command::guided_change_heading);
  heading.param2 = 90.0F;
  heading.param3 = 12.0F;
  EXPECT_EQ(c.command(heading), CommandResult::accepted);
  c.run(15.0);
  EXPECT_NEAR(course_deg(c), 90.0, 1.0);
  EXPECT_EQ(c.command(there), CommandResult::accepted) << "stored, not flown";
  EXPECT_EQ(c.mode(kGuided), CommandResult::accepted) << "nor does this enter it anew";
  c.run(12.0);
  EXPECT_NEAR(course_deg(c), 90.0, 1.0);
  EXPECT_EQ(c.mode(kLoiter), CommandResult::accepted);
  EXPECT_EQ(c.mode(kGuided), CommandResult::accepted);
  EXPECT_EQ(c.command(there), CommandResult::accepted);
  c.run(60.0);
  EXPECT_NEAR(distance_m(c, 1500.0, 500.0), 200.0, 10.0);
}

TEST(EmulatedFlightController, HeadingsHaveArduPlanesLimits) {
  Companion c{in_flight()};
  watch(c);
  EXPECT_EQ(c.command(Command::guided_change_heading, 0.0F, 360.0F, 5.0F), CommandResult::denied);
  EXPECT_EQ(c.command(Command::guided_change_heading, 2.0F, 90.0F, 5.0F), CommandResult::denied);
  // Without an acceleration it may turn with 0.05 m/s^2, which is hardly.
  EXPECT_EQ(c.command(Command::guided_change_heading, 0.0F, 90.0F), CommandResult::accepted);
  c.run(10.0);
  EXPECT_LT(course_deg(c), 5.0);
}

TEST(EmulatedFlightController, SpeedsAndHeights) {
  Companion c{in_flight()};
  watch(c);
  EXPECT_EQ(c.command(Command::guided_change_heading, 0.0F, 0.0F, 10.0F), CommandResult::accepted);
  EXPECT_EQ(c.command(Command::do_change_speed, 0.0F, 55.0F, -1.0F), CommandResult::accepted);
  EXPECT_EQ(c.command(Command::do_change_speed, 0.0F, 90.0F, -1.0F), CommandResult::failed);
  c.run(12.0);
  EXPECT_NEAR(airspeed_mps(c), 55.0, 0.7);
  EXPECT_EQ(c.command(Command::guided_change_speed, 0.0F, 45.0F), CommandResult::accepted);
  EXPECT_EQ(c.command(Command::guided_change_speed, 0.0F, 20.0F), CommandResult::denied);
  EXPECT_EQ(c.command(Command::guided_change_speed, 1.0F, 45.0F), CommandResult::denied);
  c.run(12.0);
  EXPECT_NEAR(airspeed_mps(c), 45.0, 0.7);
  EXPECT_EQ(c.command(Command::do_change_speed, 0.0F, 55.0F, -1.0F), CommandResult::accepted);
  c.run(8.0);
  EXPECT_NEAR(airspeed_mps(c), 45.0, 0.7) << "outranked";

  EXPECT_EQ(c.command(Command::do_change_altitude, 320.0F, 3.0F), CommandResult::accepted);
  c.run(15.0);
  EXPECT_NEAR(height_m(c), 320.0, 2.0);
  mavlink::CommandInt height;
  height.command = static_cast<std::uint16_t>(Command::guided_change_altitude);
  height.frame = static_cast<std::uint8_t>(mavlink::Frame::global_relative_alt);
  EXPECT_EQ(c.command(height), CommandResult::denied) << "zero";
  height.z = 350.0F;
  height.param3 = 3.0F;
  EXPECT_EQ(c.command(height), CommandResult::accepted);
  c.run(10.0);
  EXPECT_LT(height_m(c), 325.0) << "with a rate it hardly climbs";
  height.param3 = 0.0F;
  EXPECT_EQ(c.command(height), CommandResult::accepted);
  c.run(20.0);
  EXPECT_NEAR(height_m(c), 350.0, 2.0);
  EXPECT_EQ(c.mode(kRtl), CommandResult::accepted);
  EXPECT_EQ(c.command(Command::do_change_speed, 0.0F, 55.0F, -1.0F), CommandResult::failed);
}

TEST(EmulatedFlightController, OnlyTheAltitudeOfAGlobalTargetIsTaken) {
  Companion c{in_flight()};
  watch(c);
  EXPECT_EQ(c.command(Command::guided_change_heading, 0.0F, 0.0F, 10.0F), CommandResult::accepted);
  mavlink::SetPositionTargetGlobalInt target;
  target.coordinate_frame = static_cast<std::uint8_t>(mavlink::Frame::global_relative_alt_int);
  target.alt = 320.0F;
  target.type_mask = mavlink::ignore_z;
  c.send(target);
  c.run(15.0);
  EXPECT_NEAR(height_m(c), 320.0, 2.0);
  EXPECT_NEAR(course_deg(c), 0.0, 1.0);
}

TEST(EmulatedFlightController, ALostCompanionMeansReturn) {
  EmulatorConfig config = in_flight();
  config.companion_failsafe = true;
  Companion c{config};
  watch(c);
  c.run(5.0);
  EXPECT_EQ(c.mode_now(), kGuided);
  c.heartbeats = false;
  const double silent_from = c.seconds();
  ASSERT_TRUE(c.run_until([&] { return c.mode_now() == kRtl; }, 10.0));
  EXPECT_GT(c.seconds() - silent_from, 4.0);
  EXPECT_LT(c.seconds() - silent_from, 5.3);
  c.heartbeats = true;
  c.run(3.0);
  EXPECT_EQ(c.mode_now(), kRtl) << "its heartbeat does not end it";
  mavlink::CommandInt there = to_place(Command::do_reposition, 500.0, 0.0, 300.0);
  EXPECT_EQ(c.command(there), CommandResult::failed) << "without leave to change the mode";
  there.param2 = 1.0F;
  EXPECT_EQ(c.command(there), CommandResult::accepted);
  c.run(0.2);
  EXPECT_EQ(c.mode_now(), kGuided);
}

TEST(EmulatedFlightController, WithoutTheFailsafeItFliesOn) {
  Companion c{in_flight()};
  watch(c);
  c.heartbeats = false;
  c.run(10.0);
  EXPECT_EQ(c.mode_now(), kGuided);
}

TEST(EmulatedFlightController, ThePilotsSwitchWins) {
  Companion c{in_flight()};
  watch(c);
  c.interfere("mode RTL");
  c.run(0.2);
  EXPECT_EQ(c.mode_now(), kRtl);
  c.hold_roll(radians(25.0), 0.0, kRollOnly);
  EXPECT_EQ(c.command(Command::guided_change_heading, 0.0F, 90.0F, 5.0F), CommandResult::failed);
  for (const char* line :
       {"", "mode", "mode NONE", "silent", "silent maybe", "reboot now", "fly"}) {
    EXPECT_FALSE(c.controller().interfere(line, c.now()).ok()) << line;
  }
}

TEST(EmulatedFlightController, RestartsAndFliesOn) {
  Companion c{in_flight()};
  watch(c);
  c.run(3.0);
  c.interfere("reboot");
  const double from = c.seconds();
  c.run(1.15);
  c.forget();
  const std::uint64_t before = c.frames();
  ASSERT_TRUE(c.run_until([&] { return c.frames() > before; }, 3.0));
  EXPECT_NEAR(c.seconds() - from, 1.2, 0.05);
  ASSERT_TRUE(c.run_until([&] { return c.count<mavlink::Heartbeat>() > 0; }, 10.0));
  EXPECT_NEAR(c.seconds() - from, 5.2, 0.05);
  EXPECT_EQ(c.mode_now(), kLoiter);
  EXPECT_TRUE(c.armed());
  EXPECT_LT(c.node().find(10)->status.uptime_sec, 7U);
  EXPECT_EQ(c.mode(kGuided), CommandResult::accepted);
  c.run(5.0);
  EXPECT_GT(height_m(c), 200.0);
}

TEST(EmulatedFlightController, RestartsByCommand) {
  Companion c{in_flight()};
  c.run(1.0);
  EXPECT_EQ(c.command(Command::preflight_reboot_shutdown, 1.0F), CommandResult::failed) << "armed";
  EmulatorConfig config = in_flight();
  config.airborne = false;
  Companion parked{config};
  parked.run(1.0);
  EXPECT_EQ(parked.command(Command::preflight_reboot_shutdown, 1.0F), CommandResult::accepted);
  parked.forget();
  parked.run(5.0);
  EXPECT_EQ(parked.count<mavlink::Heartbeat>(), 0U);
  parked.run(1.0);
  EXPECT_GT(parked.count<mavlink::Heartbeat>(), 0U);
}

TEST(EmulatedFlightController, CanBeSilent) {
  Companion c{in_flight()};
  c.run(2.0);
  c.interfere("silent on");
  const std::uint64_t before = c.frames();
  c.run(5.0);
  EXPECT_EQ(c.frames(), before);
  c.interfere("silent off");
  c.forget();
  c.run(1.1);
  EXPECT_GT(c.count<mavlink::Heartbeat>(), 0U);
}

TEST(EmulatedFlightController, TheSameSeedGivesTheSameBytes) {
  EmulatorConfig config = in_flight();
  config.noise = true;
  config.gusts_wind_mps = 5.0;
  config.wind_mps = {3.0, -2.0};
  const auto flown = [&] {
    Companion c{config};
    c.run(5.0);
    std::vector<std::uint8_t> bytes;
    for (const mavlink::Packet& p : c.packets()) {
      bytes.insert(bytes.end(), p.payload.begin(), p.payload.begin() + p.length);
    }
    return bytes;
  };
  const auto first = flown();
  EXPECT_GT(first.size(), 1000U);
  EXPECT_EQ(first, flown());
  config.seed = 2;
  EXPECT_NE(first, flown());
}

TEST(EmulatedFlightController, HoldsItsOrbitInWindWithGusts) {
  EmulatorConfig config = in_flight();
  config.noise = true;
  config.gusts_wind_mps = 5.0;
  config.wind_mps = {3.0, -4.0};
  Companion c{config};
  watch(c);
  mavlink::CommandInt there = to_place(Command::do_reposition, 500.0, 0.0, 300.0);
  there.param2 = 1.0F;
  EXPECT_EQ(c.command(there), CommandResult::accepted);
  c.run(40.0);
  for (int i = 0; i < 30; ++i) {
    c.run(1.0);
    EXPECT_NEAR(distance_m(c, 500.0, 0.0), 165.0, 6.0);
    EXPECT_NEAR(height_m(c), 300.0, 6.0);
    EXPECT_NEAR(airspeed_mps(c), 50.0, 3.0);
  }
  const auto wind = c.last<mavlink::Wind>().value();
  EXPECT_NEAR(static_cast<double>(wind.speed), 5.0, 1.5);
  EXPECT_NEAR(static_cast<double>(wind.direction), -36.9, 15.0);
}

TEST(EmulatorConfig, ImpossibleOnesAreRefusedWithTheReason) {
  const auto reason = [](auto change) {
    EmulatorConfig config = in_flight();
    change(config);
    const auto made = EmulatedFlightController::make(config, Instant{});
    return made.ok() ? std::string{} : made.error().message;
  };
  EXPECT_EQ(reason([](EmulatorConfig&) {}), "");
  EXPECT_EQ(reason([](EmulatorConfig& c) { c.node_id = 42; }),
            "node 42: the companion must have another");
  EXPECT_NE(reason([](EmulatorConfig& c) { c.node_id = 0; }), "");
  EXPECT_NE(reason([](EmulatorConfig& c) { c.system_id = 0; }), "");
  EXPECT_NE(reason([](EmulatorConfig& c) { c.serial_id = 16; }), "");
  EXPECT_EQ(reason([](EmulatorConfig& c) { c.turn_radius_m = 100.0; }),
            "turn radius 100 m: at 50 m/s the airframe turns no tighter than 119 m");
  EXPECT_NE(reason([](EmulatorConfig& c) { c.airspeed_min_mps = 30.0; }).find("airspeeds"),
            std::string::npos);
  EXPECT_NE(reason([](EmulatorConfig& c) { c.height_m = 0.0; }), "");
  EXPECT_NE(reason([](EmulatorConfig& c) { c.wind_mps = {30.0, 0.0}; }), "");
  EXPECT_NE(reason([](EmulatorConfig& c) { c.origin.latitude_deg = 91.0; }), "");
  EXPECT_NE(reason([](EmulatorConfig& c) { c.mode = "FLY"; }), "");
  EXPECT_NE(
      reason([](EmulatorConfig& c) { c.start.x_m = std::numeric_limits<double>::quiet_NaN(); }),
      "");
}

}  // namespace
}  // namespace skein::hil
