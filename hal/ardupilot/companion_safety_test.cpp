// SPDX-License-Identifier: Apache-2.0
// The pilot wins at once and for good, and nothing arms unasked: whatever happens in between.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "companion_line.hpp"

namespace skein::ardupilot {
namespace {

using State = Companion::State;
using mavlink::Command;
using std::chrono::milliseconds;
using testing::Contains;
using testing::HasSubstr;

void put_on_ground(AutopilotDouble& fc) {
  fc.armed = false;
  fc.landed = 1;
  fc.relative_height_m = 0.0;
  fc.truth.airspeed_mps = 0.0;
  fc.truth.groundspeed_mps = 0.0;
}
void put_in_air(AutopilotDouble& fc) {
  fc.armed = true;
  fc.landed = 2;
  fc.relative_height_m = 300.0;
  fc.truth.airspeed_mps = 50.0;
  fc.truth.groundspeed_mps = 50.0;
}
bool give_back(Line& line) { return line.companion.give_back(line.now, line.now); }

/// It restarts, and is prepared anew.
void reboot(Line& line) {
  line.autopilot.reboot(line.now);
  line.companion.on_reboot(line.now);
  line.run(6.0);
}

struct FromGround : Line {
  FromGround() : Line{params(TakeOver::from_ground)} { put_on_ground(autopilot); }
  void expect_never_armed(double seconds) {
    const int before = autopilot.count(Command::component_arm_disarm);
    const int modes = autopilot.count(Command::do_set_mode);
    run(seconds);
    EXPECT_EQ(autopilot.count(Command::component_arm_disarm), before);
    EXPECT_EQ(autopilot.count(Command::do_set_mode), modes);
    EXPECT_EQ(companion.protocol_errors(), 0U);
  }
};

TEST(CompanionSafety, LaunchesAnAutopilotThatReturnedOnTheGroundForWantOfACompanion) {
  FromGround line;
  line.autopilot.mode = 11;
  line.autopilot.armable_in = [](std::uint32_t mode) { return mode != 11; };
  line.until(State::climbing, 12.0);
  EXPECT_EQ(line.companion.state(), State::climbing);
}

TEST(CompanionSafety, LeavesTheModeOfOneThatIsUnfitForAnotherReason) {
  FromGround line;
  line.autopilot.mode = 5;
  line.autopilot.armable_in = [](std::uint32_t) { return false; };
  line.expect_never_armed(12.0);
  EXPECT_EQ(line.autopilot.mode, 5U);
}

TEST(CompanionSafety, DoesNotLaunchAfterAFlightThatItHasFoundUnderWay) {
  FromGround line;
  put_in_air(line.autopilot);
  line.run(6.0);
  EXPECT_EQ(line.companion.state(), State::standing_by);
  EXPECT_THAT(line.warnings, Contains(HasSubstr("it is not launched unless")));
  put_on_ground(line.autopilot);
  line.expect_never_armed(6.0);
  EXPECT_EQ(line.companion.state(), State::standing_by);
}

TEST(CompanionSafety, DoesNotLaunchAfterAFlightByHand) {
  FromGround line;
  line.autopilot.health = ~0x10000000U;  // it may not arm yet
  line.run(6.0);
  ASSERT_EQ(line.companion.state(), State::standing_by);
  put_in_air(line.autopilot);
  line.run(3.0);
  line.autopilot.health = 0xFFFFFFFF;
  put_on_ground(line.autopilot);
  line.expect_never_armed(6.0);
}

TEST(CompanionSafety, DoesNotLaunchWhatItHearsInTheAirThoughDisarmed) {
  FromGround line;
  line.autopilot.landed = 3;
  line.run(6.0);
  line.autopilot.landed = 1;
  line.expect_never_armed(6.0);
}

TEST(CompanionSafety, ALaunchThatTheCrewAbortsIsNotTriedAgainAfterAReboot) {
  FromGround line;
  line.autopilot.refuses[400] = {1, "Arm: Need Position Estimate"};
  line.until(State::arming, 8.0);
  line.run(1.5);
  ASSERT_EQ(line.autopilot.mode, 13U);
  line.autopilot.mode = 0;
  line.until(State::piloted, 0.5);
  ASSERT_EQ(line.companion.state(), State::piloted);
  line.autopilot.refuses.clear();
  const int asked = line.autopilot.count(Command::component_arm_disarm);
  reboot(line);
  EXPECT_EQ(line.companion.state(), State::standing_by);
  line.expect_never_armed(6.0);
  EXPECT_EQ(line.autopilot.count(Command::component_arm_disarm), asked);
  // But when the operator says so.
  ASSERT_TRUE(give_back(line));
  line.until(State::climbing, 5.0);
  EXPECT_EQ(line.companion.state(), State::climbing);
}

TEST(CompanionSafety, TheOperatorGivesItBackOnTheGroundToBeLaunchedAgain) {
  FromGround line;
  line.autopilot.refuses[400] = {1, ""};
  line.until(State::arming, 8.0);
  line.autopilot.mode = 5;
  line.until(State::piloted, 1.0);
  line.autopilot.armed = true;  // by the crew, on the ground
  line.run(0.5);
  EXPECT_FALSE(give_back(line));
  line.autopilot.armed = false;
  line.run(0.5);
  line.autopilot.refuses.clear();
  ASSERT_TRUE(give_back(line));
  line.until(State::climbing, 5.0);
  EXPECT_EQ(line.companion.state(), State::climbing);
}

TEST(CompanionSafety, AnAutopilotThatDoesNotArmIsTriedAgainWhenTheOperatorSaysSo) {
  FromGround line;
  line.autopilot.refuses[400] = {1, ""};
  line.run(75.0);
  EXPECT_EQ(line.companion.state(), State::standing_by);
  EXPECT_THAT(line.warnings, Contains(HasSubstr("does not arm")));
  line.autopilot.refuses.clear();
  line.expect_never_armed(3.0);
  ASSERT_TRUE(give_back(line));
  line.until(State::climbing, 5.0);
  EXPECT_EQ(line.companion.state(), State::climbing);
}

TEST(CompanionSafety, ALinkThatIsLostWhileArmingBreaksTheLaunchOff) {
  FromGround line;
  line.autopilot.refuses[400] = {1, ""};
  line.until(State::arming, 8.0);
  line.run(1.5);
  line.cut = true;
  line.run(0.5);
  line.cut = false;
  line.autopilot.refuses.clear();
  line.until(State::standing_by, 1.0);
  line.expect_never_armed(4.0);
  EXPECT_THAT(line.warnings, Contains(HasSubstr("the launch was broken off")));
}

TEST(CompanionSafety, DoesNotTakeAFlightByHandAfterItsOwn) {
  FromGround line;
  line.until(State::climbing, 10.0);
  put_in_air(line.autopilot);
  line.until(State::flying, 3.0);
  put_on_ground(line.autopilot);
  line.until(State::standing_by, 1.0);
  line.autopilot.mode = 5;
  put_in_air(line.autopilot);  // by its pilot
  line.expect_never_armed(5.0);
  EXPECT_EQ(line.autopilot.mode, 5U);
  ASSERT_TRUE(give_back(line));
  line.until(State::flying, 2.0);
  EXPECT_EQ(line.companion.state(), State::flying);
}

TEST(CompanionSafety, WhileArmingThePilotsModeWinsBeforeTheOwnWasSeen) {
  FromGround line;
  line.autopilot.refuses[176] = {4, ""};  // the mode for take-off is refused
  line.until(State::arming, 8.0);
  line.autopilot.mode = 2;
  EXPECT_LE(line.until(State::piloted, 1.0), milliseconds{120});
  line.autopilot.refuses.clear();
  line.expect_never_armed(5.0);
}

TEST(CompanionSafety, WhileArmingAnAircraftThatOthersArmIsTheirs) {
  FromGround line;
  line.autopilot.refuses[176] = {4, ""};
  line.until(State::arming, 8.0);
  line.autopilot.armed = true;
  EXPECT_LE(line.until(State::piloted, 1.0), milliseconds{120});
  EXPECT_THAT(line.warnings, Contains(HasSubstr("armed by others")));
}

TEST(CompanionSafety, WhileArmingAnAircraftThatIsInTheAirIsNotLaunched) {
  FromGround line;
  line.autopilot.refuses[400] = {1, ""};
  line.until(State::arming, 8.0);
  line.autopilot.landed = 2;
  EXPECT_LE(line.until(State::piloted, 1.0), milliseconds{700});
}

TEST(CompanionSafety, AClimbThatDoesNotEndIsThePilots) {
  FromGround line;
  line.until(State::climbing, 10.0);
  line.autopilot.landed = 2;
  line.autopilot.relative_height_m = 30.0;  // TKOFF_ALT is lower than what is waited for
  line.run(50.0);
  // A link that is lost in between does not make it longer, nor a climb of another's mode.
  line.cut = true;
  line.run(1.0);
  line.cut = false;
  line.until(State::climbing, 1.0);
  ASSERT_EQ(line.companion.state(), State::climbing);
  line.until(State::piloted, 60.0);
  EXPECT_EQ(line.companion.state(), State::piloted);
  EXPECT_THAT(line.warnings, Contains(HasSubstr("TKOFF_ALT")));
  ASSERT_TRUE(give_back(line));
  line.until(State::flying, 2.0);
  EXPECT_EQ(line.companion.state(), State::flying);
}

TEST(CompanionSafety, AModeThatChangedInALossWhileClimbingIsThePilots) {
  FromGround line;
  line.until(State::climbing, 10.0);
  line.cut = true;
  line.run(1.0);
  put_in_air(line.autopilot);
  line.autopilot.mode = 6;
  line.cut = false;
  line.until(State::piloted, 1.0);
  EXPECT_EQ(line.companion.state(), State::piloted);
  line.run(3.0);
  EXPECT_EQ(line.autopilot.mode, 6U);
}

TEST(CompanionSafety, AModeThatChangedInALossWhileTakingOverIsThePilots) {
  Line line;
  line.autopilot.refuses[176] = {4, ""};
  line.until(State::taking_over, 10.0);
  line.run(0.3);
  line.cut = true;
  line.run(1.0);
  line.autopilot.mode = 6;
  line.autopilot.refuses.clear();
  line.cut = false;
  line.until(State::piloted, 1.0);
  EXPECT_EQ(line.companion.state(), State::piloted);
}

/// A pilot's takeover outlives what happens to the link and to the autopilot.
TEST(CompanionSafety, WhatThePilotTookStaysThePilotsThroughRebootsAndLosses) {
  const auto while_linked = [](Line& line) { reboot(line); };
  const auto in_a_loss = [](Line& line) {
    line.cut = true;
    line.run(1.0);
    ASSERT_EQ(line.companion.state(), State::lost);
    line.cut = false;
    reboot(line);
  };
  const auto in_silence = [](Line& line) {
    line.autopilot.mute = true;
    line.run(1.0);
    ASSERT_EQ(line.companion.state(), State::silent);
    line.autopilot.mute = false;
    reboot(line);
  };
  const auto in_a_duplicate = [](Line& line) {
    line.companion.on_duplicate(42, line.now);
    line.run(3.0);
    ASSERT_TRUE(give_back(line));  // the ids are mended: it says no more than that
    line.run(6.0);
  };
  const std::vector<std::function<void(Line&)>> all{while_linked, in_a_loss, in_silence,
                                                    in_a_duplicate};
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (const TakeOver take_over : {TakeOver::in_flight, TakeOver::when_guided}) {
      SCOPED_TRACE(i);
      Line line{params(take_over)};
      line.autopilot.mode = 15;
      line.until(State::flying, 10.0);
      line.autopilot.mode = 6;
      line.until(State::piloted, 1.0);
      const int asked = line.autopilot.count(Command::do_set_mode);
      all[i](line);
      EXPECT_EQ(line.companion.state(), State::standing_by);
      EXPECT_THAT(line.warnings, Contains(HasSubstr("until the operator gives it back")));
      line.autopilot.mode = 15;  // even in GUIDED
      EXPECT_EQ(line.targets_within(2.0), 0U);
      EXPECT_EQ(line.autopilot.count(Command::do_set_mode), asked);
      ASSERT_TRUE(give_back(line));
      line.until(State::flying, 2.0);
      EXPECT_EQ(line.companion.state(), State::flying);
      EXPECT_EQ(line.companion.protocol_errors(), 0U);
    }
  }
}

TEST(CompanionSafety, AModeThatChangesWhileAnIdIsDuplicatedIsThePilots) {
  Line line;
  line.until(State::flying, 10.0);
  line.companion.on_duplicate(42, line.now);
  line.run(1.0);
  line.autopilot.mode = 6;
  line.run(3.0);
  ASSERT_TRUE(give_back(line));
  line.run(6.0);
  EXPECT_EQ(line.companion.state(), State::standing_by);
  EXPECT_EQ(line.autopilot.mode, 6U);
}

TEST(CompanionSafety, AWordThatIsOlderThanTheTakeoverGivesNothingBack) {
  Line line;
  line.until(State::flying, 10.0);
  const Instant issued = line.now;
  line.run(1.0);
  line.autopilot.mode = 5;
  line.until(State::piloted, 1.0);
  EXPECT_FALSE(line.companion.give_back(line.now, issued));
  EXPECT_EQ(line.companion.state(), State::piloted);
  line.tick();
  EXPECT_THAT(line.warnings, Contains(HasSubstr("taken after the operator's word")));
  reboot(line);
  EXPECT_FALSE(line.companion.give_back(line.now, issued));
  EXPECT_TRUE(give_back(line));
}

TEST(CompanionSafety, NeitherTakesNorIsGivenAnAircraftWithoutAGnss) {
  for (const std::uint32_t missing : {mavlink::sensor_gps, mavlink::sensor_ahrs}) {
    for (const bool enabled : {true, false}) {
      Line line;
      line.autopilot.health = ~missing;
      if (!enabled) line.autopilot.enabled = ~missing;  // as an ArduPilot without a GNSS says it
      line.run(8.0);
      EXPECT_EQ(line.companion.state(), State::standing_by);
      EXPECT_FALSE(give_back(line));
      line.autopilot.health = line.autopilot.enabled = 0xFFFFFFFF;
      line.until(State::flying, 2.0);
      EXPECT_EQ(line.companion.state(), State::flying);
    }
  }
}

}  // namespace
}  // namespace skein::ardupilot
