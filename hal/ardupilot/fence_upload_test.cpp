// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "companion_line.hpp"
#include "mission_upload.hpp"

namespace skein::ardupilot {
namespace {

using State = Companion::State;
using testing::Contains;
using testing::HasSubstr;

CompanionParams fenced() {
  CompanionParams p = params();
  p.fence.corners = {{-2000.0, -2000.0}, {2000.0, -2000.0}, {2000.0, 2000.0}, {-2000.0, 2000.0}};
  p.fence.height_max_m = 400.0;
  return p;
}

struct Fenced : Line {
  Fenced() : Line{fenced()} {
    autopilot.parameters["FENCE_ENABLE"] = 1.0F;
    autopilot.parameters["FENCE_ACTION"] = 1.0F;
    autopilot.parameters["FENCE_TYPE"] = 7.0F;
    autopilot.parameters["FENCE_ALT_MAX"] = 400.0F;
  }
};

TEST(FenceUpload, NothingIsFlownBeforeTheAutopilotHasIt) {
  Fenced line;
  EXPECT_LT(line.until(State::flying, 10.0), std::chrono::seconds{5});
  ASSERT_EQ(line.autopilot.fence.size(), 4U);
  EXPECT_TRUE(line.autopilot.mission.empty());
  const auto origin = MissionOrigin::make(kTestOrigin).value();
  for (std::size_t i = 0; i < 4; ++i) {
    const mavlink::MissionItemInt& item = line.autopilot.fence[i];
    EXPECT_EQ(item.command, 5001);
    EXPECT_EQ(item.param1, 4.0F);
    const Wgs84 at{1e-7 * item.x, 1e-7 * item.y, kTestOrigin.height_m};
    const auto place = origin.to_enu(at);
    EXPECT_NEAR(place.x(), fenced().fence.corners[i].x(), 0.5);
    EXPECT_NEAR(place.y(), fenced().fence.corners[i].y(), 0.5);
  }
  EXPECT_THAT(line.notices, Contains(HasSubstr("the autopilot has the fence: 4 corners")));
}

TEST(FenceUpload, WhatGetsLostIsSaidAgain) {
  Fenced line;
  line.autopilot.deaf_to_mission = 3;
  EXPECT_LT(line.until(State::flying, 20.0), std::chrono::seconds{10});
  EXPECT_EQ(line.autopilot.fence.size(), 4U);
}

TEST(FenceUpload, AnotherOneThanWasGivenKeepsItOnTheGround) {
  Fenced line;
  line.autopilot.spoiled = 2;
  line.run(9.0);
  EXPECT_EQ(line.companion.state(), State::preparing);
  EXPECT_THAT(line.warnings, Contains(HasSubstr("the fence is not the autopilot's: item 2")));
  line.autopilot.spoiled.reset();
  line.run(15.0);
  EXPECT_EQ(line.companion.state(), State::flying) << "it is tried again";
}

TEST(FenceUpload, ARefusalIsToldWithItsNumber) {
  Fenced line;
  line.autopilot.mission_result = 4;  // no space
  line.run(6.0);
  EXPECT_EQ(line.companion.state(), State::preparing);
  EXPECT_THAT(line.warnings, Contains(HasSubstr("refuses the fence (MISSION_ACK 4)")));
}

TEST(FenceUpload, AnAutopilotThatHasStartedAnewIsGivenItAgain) {
  Fenced line;
  line.until(State::flying, 10.0);
  line.autopilot.fence.clear();
  line.autopilot.reboot(line.now);
  line.run(12.0);
  EXPECT_EQ(line.autopilot.fence.size(), 4U);
}

TEST(FenceUpload, ItsParametersAreLookedAtFirst) {
  struct Mistake {
    const char* name;
    float value;
    const char* told;
  };
  const std::vector<Mistake> mistakes{
      {"FENCE_ENABLE", 0.0F, "FENCE_ENABLE is 0, so the autopilot keeps no fence"},
      {"FENCE_ACTION", 0.0F, "FENCE_ACTION is 0, so it only tells what it leaves"},
      {"FENCE_TYPE", 1.0F, "FENCE_TYPE is 1, so it does not keep both"},
      {"FENCE_ALT_MAX", 500.0F, "FENCE_ALT_MAX is 500, so the fence's height is 400 m"},
      {"FENCE_ALT_MAX", 250.0F, "set it to 400"}};
  for (const Mistake& wrong : mistakes) {
    Fenced line;
    line.autopilot.parameters[wrong.name] = wrong.value;
    line.run(6.0);
    EXPECT_EQ(line.companion.state(), State::preparing) << wrong.name;
    EXPECT_THAT(line.warnings, Contains(HasSubstr(wrong.told)));
  }
}

TEST(FenceUpload, OneThatIsOrderedInFlightHasItsParametersLookedAtToo) {
  Line line;
  line.autopilot.parameters["FENCE_ENABLE"] = 0.0F;
  line.autopilot.parameters["FENCE_ACTION"] = 1.0F;
  line.autopilot.parameters["FENCE_TYPE"] = 7.0F;
  ASSERT_LT(line.until(State::flying, 10.0), std::chrono::seconds{5});
  line.companion.keep_fence(fenced().fence);
  line.run(6.0);
  EXPECT_EQ(line.autopilot.fence.size(), 4U);
  EXPECT_THAT(line.warnings, Contains(HasSubstr("FENCE_ENABLE is 0, so the autopilot keeps no")));
  EXPECT_EQ(line.companion.state(), State::flying) << "it is flown on with";
}

}  // namespace
}  // namespace skein::ardupilot
