// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "companion_line.hpp"

namespace skein::ardupilot {
namespace {

using State = Companion::State;

TEST(Companion, NeitherArmsNorTakesOffUnasked) {
  for (const TakeOver take_over : {TakeOver::when_guided, TakeOver::in_flight}) {
    Line line{params(take_over)};
    line.autopilot.armed = false;
    line.autopilot.landed = 1;
    line.run(8.0);
    EXPECT_EQ(line.companion.state(), State::standing_by);
    EXPECT_EQ(line.autopilot.count(mavlink::Command::component_arm_disarm), 0);
    EXPECT_EQ(line.autopilot.count(mavlink::Command::do_set_mode), 0);
    EXPECT_FALSE(line.companion.give_back(line.now, line.now));
  }
}

TEST(Companion, TakesOffWhereAsked) {
  Line line{params(TakeOver::from_ground)};
  auto& fc = line.autopilot;
  fc.armed = false;
  fc.landed = 1;
  fc.relative_height_m = 0.0;
  fc.health = ~0x10000000U;  // not yet ready to arm
  line.run(8.0);
  EXPECT_EQ(fc.count(mavlink::Command::component_arm_disarm), 0);
  fc.health = 0xFFFFFFFF;
  line.until(State::climbing, 5.0);
  ASSERT_EQ(line.companion.state(), State::climbing);
  EXPECT_EQ(fc.mode, 13U);  // TAKEOFF
  EXPECT_TRUE(fc.armed);
  line.run(2.0);
  EXPECT_EQ(line.companion.state(), State::climbing);
  fc.landed = 2;
  fc.relative_height_m = 36.9;
  line.commands = false;  // as before the mission
  line.run(2.0);
  EXPECT_EQ(line.companion.state(), State::climbing) << "it would begin its plan too low";
  fc.relative_height_m = 37.1;
  line.until(State::flying, 3.0);
  EXPECT_EQ(fc.mode, 15U);
  line.run(0.5);
  const auto height = fc.last(mavlink::Command::do_change_altitude);
  ASSERT_TRUE(height);
  EXPECT_EQ(height->param1, 40.0F) << "the rest of the climb";
  EXPECT_EQ(height->param2, static_cast<float>(mavlink::Frame::global_relative_alt));
  line.commands = true;
  // Landed and disarmed, it stays there: once was asked for.
  fc.armed = false;
  fc.landed = 1;
  line.run(5.0);
  EXPECT_EQ(line.companion.state(), State::standing_by);
  EXPECT_EQ(fc.count(mavlink::Command::component_arm_disarm), 1);
  EXPECT_EQ(line.companion.protocol_errors(), 0U);
}

}  // namespace
}  // namespace skein::ardupilot
