// SPDX-License-Identifier: Apache-2.0
#include "skein/ardupilot/companion.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>

#include "companion_line.hpp"
#include "custody.hpp"
#include "skein/base/atmosphere.hpp"
#include "skein/base/random.hpp"

namespace skein::ardupilot {
namespace {

using State = Companion::State;
using Event = Companion::Event;
using std::chrono::milliseconds;
using testing::Contains;
using testing::HasSubstr;

TEST(Companion, ConnectsTakesTheAircraftInFlightAndFliesSetpoints) {
  Line line;
  EXPECT_LT(line.until(State::flying, 10.0), std::chrono::seconds{6});
  ASSERT_EQ(line.companion.state(), State::flying);
  EXPECT_EQ(line.autopilot.mode, 15U);
  EXPECT_EQ(line.autopilot.count(mavlink::Command::component_arm_disarm), 0);
  EXPECT_GE(line.targets_within(2.0), 40U);  // 20 Hz or more
  EXPECT_EQ(line.companion.protocol_errors(), 0U);
  EXPECT_THAT(line.notices, Contains(HasSubstr("ArduPilot 4.6.3")));
  EXPECT_TRUE(line.warnings.empty()) << line.warnings.front();
}

TEST(Companion, KnowsWhetherTheAircraftIsInUse) {
  Line line;
  EXPECT_FALSE(line.companion.in_use().has_value());  // nobody has said anything yet
  line.until(State::flying, 10.0);
  EXPECT_EQ(line.companion.in_use(), std::optional{true});
  line.autopilot.armed = false;
  line.run(2.0);
  EXPECT_EQ(line.companion.in_use(), std::optional{true});  // in the air
  line.autopilot.landed = 1;
  line.run(2.0);
  EXPECT_EQ(line.companion.in_use(), std::optional{false});
  line.autopilot.armed = true;
  line.run(2.0);
  EXPECT_EQ(line.companion.in_use(), std::optional{true});
}

TEST(Companion, BanksForTheTurnWithRollAlone) {
  Line line;
  line.setpoint.heading_rad = line.autopilot.truth.heading_rad + 0.1;  // to the left
  line.until(State::flying, 10.0);
  line.run(0.5);
  ASSERT_FALSE(line.autopilot.attitudes.empty());
  const auto left = line.autopilot.attitudes.back();
  EXPECT_EQ(left.type_mask, 0xC6);
  const double bank = 2.0 * std::atan2(left.q[1], left.q[0]);
  EXPECT_NEAR(bank, -std::atan(50.0 * 1.5 * 0.1 / 9.81), 1e-3);
  EXPECT_EQ(left.q[2], 0.0F);
  // A turn that is asked too tight is flown at the vehicle's turn radius, with 5 % to roll past it.
  line.setpoint.heading_rad = line.autopilot.truth.heading_rad - 2.0;
  line.run(0.5);
  const auto right = line.autopilot.attitudes.back();
  EXPECT_NEAR(2.0 * std::atan2(right.q[1], right.q[0]), std::atan(50.0 * 50.0 / 157.5 / 9.81),
              1e-3);
}

TEST(Companion, SendsSpeedAndHeightWhenTheyChange) {
  Line line;
  line.until(State::flying, 10.0);
  line.run(3.0);
  using mavlink::Command;
  EXPECT_EQ(line.autopilot.count(Command::do_change_speed), 1);
  EXPECT_EQ(line.autopilot.count(Command::do_change_altitude), 1);
  const auto height = line.autopilot.last(Command::do_change_altitude);
  ASSERT_TRUE(height);
  EXPECT_NEAR(height->param1, 480.0 + 310.0, 0.1);
  EXPECT_EQ(height->param2, 0.0F);
  // However fast it changes, at most two a second, and never outside the vehicle's limits.
  const int before = line.autopilot.count(Command::do_change_speed);
  for (int i = 0; i < 400; ++i) {
    line.setpoint.airspeed_mps = 50.0 + 30.0 * std::sin(0.05 * i);
    line.tick();
  }
  EXPECT_LE(line.autopilot.count(Command::do_change_speed) - before, 4);
  EXPECT_GE(line.autopilot.count(Command::do_change_speed) - before, 3);
  for (const auto& c : line.autopilot.commands) {
    if (c.command != static_cast<std::uint16_t>(Command::do_change_speed)) continue;
    EXPECT_GE(c.param2, 42.5F);
    EXPECT_LE(c.param2, 57.5F);
  }
}

TEST(Companion, AsksForEquivalentAirspeeds) {
  Line line;
  line.setpoint.airspeed_mps = 52.0;
  line.until(State::flying, 10.0);
  line.run(1.0);
  const auto speed = line.autopilot.last(mavlink::Command::do_change_speed);
  ASSERT_TRUE(speed);
  EXPECT_NEAR(speed->param2, 52.0 / true_per_equivalent_airspeed(480.0 + 300.0), 1e-2);
}

TEST(Companion, SendsASpeedAgainThatWasLost) {
  Line line;
  line.autopilot.deaf_to[178] = 1;
  line.until(State::flying, 10.0);
  line.run(0.2);
  EXPECT_EQ(line.autopilot.count(mavlink::Command::do_change_speed), 0);
  line.run(0.5);
  EXPECT_EQ(line.autopilot.count(mavlink::Command::do_change_speed), 1);
  line.run(2.0);
  EXPECT_EQ(line.autopilot.count(mavlink::Command::do_change_speed), 1);
}

TEST(Companion, FliesNoAircraftWhoseAttitudeComesNoMore) {
  Line line;
  line.until(State::flying, 10.0);
  line.run(1.0);
  line.autopilot.stopped = {30};
  line.run(0.7);
  EXPECT_GE(line.now - line.companion.sample()->state.time, milliseconds{650});
  EXPECT_EQ(line.targets_within(0.5), 0U);
  line.autopilot.stopped = {74};  // airspeed
  line.run(0.5);
  EXPECT_GT(line.targets_within(0.3), 5U);
  line.run(1.5);
  EXPECT_EQ(line.targets_within(0.5), 0U);
}

TEST(Companion, TakesNoTimeThatItHasNotAskedFor) {
  Line line;
  line.delay = milliseconds{30};
  line.until(State::flying, 10.0);
  line.run(1.0);
  mavlink::Encoder encoder{1, 1};
  const std::int64_t now = line.now.time_since_epoch().count();
  using Limits = std::numeric_limits<std::int64_t>;
  for (const std::int64_t ts1 : {Limits::min(), Limits::max(), std::int64_t{0}, now - 1000}) {
    for (const std::int64_t tc1 :
         {Limits::min(), std::int64_t{-1}, std::int64_t{1}, Limits::max()}) {
      mavlink::Timesync answer;
      answer.ts1 = ts1;
      answer.tc1 = tc1;
      line.companion.on_bytes(encoder.encode(answer), line.now);
    }
  }
  line.run(0.2);
  const Duration age = line.now - line.companion.sample()->state.time;
  EXPECT_GE(age, milliseconds{25});
  EXPECT_LE(age, milliseconds{85});
}

TEST(Companion, HeedsNoAutopilotOfAnotherSystem) {
  Line line;
  mavlink::Encoder other{7, 1};
  mavlink::Heartbeat heartbeat;
  heartbeat.type = 1;
  heartbeat.autopilot = 3;
  heartbeat.custom_mode = 11;
  for (int i = 0; i < 100; ++i) {
    line.companion.on_bytes(other.encode(heartbeat), line.now);
    line.run(0.05);
  }
  line.until(State::flying, 5.0);
  EXPECT_EQ(line.companion.state(), State::flying);
  line.companion.on_bytes(other.encode(heartbeat), line.now);
  EXPECT_EQ(line.companion.state(), State::flying);
  for (const auto& command : line.autopilot.commands) EXPECT_EQ(command.target_system, 1);
  ASSERT_EQ(line.warnings.size(), 1U);
  EXPECT_THAT(line.warnings.front(), HasSubstr("system 7"));
}

TEST(Companion, ReportsTheStateInTheMissionsFrameAndTime) {
  Line line;
  line.delay = milliseconds{30};
  line.autopilot.bank_rad = -0.05;  // to the left, and too flat to learn from
  line.until(State::flying, 10.0);
  line.run(1.0);
  const auto sample = line.companion.sample();
  ASSERT_TRUE(sample);
  const auto& truth = line.autopilot.truth;
  EXPECT_NEAR(sample->state.x_m, truth.x_m, 0.02);
  EXPECT_NEAR(sample->state.y_m, truth.y_m, 0.02);
  EXPECT_NEAR(sample->state.z_m, truth.z_m, 0.01);
  EXPECT_NEAR(sample->state.heading_rad, truth.heading_rad, 0.01);
  EXPECT_NEAR(sample->state.course_rad, truth.course_rad, 1e-3);
  EXPECT_NEAR(sample->state.groundspeed_mps, truth.groundspeed_mps, 0.01);
  EXPECT_NEAR(sample->state.airspeed_mps, truth.airspeed_mps, 1e-4);
  EXPECT_NEAR(sample->turn_rate_radps, 9.80665 * std::tan(0.05) / truth.airspeed_mps, 1e-4);
  // Measured one delay before it came, and the stream has 40 ms.
  const Duration age = line.now - sample->state.time;
  EXPECT_GE(age, milliseconds{25});
  EXPECT_LE(age, milliseconds{85});
}

TEST(Companion, LeavesTheAircraftToItsPilotUntilGuided) {
  Line line{params(TakeOver::when_guided)};
  line.run(8.0);
  EXPECT_EQ(line.companion.state(), State::standing_by);
  EXPECT_EQ(line.autopilot.count(mavlink::Command::do_set_mode), 0);
  EXPECT_TRUE(line.autopilot.target_times.empty());
  line.autopilot.mode = 15;
  EXPECT_LE(line.until(State::flying, 1.0), milliseconds{150});
  EXPECT_GT(line.targets_within(0.5), 5U);
}

TEST(Companion, FliesACopterByVelocity) {
  CompanionParams p = params(TakeOver::from_ground, Airframe::copter);
  p.takeoff_height_m = 15.0;
  Line line{p};
  auto& fc = line.autopilot;
  fc.type = 13;
  fc.mode = 0;
  fc.armed = false;
  fc.landed = 1;
  fc.relative_height_m = 0.0;
  line.until(State::climbing, 10.0);
  line.run(0.2);
  const auto takeoff = fc.last(mavlink::Command::nav_takeoff);
  ASSERT_TRUE(takeoff);
  EXPECT_EQ(takeoff->param7, 15.0F);
  fc.landed = 2;
  fc.relative_height_m = 15.0;
  line.setpoint = {.heading_rad = kPi / 2.0, .airspeed_mps = 6.0, .height_m = 302.0};
  line.until(State::flying, 3.0);
  EXPECT_GE(line.targets_within(1.0), 20U);
  EXPECT_TRUE(fc.attitudes.empty());
  const auto target = fc.velocities.back();
  EXPECT_EQ(target.type_mask, 0xDC7);
  EXPECT_NEAR(target.vx, 6.0, 1e-5);  // north
  EXPECT_NEAR(target.vy, 0.0, 1e-5);
  EXPECT_NEAR(target.vz, -2.0, 0.02);
}

/// Hovers 5 m above home, and home is 295 m above the origin.
struct CopterLine : Line {
  explicit CopterLine(double geoid_m = 0.0)
      : Line{copter_params(geoid_m)}, geoid_height_m{geoid_m} {
    autopilot.type = 13;
    autopilot.mode = 5;
    autopilot.truth.groundspeed_mps = 0.0;
    autopilot.relative_height_m = 5.0;
  }
  static CompanionParams copter_params(double geoid_m) {
    CompanionParams p = params(TakeOver::in_flight, Airframe::copter);
    p.geoid_height_m = geoid_m;
    return p;
  }
  static PositionSetpoint place(double x_m, double z_m) {
    PositionSetpoint s;
    s.x_m = x_m;
    s.y_m = -50.0;
    s.z_m = z_m;
    return s;
  }
  [[nodiscard]] Position<MissionEnu> sent() const {
    const auto& t = autopilot.points.back();
    return MissionOrigin::make(kTestOrigin)
        .value()
        .to_enu({t.lat_int * 1e-7, t.lon_int * 1e-7, static_cast<double>(t.alt) + geoid_height_m});
  }
  static constexpr std::uint32_t kLand = 9;
  double geoid_height_m;
};

TEST(Companion, FliesACopterToAPoint) {
  CopterLine line{-30.0};
  auto& fc = line.autopilot;
  line.point = CopterLine::place(110.0, 305.0);
  line.point->vx_mps = 1.0;
  line.point->vy_mps = 2.0;
  line.point->vz_mps = -0.5;
  line.point->ay_mps2 = 0.7;
  line.point->yaw_rad = kPi;
  line.until(State::flying, 10.0);
  EXPECT_GE(line.targets_within(1.0), 20U);
  EXPECT_TRUE(fc.velocities.empty());
  const auto target = fc.points.back();
  EXPECT_EQ(target.type_mask, 0x800);  // all but the rate of yaw
  EXPECT_EQ(target.coordinate_frame, 5);
  EXPECT_LT((line.sent().metres() - line.point->position_m()).norm(), 0.03);
  EXPECT_NEAR(target.vx, 2.0 + 0.7 / 2.0, 1e-5);  // and what asks for the acceleration
  EXPECT_EQ(target.vy, 1.0F);
  EXPECT_EQ(target.vz, 0.5F);
  EXPECT_EQ(target.afx, 0.7F);
  EXPECT_EQ(target.afy, 0.0F);
  EXPECT_NEAR(target.yaw, -kPi / 2.0, 1e-6);
  // It moves on until the next one comes, and not for ever.
  line.commands = false;
  line.run(0.2);
  EXPECT_NEAR(line.sent().x(), 110.19, 0.03);
  line.run(0.2);
  EXPECT_EQ(line.targets_within(1.0), 0U);
  // By velocity again.
  line.commands = true;
  line.point.reset();
  line.run(0.2);
  EXPECT_FALSE(fc.velocities.empty());
}

TEST(Companion, FliesNoPlaneToAPoint) {
  Line line;
  line.point = CopterLine::place(110.0, 305.0);
  line.until(State::flying, 10.0);
  EXPECT_EQ(line.targets_within(1.0), 0U);
}

TEST(Companion, LandsACopterWhereItsPointStaysOnTheGround) {
  CopterLine line;
  auto& fc = line.autopilot;
  line.point = CopterLine::place(104.0, 295.0);
  line.until(State::flying, 10.0);
  line.run(3.0);
  EXPECT_EQ(line.companion.state(), State::flying);  // its place is 4 m away
  EXPECT_NEAR(line.sent().z(), 298.0, 0.03);         // never into the ground
  line.point = CopterLine::place(101.0, 295.0);
  line.run(0.5);
  line.point = CopterLine::place(101.0, 299.0);  // not yet
  line.run(0.8);
  EXPECT_EQ(line.companion.state(), State::flying);
  line.point = CopterLine::place(101.0, 290.0);
  fc.deaf_to[static_cast<std::uint16_t>(mavlink::Command::do_set_mode)] = 1;
  EXPECT_NEAR(to_seconds(line.until(State::landing, 3.0)), 1.0, 0.05);
  line.run(0.2);
  EXPECT_EQ(line.targets_within(2.0), 0U);
  EXPECT_EQ(fc.mode, CopterLine::kLand);  // asked again
  line.cut = true;
  line.until(State::lost, 1.0);
  line.cut = false;
  line.until(State::landing, 1.0);
  EXPECT_EQ(line.companion.state(), State::landing);
  fc.armed = false;
  fc.landed = 1;
  fc.relative_height_m = 0.0;
  line.run(1.0);
  EXPECT_EQ(line.companion.state(), State::standing_by);
  line.run(5.0);
  EXPECT_EQ(line.companion.state(), State::standing_by);
  EXPECT_EQ(line.companion.protocol_errors(), 0U);
}

TEST(Companion, ThePilotWinsWhileItLands) {
  CopterLine line;
  line.point = CopterLine::place(100.0, 295.0);
  line.until(State::landing, 10.0);
  line.run(0.5);
  ASSERT_EQ(line.autopilot.mode, CopterLine::kLand);
  line.autopilot.mode = 5;
  EXPECT_LE(line.until(State::piloted, 1.0), milliseconds{100});
}

TEST(Companion, FliesOnWhereALandingWasNotHeardOfInALoss) {
  CopterLine line;
  line.point = CopterLine::place(100.0, 295.0);
  line.until(State::flying, 10.0);
  line.autopilot.deaf_to[static_cast<std::uint16_t>(mavlink::Command::do_set_mode)] = 9;
  line.until(State::landing, 3.0);
  line.cut = true;
  line.until(State::lost, 1.0);
  line.point = CopterLine::place(100.0, 300.0);
  line.cut = false;
  EXPECT_LE(line.until(State::flying, 1.0), milliseconds{300});
}

TEST(Companion, ThePilotWinsAtOnceUntilTheOperatorResumes) {
  Line line;
  line.until(State::flying, 10.0);
  line.run(1.0);
  line.autopilot.mode = 5;                                        // FBWA
  EXPECT_LE(line.until(State::piloted, 1.0), milliseconds{120});  // HEARTBEAT at 10 Hz and the line
  line.run(0.1);                                                  // what was on the line
  EXPECT_EQ(line.targets_within(2.0), 0U);
  EXPECT_EQ(line.autopilot.mode, 5U);
  line.autopilot.mode = 15;  // not even GUIDED is leave to fly
  EXPECT_EQ(line.targets_within(2.0), 0U);
  line.autopilot.mode = 6;
  EXPECT_THAT(line.warnings, Contains(HasSubstr("FBWA")));
  ASSERT_TRUE(line.companion.give_back(line.now, line.now));
  EXPECT_LE(line.until(State::flying, 2.0), milliseconds{300});
  EXPECT_GT(line.targets_within(0.5), 5U);
  EXPECT_EQ(line.companion.protocol_errors(), 0U);
}

TEST(Companion, ALostLinkIsNoticedWithin100MsAndFlownOnWithin200MsOfItsReturn) {
  Line line;
  line.until(State::flying, 10.0);
  line.run(1.0);
  for (int i = 0; i < 5; ++i) {
    line.run(0.013 * i);
    line.cut = true;
    EXPECT_LE(line.until(State::lost, 1.0), milliseconds{105});
    EXPECT_EQ(line.targets_within(1.0), 0U);
    line.cut = false;
    const Instant back = line.now;
    line.until(State::flying, 1.0);
    line.tick();
    EXPECT_LE(line.now - back, milliseconds{200});
    EXPECT_GT(line.targets_within(0.2), 3U);
  }
  EXPECT_THAT(line.warnings, Contains(HasSubstr("no frame comes")));
}

TEST(Companion, ASilentAutopilotIsToldFromALostLink) {
  Line line;
  line.until(State::flying, 10.0);
  line.run(1.0);
  line.autopilot.mute = true;  // its node is heard all the same
  EXPECT_LE(line.until(State::silent, 1.0), milliseconds{115});
  EXPECT_EQ(line.targets_within(1.0), 0U);
  line.frames = false;
  EXPECT_LE(line.until(State::lost, 1.0), milliseconds{105});
  line.frames = true;
  line.run(0.02);
  EXPECT_EQ(line.companion.state(), State::silent);
  line.autopilot.mute = false;
  EXPECT_LE(line.until(State::flying, 1.0), milliseconds{200});
  EXPECT_EQ(line.companion.protocol_errors(), 0U);
}

TEST(Companion, AModeThatChangedWhileTheLinkWasLostIsThePilots) {
  Line line;
  line.until(State::flying, 10.0);
  line.run(1.0);
  line.cut = true;
  line.run(6.0);
  line.autopilot.mode = 11;  // its failsafe: RTL
  line.cut = false;
  line.until(State::piloted, 1.0);
  EXPECT_EQ(line.companion.state(), State::piloted);
  EXPECT_EQ(line.targets_within(1.0), 0U);
}

TEST(Companion, ARebootedAutopilotIsPreparedAnew) {
  Line line;
  line.until(State::flying, 10.0);
  line.run(1.0);
  const int asked = line.autopilot.count(mavlink::Command::set_message_interval);
  line.cut = true;
  line.run(1.2);
  line.cut = false;
  line.autopilot.reboot(line.now);
  line.autopilot.mute = true;
  line.run(0.1);
  EXPECT_EQ(line.companion.state(), State::silent);
  line.companion.on_reboot(line.now);  // its node's uptime has gone back
  EXPECT_EQ(line.companion.state(), State::searching);
  line.run(3.0);
  EXPECT_FALSE(line.companion.sample());
  line.autopilot.mute = false;
  line.until(State::flying, 6.0);
  EXPECT_EQ(line.companion.state(), State::flying);
  EXPECT_GE(line.autopilot.count(mavlink::Command::set_message_interval), asked + 6);
  EXPECT_THAT(line.warnings, Contains("the autopilot has rebooted"));
  line.run(1.0);
  EXPECT_LE(line.now - line.companion.sample()->state.time, milliseconds{70});
}

TEST(Companion, ARebootedAutopilotIsAskedForItsParametersAgain) {
  Line line;
  line.until(State::flying, 10.0);
  line.autopilot.parameters["FS_GCS_ENABL"] = 0.0F;  // set where nobody heard of it
  line.autopilot.reboot(line.now);
  line.companion.on_reboot(line.now);
  line.run(8.0);
  EXPECT_EQ(line.companion.state(), State::preparing);
  EXPECT_THAT(line.warnings, Contains(HasSubstr("FS_GCS_ENABL")));
  line.autopilot.parameters["FS_GCS_ENABL"] = 1.0F;
  line.until(State::flying, 10.0);
  EXPECT_EQ(line.companion.state(), State::flying);
}

TEST(Companion, TheFirstModeOfARebootedAutopilotIsNotThePilots) {
  Line line;
  line.until(State::flying, 10.0);
  line.run(1.0);
  line.cut = true;
  line.run(0.3);
  line.cut = false;
  line.autopilot.reboot(line.now);  // it says HEARTBEAT alone until streams are asked for
  line.run(0.6);
  EXPECT_EQ(line.targets_within(0.5), 0U);
  line.companion.on_reboot(line.now);  // its node tells its uptime last of all
  line.until(State::flying, 8.0);
  EXPECT_EQ(line.companion.state(), State::flying);
  EXPECT_THAT(line.warnings, Not(Contains(HasSubstr("by the pilot"))));
}

TEST(Companion, ARebootIsSeenInTheClockToo) {
  Line line;
  line.until(State::flying, 10.0);
  line.autopilot.reboot(line.now);
  // Its old streams go on for this test: only the clock tells.
  mavlink::Encoder encoder{1, 1};
  mavlink::Attitude attitude;
  attitude.time_boot_ms = 12;
  line.companion.on_bytes(encoder.encode(attitude), line.now);
  EXPECT_EQ(line.companion.state(), State::searching);
}

TEST(Companion, FallsSilentWhenAnotherNodeHasItsId) {
  Line line;
  line.until(State::flying, 10.0);
  line.companion.on_duplicate(42, line.now);
  EXPECT_EQ(line.companion.state(), State::duplicated);
  EXPECT_FALSE(line.companion.may_send());
  line.sent_at = {};
  line.run(0.5);
  EXPECT_EQ(line.sent_at, Instant{});  // not a heartbeat
  EXPECT_FALSE(line.companion.give_back(line.now, line.now));
  line.run(3.0);
  ASSERT_TRUE(line.companion.give_back(line.now, line.now));
  line.until(State::flying, 10.0);
  EXPECT_EQ(line.companion.state(), State::flying);
  EXPECT_THAT(line.warnings, Contains(HasSubstr("have the id 42")));
  EXPECT_EQ(line.companion.protocol_errors(), 0U);
}

TEST(Companion, PassesRefusalsOnWithTheAutopilotsReason) {
  Line line{params(TakeOver::from_ground)};
  line.autopilot.armed = false;
  line.autopilot.landed = 1;
  line.autopilot.relative_height_m = 0.0;
  line.autopilot.refuses[400] = {1, "Arm: Need Position Estimate"};
  line.run(15.0);
  EXPECT_THAT(line.warnings,
              Contains("the autopilot refuses COMPONENT_ARM_DISARM: temporarily rejected: Arm: "
                       "Need Position Estimate"));
  EXPECT_EQ(line.warnings.size(), 1U);  // the same again is not news
  line.autopilot.refuses.clear();       // and it goes on asking
  line.until(State::climbing, 3.0);
  EXPECT_EQ(line.companion.state(), State::climbing);
}

TEST(Companion, GivesUpWhenGuidedIsRefused) {
  Line line;
  line.autopilot.refuses[176] = {4, ""};
  line.until(State::piloted, 15.0);
  EXPECT_EQ(line.companion.state(), State::piloted);
  EXPECT_EQ(line.autopilot.count(mavlink::Command::do_set_mode), 5);
  EXPECT_THAT(line.warnings, Contains("the autopilot refuses DO_SET_MODE: failed"));
  EXPECT_EQ(line.autopilot.target_times.size(), 0U);
}

TEST(Companion, WorksWithWhatStreamsItGets) {
  Line line;
  line.autopilot.refuses[511] = {2, ""};
  line.run(6.0);
  EXPECT_EQ(line.companion.state(), State::preparing);  // no streams, no state
  EXPECT_THAT(line.warnings,
              Contains(HasSubstr("refuses SET_MESSAGE_INTERVAL: denied (HEARTBEAT)")));
  line.autopilot.refuses.clear();
  line.until(State::flying, 10.0);
  EXPECT_EQ(line.companion.state(), State::flying);
}

TEST(Companion, RefusesWhatIsNotTheAutopilotThatWasConfigured) {
  struct Case {
    std::uint8_t make;
    std::uint8_t type;
    std::uint32_t firmware;
    const char* why;
  };
  for (const Case& c :
       {Case{12, 1, 0x04060300, "not an ArduPilot"}, Case{3, 2, 0x04060300, "which is no plane"},
        Case{3, 1, 0x04040000, "ArduPilot 4.4.0, older than 4.5"}}) {
    Line line;
    line.autopilot.maker = c.make;
    line.autopilot.type = c.type;
    line.autopilot.firmware = c.firmware;
    line.run(8.0);
    EXPECT_EQ(line.companion.state(), State::refused);
    EXPECT_THAT(line.warnings, Contains(HasSubstr(c.why)));
    EXPECT_EQ(line.warnings.size(), 1U);
    EXPECT_EQ(line.autopilot.count(mavlink::Command::do_set_mode), 0);
    EXPECT_EQ(line.companion.protocol_errors(), 0U);
  }
}

TEST(Companion, DoesNotTakeAnAircraftThatDoesNotKnowWhereItIs) {
  Line line;
  line.autopilot.health = ~std::uint32_t{mavlink::sensor_gps};
  line.run(8.0);
  EXPECT_EQ(line.companion.state(), State::standing_by);
  line.autopilot.health = 0xFFFFFFFF;
  line.until(State::flying, 2.0);
  EXPECT_EQ(line.companion.state(), State::flying);
}

TEST(Companion, SendsNoSetpointThatIsOld) {
  Line line;
  line.until(State::flying, 10.0);
  line.run(1.0);
  line.commands = false;
  line.run(0.3);
  EXPECT_EQ(line.targets_within(1.0), 0U);
  EXPECT_GT(line.autopilot.heartbeats, 0);
}

TEST(Companion, SurvivesAnyBytesAndAnyOrderOfEvents) {
  Random random{11};
  for (int round = 0; round < 20; ++round) {
    const bool copter = round % 2 != 0;
    Line line{
        params(static_cast<TakeOver>(round % 3), copter ? Airframe::copter : Airframe::plane)};
    if (copter) {
      line.autopilot.type = 2;
      line.point = CopterLine::place(100.0, -1e3);  // it lands whenever it can
    }
    for (int i = 0; i < 400; ++i) {
      switch (random.index(12)) {
        case 0:
          line.cut = !line.cut;
          break;
        case 1:
          line.autopilot.mode = static_cast<std::uint32_t>(random.index(17));
          break;
        case 2:
          line.autopilot.armed = !line.autopilot.armed;
          break;
        case 3:
          line.autopilot.mute = !line.autopilot.mute;
          break;
        case 4:
          line.companion.on_reboot(line.now);
          break;
        case 5:
          if (random.index(10) == 0) line.companion.on_duplicate(42, line.now);
          break;
        case 6:
          (void)line.companion.give_back(line.now, line.now);
          break;
        case 7:
          line.autopilot.landed = static_cast<std::uint8_t>(random.index(5));
          break;
        case 8: {
          std::vector<std::uint8_t> noise(random.index(60));
          for (auto& byte : noise) byte = static_cast<std::uint8_t>(random.index(256));
          line.companion.on_bytes(noise, line.now);
          break;
        }
        default:
          break;
      }
      line.run(0.01 * static_cast<double>(1 + random.index(30)));
      EXPECT_EQ(line.companion.protocol_errors(), 0U);
    }
  }
}

/// Whatever an autopilot says, with a checksum that holds.
TEST(Companion, SurvivesAnyMessages) {
  Random random{12};
  constexpr std::array<std::uint32_t, 10> kIds{0, 1, 30, 33, 74, 77, 111, 148, 245, 253};
  mavlink::Encoder encoder{1, 1};
  for (int round = 0; round < 12; ++round) {
    const auto take_over = static_cast<TakeOver>(round % 3);
    Line line{params(take_over, round % 2 == 0 ? Airframe::plane : Airframe::copter)};
    if (round % 2 != 0) line.autopilot.type = 2;
    line.run(5.0);
    for (int i = 0; i < 600; ++i) {
      const auto* info = mavlink::find_message(kIds.at(random.index(kIds.size())));
      ASSERT_NE(info, nullptr);
      mavlink::Payload payload{};
      const std::size_t kind = random.index(3);
      for (std::size_t b = 0; b < info->length; ++b) {
        const std::size_t noise = kind == 0 ? random.index(256) : random.index(2) * 255;
        payload.at(b) = static_cast<std::uint8_t>(kind == 2 && b > 3 ? 0 : noise);
      }
      line.companion.on_bytes(encoder.encode(*info, payload), line.now);
      line.run(0.005 * static_cast<double>(random.index(20)));
      const auto sample = line.companion.sample();
      if (!sample) continue;
      EXPECT_LE(sample->state.time, line.now);
      const VehicleState state = carried_to(*sample, line.now);
      EXPECT_TRUE(std::isfinite(state.x_m) && std::isfinite(state.heading_rad));
    }
    EXPECT_EQ(line.companion.protocol_errors(), 0U);
    if (take_over != TakeOver::from_ground) {
      EXPECT_EQ(line.autopilot.count(mavlink::Command::component_arm_disarm), 0);
    }
  }
}

TEST(CompanionTable, ReachesEveryStateUnambiguously) {
  std::set<State> reached{State::searching};
  for (std::size_t i = 0; i < Companion::table().size(); ++i) {
    for (const auto& t : Companion::table()) {
      if (reached.contains(t.from)) reached.insert(t.to);
    }
  }
  EXPECT_EQ(reached.size(), static_cast<std::size_t>(State::count));
  std::set<std::pair<State, Event>> seen;
  for (const auto& t : Companion::table()) {
    EXPECT_TRUE(seen.insert({t.from, t.event}).second)
        << to_string(t.from) << " " << to_string(t.event);
  }
}

/// After a change of a table, paste what this prints into docs/ardupilot.md.
TEST(CompanionTable, IsDrawnInTheDocument) {
  std::ifstream file{SKEIN_SOURCE_DIR "/docs/ardupilot.md"};
  std::stringstream document;
  document << file.rdbuf();
  for (const std::string& diagram :
       {mermaid<State, Event>(Companion::table(), State::searching),
        mermaid<Custody::State, Custody::Event>(Custody::kTable, Custody::State::fresh)}) {
    EXPECT_NE(document.str().find(diagram), std::string::npos) << "docs/ardupilot.md lacks:\n"
                                                               << diagram;
  }
}

TEST(Custody, LaunchesOnceUnasked) {
  using C = Custody;
  C custody;
  EXPECT_TRUE(custody.may_launch());
  custody.fire(C::Event::in_use);  // its launch
  custody.fire(C::Event::launched);
  EXPECT_TRUE(custody.own_flight());
  custody.fire(C::Event::disarmed);
  EXPECT_FALSE(custody.may_launch());
  custody.fire(C::Event::given_back_landed);
  EXPECT_TRUE(custody.may_launch());
}

TEST(Custody, WhatOthersTookStaysTheirsUntilItIsGivenBack) {
  using C = Custody;
  C custody;
  custody.fire(C::Event::launched);
  custody.fire(C::Event::taken_by_others);
  for (const auto event : {C::Event::in_use, C::Event::launched, C::Event::taken_by_others}) {
    custody.fire(event);
    EXPECT_EQ(custody.state(), C::State::taken_ours);
  }
  custody.fire(C::Event::given_back);
  EXPECT_TRUE(custody.own_flight());
  custody.fire(C::Event::taken_by_others);
  custody.fire(C::Event::disarmed);
  EXPECT_TRUE(custody.by_others());
  custody.fire(C::Event::given_back);
  EXPECT_FALSE(custody.own_flight() || custody.may_launch() || custody.by_others());
}

}  // namespace
}  // namespace skein::ardupilot
