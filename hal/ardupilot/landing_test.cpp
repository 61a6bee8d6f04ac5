// SPDX-License-Identifier: Apache-2.0
#include "skein/domain/landing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "companion_line.hpp"
#include "mission_upload.hpp"

namespace skein::ardupilot {
namespace {

using State = Companion::State;
using mavlink::Command;
using testing::Contains;
using testing::HasSubstr;

constexpr std::uint32_t kAuto = 10;
constexpr std::uint32_t kGuided = 15;
constexpr std::uint32_t kRtl = 11;
constexpr Landing kLanding{.x_m = 200.0,
                           .y_m = 100.0,
                           .heading_rad = 0.0,
                           .approach_m = 600.0,
                           .approach_height_m = 40.0,
                           .radius_m = 165.0};

std::uint16_t number_of(Command command) { return static_cast<std::uint16_t>(command); }

struct Landed : Line {
  Landed() {
    until(State::flying, 10.0);
    setpoint.landing = kLanding;
  }
};

TEST(Landing, IsUploadedReadBackAndFlownInAuto) {
  Landed line;
  EXPECT_LT(line.until(State::landing, 5.0), std::chrono::seconds{2});
  line.run(1.0);
  EXPECT_EQ(line.autopilot.mode, kAuto);
  ASSERT_EQ(line.autopilot.mission.size(), 4U);
  EXPECT_EQ(line.autopilot.mission[1].command, number_of(Command::do_land_start));
  EXPECT_EQ(line.autopilot.mission[2].command, number_of(Command::nav_loiter_to_alt));
  EXPECT_FLOAT_EQ(line.autopilot.mission[2].param2, -165.0F);
  EXPECT_FLOAT_EQ(line.autopilot.mission[2].z, 40.0F);
  EXPECT_EQ(line.autopilot.mission[3].command, number_of(Command::nav_land));
  const auto begun = line.autopilot.last(Command::do_set_mission_current);
  ASSERT_TRUE(begun);
  EXPECT_EQ(begun->param1, 2.0F);
  EXPECT_EQ(line.companion.sample()->state.phase, FlightPhase::landing);
  EXPECT_EQ(line.targets_within(1.0), 0U);  // the autopilot flies
  EXPECT_EQ(line.companion.protocol_errors(), 0U);
}

TEST(Landing, ThePlacesOfItsItemsAreThoseOfTheLanding) {
  const auto origin = MissionOrigin::make(kTestOrigin).value();
  const auto items = landing_mission(kLanding, mavlink::Command::nav_land, origin);
  const auto at = [&](std::size_t item) {
    return origin
        .to_enu({static_cast<double>(items[item].x) * 1e-7,
                 static_cast<double>(items[item].y) * 1e-7, kTestOrigin.height_m})
        .horizontal();
  };
  EXPECT_LT((at(3) - Vec2{200.0, 100.0}).norm(), 0.1);
  EXPECT_LT((at(1) - Vec2{-400.0, 100.0}).norm(), 0.1);
  EXPECT_LT((at(2) - Vec2{-400.0, 265.0}).norm(), 0.1);  // the circle touches the approach
}

TEST(Landing, EndsLandedThenDisarmedAndIsNotLaunchedAgain) {
  Landed line;
  line.until(State::landing, 5.0);
  line.run(1.0);
  line.autopilot.landed = 1;
  line.run(1.0);
  EXPECT_EQ(line.companion.sample()->state.phase, FlightPhase::landed);
  EXPECT_EQ(line.companion.state(), State::landing);
  line.autopilot.armed = false;
  line.run(1.0);
  EXPECT_EQ(line.companion.state(), State::standing_by);
  EXPECT_EQ(line.companion.sample()->state.phase, FlightPhase::disarmed);
  EXPECT_TRUE(line.autopilot.mission.empty());  // with it an ArduPlane would not arm again
  line.run(10.0);
  EXPECT_EQ(line.companion.state(), State::standing_by);
  EXPECT_EQ(line.autopilot.count(Command::component_arm_disarm), 0);
}

TEST(Landing, WhatIsLostIsSaidAgain) {
  Landed line;
  line.autopilot.deaf_to_mission = 1;  // the count
  EXPECT_LT(line.until(State::landing, 10.0), std::chrono::seconds{4});
  line.run(1.0);
  EXPECT_EQ(line.autopilot.mode, kAuto);
}

TEST(Landing, IsNotFlownWhereItIsReadBackAsAnother) {
  Landed line;
  line.autopilot.spoiled = 3;
  line.run(5.0);
  EXPECT_EQ(line.companion.state(), State::flying);
  EXPECT_EQ(line.autopilot.mode, kGuided);
  EXPECT_GE(line.targets_within(2.0), 40U);  // its orbit goes on
  EXPECT_THAT(line.warnings, Contains(HasSubstr("is another one when it is read back")));
  line.autopilot.spoiled.reset();
  line.until(State::landing, 20.0);
  EXPECT_EQ(line.companion.state(), State::landing);
}

TEST(Landing, IsNotFlownWhereTheAutopilotRefusesIt) {
  Landed line;
  line.autopilot.mission_result = 3;
  line.run(5.0);
  EXPECT_EQ(line.companion.state(), State::flying);
  EXPECT_THAT(line.warnings, Contains(HasSubstr("MISSION_ACK 3")));
}

TEST(Landing, ASetpointWithoutItHasItGoAround) {
  Landed line;
  line.until(State::landing, 5.0);
  line.run(1.0);
  line.autopilot.relative_height_m = 30.0;
  line.run(0.5);
  line.setpoint.landing.reset();
  line.until(State::flying, 5.0);
  EXPECT_EQ(line.companion.state(), State::flying);
  EXPECT_EQ(line.autopilot.mode, kGuided);
  EXPECT_GE(line.targets_within(2.0), 40U);
  const auto height = line.autopilot.last(Command::do_change_altitude);
  ASSERT_TRUE(height);
  EXPECT_TRUE(line.warnings.empty()) << line.warnings.front();
  line.setpoint.landing = kLanding;  // again, by a mission that is given anew
  line.autopilot.mission.clear();
  line.until(State::landing, 5.0);
  EXPECT_EQ(line.companion.state(), State::landing);
  EXPECT_EQ(line.autopilot.mission.size(), 4U);
}

TEST(Landing, CloseToTheGroundItLandsWhateverIsOrdered) {
  Landed line;
  line.until(State::landing, 5.0);
  line.run(1.0);
  line.autopilot.relative_height_m = 5.0;
  line.run(0.5);
  line.setpoint.landing.reset();
  line.run(5.0);
  EXPECT_EQ(line.companion.state(), State::landing);
  EXPECT_EQ(line.autopilot.mode, kAuto);
  EXPECT_THAT(line.warnings, Contains(HasSubstr("below 10 m")));
}

TEST(Landing, ThePilotsModeIsThePilots) {
  Landed line;
  line.until(State::landing, 5.0);
  line.run(1.0);
  line.autopilot.mode = kRtl;
  line.run(1.0);
  EXPECT_EQ(line.companion.state(), State::piloted);
  line.run(5.0);
  EXPECT_EQ(line.autopilot.mode, kRtl);
}

TEST(Landing, ALostControlLoopDoesNotCallItOff) {
  Landed line;
  line.until(State::landing, 5.0);
  line.run(1.0);
  line.setpoint.landing.reset();
  line.commands = false;
  line.run(5.0);
  EXPECT_EQ(line.companion.state(), State::landing);
}

TEST(Landing, GoesOnAfterALossOfTheLink) {
  Landed line;
  line.until(State::landing, 5.0);
  line.run(1.0);
  line.cut = true;
  line.run(1.0);
  EXPECT_EQ(line.companion.state(), State::lost);
  line.cut = false;
  line.until(State::landing, 5.0);
  line.run(2.0);
  EXPECT_EQ(line.companion.state(), State::landing);
  EXPECT_EQ(line.autopilot.mode, kAuto);
}

}  // namespace
}  // namespace skein::ardupilot
