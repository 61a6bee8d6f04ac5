// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>

#include "companion_bench.hpp"
#include "skein/base/angles.hpp"

namespace skein::hil {
namespace {

EmulatorConfig plane_in_wind() {
  EmulatorConfig config;
  config.origin = kOrigin;
  config.start = {1000.0, 2000.0, kPi / 2.0};
  config.height_m = 300.0;
  config.airborne = true;
  config.companion_failsafe = true;
  config.wind_mps = {4.0, -3.0};
  config.gusts_wind_mps = 5.0;
  return config;
}

TEST(CompanionAndEmulator, ThrustEmptiesTheBatteryAndTheStateTellsIt) {
  EmulatorConfig config = plane_in_wind();
  config.battery_mah = 1000.0;
  Bench bench{config};
  ASSERT_TRUE(bench.run_until(State::flying, 10.0));
  bench.setpoint = {0.5, 50.0, 300.0};
  bench.run(2.0);
  const int before{bench.state().battery_percent};
  EXPECT_GT(before, 80);
  EXPECT_LE(before, 100);
  bench.run(20.0);
  const int after{bench.state().battery_percent};
  EXPECT_LT(after, before - 2);
  EXPECT_GT(after, before - 40);  // 60 A at most
  bench.interfere("battery 30.5");
  bench.run(1.0);
  EXPECT_NEAR(bench.state().battery_percent, 30, 2);
  // Its gauge counts from full when the autopilot restarts.
  bench.interfere("reboot");
  bench.run(12.0);
  EXPECT_GT(bench.state().battery_percent, 70);
}

TEST(CompanionAndEmulator, APlaneIsFlownInWindWithGusts) {
  EmulatorConfig config = plane_in_wind();
  config.hold_until = at_seconds(3.0);
  Bench bench{config};
  bench.setpoint = {.heading_rad = kPi / 2.0, .airspeed_mps = 50.0, .height_m = 300.0};
  ASSERT_TRUE(bench.run_until(State::flying, 2.9)) << bench.log();
  EXPECT_NEAR(bench.state().x_m, 1000.0, 1.0);
  EXPECT_NEAR(bench.state().heading_rad, kPi / 2.0, 0.01);
  bench.setpoint = {.heading_rad = 0.0, .airspeed_mps = 55.0, .height_m = 320.0};
  bench.run(20.0);
  for (int i = 0; i < 20; ++i) {
    bench.run(0.5);
    EXPECT_NEAR(degrees(bench.state().heading_rad), 0.0, 3.0) << bench.log();
    EXPECT_NEAR(bench.state().airspeed_mps, 55.0, 2.0);
    EXPECT_NEAR(bench.state().z_m, 320.0, 5.0);
  }
  EXPECT_EQ(bench.companion().parser().lost, 0U);
  EXPECT_EQ(bench.companion().parser().bad_crc, 0U);
  EXPECT_EQ(bench.link().reassembly().broken(), 0U);
}

constexpr Landing kIntoWind{.x_m = 1000.0,
                            .y_m = 2500.0,
                            .heading_rad = 2.5,
                            .approach_m = 600.0,
                            .approach_height_m = 40.0,
                            .radius_m = 165.0};

TEST(CompanionAndEmulator, BeyondItsFenceTheAutopilotReturnsAndIsNotTakenBack) {
  EmulatorConfig config = plane_in_wind();
  config.fence_height_m = 400.0;
  ardupilot::CanLinkParams companion = Bench::params(config);
  companion.companion.fence.corners = {{0.0, 0.0}, {2000.0, 0.0}, {2000.0, 2600.0}, {0.0, 2600.0}};
  companion.companion.fence.height_max_m = 400.0;
  Bench bench{config, companion};
  bench.setpoint = {.heading_rad = kPi / 2.0, .airspeed_mps = 50.0, .height_m = 300.0};
  ASSERT_TRUE(bench.run_until(State::flying, 10.0)) << bench.log();
  EXPECT_NE(bench.log().find("has the fence: 4 corners"), std::string::npos) << bench.log();
  ASSERT_TRUE(bench.run_until(State::piloted, 20.0)) << "600 m to the north at 50 m/s";
  EXPECT_NEAR(bench.state().y_m, 2600.0, 40.0);
  EXPECT_NE(bench.log().find("Polygon fence breached"), std::string::npos) << bench.log();
  bench.run(20.0);
  EXPECT_LT(bench.state().y_m, 2600.0) << "by the autopilot itself";
  EXPECT_EQ(bench.companion().state(), State::piloted);
}

TEST(CompanionAndEmulator, WithAKeyBothSignAndNobodyElseIsHeeded) {
  EmulatorConfig config = plane_in_wind();
  config.unix_us = 1'764'000'000'000'000;
  config.signing_key = mavlink::key_of("ours");
  ardupilot::CanLinkParams companion = Bench::params(config);
  companion.companion.signing = mavlink::Signing{*config.signing_key, config.unix_us};
  Bench bench{config, companion};
  ASSERT_TRUE(bench.run_until(State::flying, 10.0)) << bench.log();
  bench.interfere("reboot");
  bench.run(1.0);
  EXPECT_TRUE(bench.run_until(State::piloted, 15.0)) << "it is heard after a new start, in LOITER";
  Bench unsigned_one{config, Bench::params(config)};
  EXPECT_FALSE(unsigned_one.run_until(State::flying, 10.0)) << "it is not heeded";
}

TEST(CompanionAndEmulator, APlaneLandsByAMissionAndIsDisarmed) {
  Bench bench{plane_in_wind()};
  bench.setpoint = {.heading_rad = kPi / 2.0, .airspeed_mps = 50.0, .height_m = 300.0};
  ASSERT_TRUE(bench.run_until(State::flying, 10.0)) << bench.log();
  bench.setpoint.landing = kIntoWind;
  ASSERT_TRUE(bench.run_until(State::landing, 5.0)) << bench.log();
  double height_m = bench.state().z_m;
  double sink_mps = 0.0;  // over the last second before it is on the ground
  Vec2 touched = bench.state().position().horizontal();
  for (int i = 0; i < 3000 && bench.companion().state() == State::landing; ++i) {
    bench.run(0.1);
    const VehicleState state = bench.state();
    if (state.z_m > 1.0) {
      sink_mps = (height_m - state.z_m) / 0.1;
      touched = state.position().horizontal();
    }
    height_m = state.z_m;
  }
  EXPECT_EQ(bench.companion().state(), State::standing_by) << bench.log();
  EXPECT_EQ(bench.state().phase, FlightPhase::disarmed);
  EXPECT_LT(sink_mps, 2.0);
  // As ArduPlane, which would not arm again before its mode changes.
  bench.run(40.0);
  EXPECT_NE(bench.log().find("In landing sequence"), std::string::npos) << bench.log();
  const Vec2 off = touched - Vec2{kIntoWind.x_m, kIntoWind.y_m};
  const Vec2 forward = unit_vector(kIntoWind.heading_rad);
  EXPECT_LT(std::abs(left_of(forward).dot(off)), 10.0) << bench.log();
  EXPECT_LT(std::abs(forward.dot(off)), 200.0) << bench.log();
  RecordProperty("sink_mps", std::to_string(sink_mps));
  RecordProperty("along_m", std::to_string(forward.dot(off)));
  RecordProperty("across_m", std::to_string(left_of(forward).dot(off)));
}

TEST(CompanionAndEmulator, APlaneThatLandsGoesAround) {
  Bench bench{plane_in_wind()};
  bench.setpoint = {.heading_rad = kPi / 2.0, .airspeed_mps = 50.0, .height_m = 300.0};
  ASSERT_TRUE(bench.run_until(State::flying, 10.0)) << bench.log();
  bench.setpoint.landing = kIntoWind;
  ASSERT_TRUE(bench.run_until(State::landing, 5.0)) << bench.log();
  for (int i = 0; i < 3000 && bench.state().z_m > 20.0; ++i) bench.run(0.1);
  ASSERT_EQ(bench.companion().state(), State::landing) << bench.log();
  bench.setpoint.landing.reset();
  ASSERT_TRUE(bench.run_until(State::flying, 3.0)) << bench.log();
  bench.run(40.0);
  EXPECT_NEAR(bench.state().z_m, 300.0, 10.0) << bench.log();
  EXPECT_EQ(bench.companion().state(), State::flying);
}

TEST(CompanionAndEmulator, PilotSilenceAndRestartAreNoticed) {
  Bench bench{plane_in_wind()};
  bench.setpoint = {.heading_rad = kPi / 2.0, .airspeed_mps = 50.0, .height_m = 300.0};
  ASSERT_TRUE(bench.run_until(State::flying, 10.0)) << bench.log();
  bench.run(2.0);
  bench.interfere("mode LOITER");
  EXPECT_TRUE(bench.run_until(State::piloted, 0.25)) << bench.log();
  bench.run(2.0);
  EXPECT_EQ(bench.companion().state(), State::piloted);
  EXPECT_TRUE(bench.companion().give_back(bench.now(), bench.now())) << bench.log();
  EXPECT_TRUE(bench.run_until(State::flying, 3.0)) << bench.log();

  bench.interfere("silent on");
  EXPECT_TRUE(bench.run_until(State::lost, 0.25)) << bench.log();
  bench.run(1.0);
  bench.interfere("silent off");
  EXPECT_TRUE(bench.run_until(State::flying, 1.0)) << bench.log();

  bench.interfere("reboot");
  EXPECT_TRUE(bench.run_until(State::lost, 0.25)) << bench.log();
  bench.run(10.0);
  EXPECT_NE(bench.companion().state(), State::lost) << bench.log();
  EXPECT_NE(bench.companion().state(), State::silent) << bench.log();
}

TEST(CompanionAndEmulator, APlaneThatDoesNotKnowWhereItIsIsNotTaken) {
  Bench bench{plane_in_wind()};
  bench.setpoint = {.heading_rad = kPi / 2.0, .airspeed_mps = 50.0, .height_m = 300.0};
  bench.interfere("position lost");
  ASSERT_TRUE(bench.run_until(State::standing_by, 10.0)) << bench.log();
  bench.run(2.0);
  EXPECT_EQ(bench.companion().state(), State::standing_by) << bench.log();
  EXPECT_FALSE(bench.companion().give_back(bench.now(), bench.now()));
  bench.interfere("position good");
  EXPECT_TRUE(bench.run_until(State::flying, 3.0)) << bench.log();
}

TEST(CompanionAndEmulator, ACopterIsFlown) {
  EmulatorConfig config = plane_in_wind();
  config.airframe = Airframe::copter;
  config.airspeed_mps = 10.0;
  config.height_m = 30.0;
  config.wind_mps = {2.0, -1.0};
  config.gusts_wind_mps = 0.0;
  Bench bench{config};
  bench.setpoint = {.heading_rad = 0.0, .airspeed_mps = 5.0, .height_m = 30.0};
  ASSERT_TRUE(bench.run_until(State::flying, 10.0)) << bench.log();
  bench.run(10.0);
  EXPECT_NEAR(bench.state().groundspeed_mps, 5.0, 0.7) << bench.log();
  EXPECT_NEAR(degrees(bench.state().course_rad), 0.0, 8.0);
  EXPECT_NEAR(bench.state().z_m, 30.0, 1.5);
}

/// How often the log has that.
int count(const std::string& log, const std::string& what) {
  int n = 0;
  for (auto at = log.find(what); at != std::string::npos; at = log.find(what, at + 1)) ++n;
  return n;
}

// Bench's companion is node 42 and looks for node 10, system 1.
struct Misfit {
  const char* what;
  std::function<void(EmulatorConfig&)> make;
  const char* said;
};

class NothingIsSilent : public ::testing::TestWithParam<Misfit> {};

TEST_P(NothingIsSilent, ItIsToldWithinFiveSecondsWithItsRemedyAndOnceAMinute) {
  EmulatorConfig config = plane_in_wind();
  GetParam().make(config);
  Bench bench{config, Bench::params({})};
  bench.run(5.0);
  EXPECT_EQ(count(bench.log(), GetParam().said), 1) << bench.log();
  ASSERT_FALSE(bench.companion().troubles().empty());
  EXPECT_NE(wording::text_of(bench.companion().troubles().front()).find(GetParam().said),
            std::string::npos);
  bench.run(53.0);
  EXPECT_EQ(count(bench.log(), GetParam().said), 1) << bench.log();
  bench.run(10.0);
  EXPECT_EQ(count(bench.log(), GetParam().said), 2) << bench.log();
}

INSTANTIATE_TEST_SUITE_P(
    CompanionAndEmulator, NothingIsSilent,
    ::testing::Values(
        Misfit{"WrongNode", [](EmulatorConfig& c) { c.node_id = 11; },
               "heard are: 11 (its serial port is for node 42). Set flight_controller.node_id"},
        Misfit{"NoSerial", [](EmulatorConfig& c) { c.serial_port = false; },
               "set CAN_D1_UC_SER_EN 1, CAN_D1_UC_S1_NOD 42, CAN_D1_UC_S1_IDX 0, "
               "CAN_D1_UC_S1_PRO 2 and reboot it"},
        Misfit{"ForAnother", [](EmulatorConfig& c) { c.companion_node = 43; },
               "for node 43 (port 0): set CAN_D1_UC_SER_EN 1, CAN_D1_UC_S1_NOD 42"},
        Misfit{"AnotherPort", [](EmulatorConfig& c) { c.serial_id = 1; },
               "for node 42 (port 1): set"},
        Misfit{"NoMavlink", [](EmulatorConfig& c) { c.mavlink = false; },
               "no HEARTBEAT comes through it: set CAN_D1_UC_S1_PRO 2"},
        Misfit{"OtherSystem", [](EmulatorConfig& c) { c.system_id = 7; },
               "set flight_controller.system_id to 7"},
        Misfit{"WrongAirframe",
               [](EmulatorConfig& c) {
                 c.airframe = Airframe::copter;
                 c.airspeed_mps = 10.0;
               },
               "mend the airframe in the configuration"},
        Misfit{"NoParameter", [](EmulatorConfig& c) { c.unknown_parameters = {"FS_LONG_ACTN"}; },
               "it does not tell FS_LONG_ACTN, which must be 1"}),
    [](const auto& tested) { return std::string{tested.param.what}; });

TEST(CompanionAndEmulator, ASilentBusIsTold) {
  Bench bench{plane_in_wind()};
  bench.interfere("silent on");
  bench.run(5.0);
  EXPECT_EQ(count(bench.log(), "not one frame comes from the bus wire"), 1) << bench.log();
  bench.interfere("silent off");
  ASSERT_TRUE(bench.run_until(State::flying, 5.0)) << bench.log();
  bench.run(1.0);
  EXPECT_TRUE(bench.companion().troubles().empty());
}

TEST(CompanionAndEmulator, ARestartIsNoTroubleOfTheLink) {
  Bench bench{plane_in_wind()};
  ASSERT_TRUE(bench.run_until(State::flying, 10.0)) << bench.log();
  bench.run(5.0);  // that its uptime goes back is seen
  bench.interfere("reboot");
  bench.run(15.0);
  // "Set airspeed" is the autopilot's own.
  EXPECT_EQ(count(bench.log(), "Set "), count(bench.log(), "Set airspeed ")) << bench.log();
  EXPECT_EQ(count(bench.log(), "set "), 0) << bench.log();
}

TEST(CompanionAndEmulator, WhyItWouldNotArmIsToldOnceAndForgottenOnceItWould) {
  EmulatorConfig config = plane_in_wind();
  config.airborne = false;
  config.height_m = 0.0;
  Bench bench{config};
  ASSERT_TRUE(bench.run_until(State::standing_by, 10.0)) << bench.log();
  bench.interfere("prearm Compass not calibrated");
  bench.run(3.0);
  const std::string said = "the autopilot would not arm: Compass not calibrated";
  EXPECT_EQ(count(bench.log(), said), 1) << bench.log();
  bench.run(100.0);
  EXPECT_EQ(count(bench.log(), said), 1) << bench.log();
  ASSERT_EQ(bench.companion().troubles().size(), 1U);
  EXPECT_EQ(bench.companion().troubles().front().news, AutopilotNews::pre_arm);
  bench.interfere("prearm Battery low");
  bench.run(3.0);
  bench.interfere("prearm");
  bench.run(2.0);
  EXPECT_TRUE(bench.companion().troubles().empty());
  bench.interfere("prearm Compass not calibrated");
  bench.run(40.0);
  EXPECT_EQ(count(bench.log(), said), 2) << bench.log();
}

TEST(CompanionAndEmulator, WhyItWouldNotArmIsAskedForWhileAParameterIsMissing) {
  EmulatorConfig config = plane_in_wind();
  config.airborne = false;
  config.height_m = 0.0;
  config.unknown_parameters = {"FS_LONG_ACTN"};
  Bench bench{config};
  bench.interfere("prearm Battery 1 below minimum arming voltage");
  bench.run(5.0);
  EXPECT_EQ(bench.companion().state(), State::preparing) << bench.log();
  EXPECT_EQ(count(bench.log(), "FS_LONG_ACTN"), 1) << bench.log();
  EXPECT_EQ(count(bench.log(), "would not arm: Battery 1 below minimum arming voltage (charge"), 1)
      << bench.log();
}

TEST(CompanionAndEmulator, ALinkThatFlapsIsNoNewTakeover) {
  Bench bench{plane_in_wind()};
  bench.setpoint = {.heading_rad = kPi / 2.0, .airspeed_mps = 50.0, .height_m = 300.0};
  ASSERT_TRUE(bench.run_until(State::flying, 10.0)) << bench.log();
  bench.interfere("mode LOITER");
  ASSERT_TRUE(bench.run_until(State::piloted, 1.0)) << bench.log();
  bench.run(0.5);
  const Instant word = bench.now();  // of the operator: it takes its time to come here
  for (int i = 0; i < 5; ++i) {
    bench.interfere("silent on");
    ASSERT_TRUE(bench.run_until(State::lost, 1.0)) << bench.log();
    bench.interfere("silent off");
    ASSERT_TRUE(bench.run_until(State::piloted, 1.0)) << bench.log();
  }
  EXPECT_EQ(count(bench.log(), "the mode was changed to LOITER by the pilot"), 1) << bench.log();
  EXPECT_EQ(count(bench.log(), "still, in LOITER"), 5) << bench.log();
  EXPECT_TRUE(bench.companion().give_back(bench.now(), word)) << bench.log();
  EXPECT_TRUE(bench.run_until(State::flying, 3.0)) << bench.log();
}

}  // namespace
}  // namespace skein::hil
