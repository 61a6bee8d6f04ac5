// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "companion_line.hpp"
#include "parameter_check.hpp"
#include "skein/ardupilot/flight_limits.hpp"

namespace skein::ardupilot {
namespace {

using State = Companion::State;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// test_vehicle(): 50 m/s within 150 m takes 59.5 degrees; 42.5 to 57.5 m/s.

TEST(LimitCheck, AsksByBothNamesUntilItIsTold) {
  ParameterCheck check{limit_questions(test_vehicle())};
  EXPECT_THAT(check.due(at_seconds(0.0)), SizeIs(10));
  check.on_value("LIM_ROLL_CD", 6000.0F);
  check.on_value("AIRSPEED_MIN", 40.0F);
  check.on_value("AIRSPEED_MAX", 60.0F);
  check.on_value("TECS_SPDWEIGHT", 1.0F);
  check.on_value("STALL_PREVENTION", 0.0F);
  EXPECT_FALSE(check.good());
  EXPECT_THAT(check.due(at_seconds(1.0)), ElementsAre("AIRSPEED_CRUISE", "TRIM_ARSPD_CM"));
  check.on_value("TRIM_ARSPD_CM", 5000.0F);
  EXPECT_TRUE(check.good());
  EXPECT_THAT(check.due(at_seconds(2.0)), IsEmpty());
}

TEST(LimitCheck, WhatAFirmwareDoesNotKnowKeepsNobodyOnTheGround) {
  ParameterCheck check{limit_questions(test_vehicle())};
  int questions = 0;
  for (double t = 0.0; !check.good(); t += 0.1) {
    questions += check.due(at_seconds(t)).empty() ? 0 : 1;
    ASSERT_LT(t, 5.0);
  }
  EXPECT_EQ(questions, 4);
}

TEST(LimitCheck, ACopterClimbsAndSinksAsFastAsThePlacesOfAFormation) {
  VehicleSpec copter = test_vehicle(Airframe::copter);
  copter.cruise_speed_mps = 3.0;
  copter.capabilities = {};
  ParameterCheck check{limit_questions(copter)};
  check.on_value("WPNAV_SPEED_UP", 250.0F);
  check.on_value("WP_SPD_DN", 1.5F);
  EXPECT_THAT(
      check.findings(),
      ElementsAre("WPNAV_SPEED_UP is 250; it climbs at 2.5 m/s at most, and its places at up to "
                  "cruise_speed_mps, 3: set WPNAV_SPEED_UP to 300 or more, or cruise_speed_mps to "
                  "2.5 or less",
                  HasSubstr("it sinks at 1.5 m/s at most, and its places at up to "
                            "cruise_speed_mps, 3: set WP_SPD_DN to 3.0 or more")));
  check.on_value("WPNAV_SPEED_UP", 300.0F);
  check.on_value("WP_SPD_DN", 3.0F);
  EXPECT_TRUE(check.good());
  copter.capabilities.add(TaskKind::survey);
  ParameterCheck of_a_coalition{limit_questions(copter)};
  of_a_coalition.on_value("WPNAV_SPEED_UP", 250.0F);
  of_a_coalition.on_value("WPNAV_SPEED_DN", 150.0F);
  EXPECT_TRUE(of_a_coalition.good());
}

TEST(LimitCheck, StallPreventionLeavesLessBankNearTheLeastAirspeed) {
  EXPECT_DOUBLE_EQ(prevented_bank_deg(20.0, 20.0), 25.0);
  EXPECT_DOUBLE_EQ(prevented_bank_deg(20.5, 20.0), 25.0);
  EXPECT_NEAR(prevented_bank_deg(20.0 * std::sqrt(2.0), 20.0), 60.0, 1e-9);
  // 42.5 m/s within 150 m takes 50.8 degrees: 33.8 m/s at most.
  // 50 m/s within it takes 59.5 degrees: 35.6 m/s.
  const auto judge = [](double least_mps, std::optional<double> prevented = 1.0) {
    return judge_limit(test_vehicle(), kAirspeedMin, "AIRSPEED_MIN", least_mps, prevented);
  };
  using Verdict = LimitFinding::Verdict;
  EXPECT_EQ(judge(33.7).verdict, Verdict::good);
  const LimitFinding late = judge(34.5);
  EXPECT_EQ(late.verdict, Verdict::differs) << "it can turn, but not while it waits";
  EXPECT_THAT(late.remedy, HasSubstr("set AIRSPEED_MIN to 33.7 or less"));
  EXPECT_THAT(late.remedy, HasSubstr("degrees at 42.5 m/s"));
  const LimitFinding finding = judge(40.0);
  EXPECT_EQ(finding.verdict, Verdict::refused);
  EXPECT_THAT(finding.remedy, HasSubstr("set AIRSPEED_MIN to 35.6 or less"));
  EXPECT_THAT(finding.remedy, HasSubstr("no more than 50 degrees at 50 m/s"));
  EXPECT_EQ(judge(40.0, 0.0).verdict, Verdict::good);
  EXPECT_EQ(judge(40.0, std::nullopt).verdict, Verdict::differs) << "it may not have it";
}

TEST(LimitCheck, StallPreventionThatIsSwitchedOffIsEnough) {
  ParameterCheck check{limit_questions(test_vehicle())};
  check.on_value("AIRSPEED_MIN", 40.0F);
  EXPECT_THAT(check.findings(), IsEmpty());
  check.on_value("STALL_PREVENTION", 1.0F);
  EXPECT_THAT(check.findings(),
              ElementsAre(HasSubstr("set AIRSPEED_MIN to 35.6 or less, or STALL_PREVENTION to 0")));
  EXPECT_THAT(check.due(at_seconds(0.0)), Contains("STALL_PREVENTION"));
  check.on_value("STALL_PREVENTION", 0.0F);
  EXPECT_THAT(check.findings(), IsEmpty());
}

TEST(LimitCheck, RefusesWhatCannotBeFlownOnceAMinute) {
  ParameterCheck check{limit_questions(test_vehicle())};
  check.on_value("ROLL_LIMIT_DEG", 45.0F);
  EXPECT_EQ(check.poll_finding(at_seconds(0.0)),
            "ROLL_LIMIT_DEG is 45: at 50 m/s it turns within 255 m; turn_radius_m is 150: set "
            "ROLL_LIMIT_DEG to 65.0 (60.0 at least), or turn_radius_m to 255 or more");
  EXPECT_FALSE(check.poll_finding(at_seconds(59.0)));
  EXPECT_TRUE(check.poll_finding(at_seconds(61.0)));
  check.on_value("ROLL_LIMIT_DEG", std::numeric_limits<float>::quiet_NaN());
  EXPECT_THAT(check.findings(), SizeIs(1));
  check.on_value("ROLL_LIMIT_DEG", 60.0F);
  EXPECT_THAT(check.findings(), IsEmpty());
}

TEST(CompanionLimits, NothingIsFlownUntilTheBankLimitAllowsTheTurns) {
  Line line;
  line.autopilot.parameters["ROLL_LIMIT_DEG"] = 45.0F;
  line.run(5.0);
  EXPECT_EQ(line.companion.state(), State::preparing);
  EXPECT_THAT(line.warnings, Contains(HasSubstr("set ROLL_LIMIT_DEG to 65.0 (60.0 at least)")));
  line.autopilot.set_parameter("ROLL_LIMIT_DEG", 60.0F);
  EXPECT_LT(line.until(State::flying, 5.0), std::chrono::seconds{5});
}

}  // namespace
}  // namespace skein::ardupilot
