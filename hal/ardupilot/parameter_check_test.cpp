// SPDX-License-Identifier: Apache-2.0
#include "parameter_check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <sstream>

#include "companion_line.hpp"

namespace skein::ardupilot {
namespace {

using State = Companion::State;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(ParameterCheck, AsksUntilEachIsGood) {
  ParameterCheck check{safety_questions(test_vehicle(), 7, {})};
  EXPECT_THAT(check.due(at_seconds(0.0)),
              ElementsAre("FS_GCS_ENABL", "FS_LONG_ACTN", "SYSID_MYGCS", "MAV_GCS_SYSID"));
  EXPECT_THAT(check.due(at_seconds(0.1)), IsEmpty());
  check.on_value("FS_GCS_ENABL", 2.0F);
  check.on_value("FS_LONG_ACTN", 1.0F);
  check.on_value("ARMING_CHECK", 0.0F);
  EXPECT_THAT(check.due(at_seconds(0.6)), ElementsAre("SYSID_MYGCS", "MAV_GCS_SYSID"));
  EXPECT_FALSE(check.good());
  check.on_value("MAV_GCS_SYSID", 7.0F);  // of a later release
  EXPECT_TRUE(check.good());
  EXPECT_THAT(check.due(at_seconds(9.0)), IsEmpty());
  EXPECT_FALSE(check.poll_finding(at_seconds(9.0)));
  check.begin();
  EXPECT_FALSE(check.good()) << "another autopilot";
}

TEST(ParameterCheck, SaysWhatIsWrongAndWhatToSet) {
  ParameterCheck check{safety_questions(test_vehicle(), 7, {})};
  check.on_value("FS_GCS_ENABL", 0.0F);
  check.on_value("FS_LONG_ACTN", 1.0F);
  check.on_value("SYSID_MYGCS", 255.0F);
  EXPECT_EQ(check.poll_finding(at_seconds(0.0)),
            "FS_GCS_ENABL is 0, so the autopilot flies on when the companion falls silent; set it "
            "to 1 or 2");
  EXPECT_THAT(check.poll_finding(at_seconds(0.0)).value_or(""), HasSubstr("set it to 7"));
  EXPECT_FALSE(check.poll_finding(at_seconds(59.0))) << "once";
  EXPECT_TRUE(check.poll_finding(at_seconds(61.0))) << "who comes later is told, too";
  EXPECT_THAT(check.due(at_seconds(70.0)),
              ElementsAre("FS_GCS_ENABL", "FS_LONG_ACTN", "SYSID_MYGCS"))
      << "one may be wrong by another";
}

TEST(ParameterCheck, NoAnswerIsSaidAfterSeveralQuestions) {
  ParameterCheck check{safety_questions(test_vehicle(Airframe::copter), 1, {})};
  check.on_value("SYSID_MYGCS", 1.0F);
  double t = 0.0;
  for (; !check.poll_finding(at_seconds(t)); t += 0.1) {
    (void)check.due(at_seconds(t));
    ASSERT_LT(t, 5.0);
  }
  EXPECT_GT(t, 1.5);
}

TEST(ParameterCheck, TakesAnyBytesForWhatTheyAre) {
  ParameterCheck check{safety_questions(test_vehicle(Airframe::copter), 1, {})};
  check.on_value("", 1.0F);
  check.on_value("FS_GCS_ENABLEX", 1.0F);
  check.on_value("SYSID_MYGCS", 1.0F);
  for (const float value : {std::numeric_limits<float>::quiet_NaN(), 1e38F, 1.5F, -1.0F, 2.0F}) {
    check.on_value("FS_GCS_ENABLE", value);
    EXPECT_FALSE(check.good()) << value;
  }
  check.on_value("FS_GCS_ENABLE", 5.0F);
  EXPECT_TRUE(check.good());
}

TEST(CompanionParameters, NothingIsFlownUntilTheyAreGood) {
  Line line;
  line.autopilot.parameters["FS_LONG_ACTN"] = 0.0F;
  line.run(8.0);
  EXPECT_EQ(line.companion.state(), State::preparing);
  EXPECT_THAT(line.warnings,
              ElementsAre("the aircraft is not flown with the autopilot's parameters: FS_LONG_ACTN "
                          "is 0, so the autopilot flies on when the companion falls silent; set it "
                          "to 1"));
  EXPECT_TRUE(line.autopilot.attitudes.empty());
  line.autopilot.parameters["FS_LONG_ACTN"] = 1.0F;
  EXPECT_LT(line.until(State::flying, 10.0), std::chrono::seconds{5}) << "no new start is needed";
}

TEST(CompanionParameters, AreAskedForAgainWhereQuestionsGetLost) {
  Line line;
  line.autopilot.deaf_to_parameters = 9;
  EXPECT_LT(line.until(State::flying, 10.0), std::chrono::seconds{5});
}

TEST(CompanionParameters, OfAnAutopilotThatDoesNotTellNothingIsFlown) {
  Line line;
  line.autopilot.parameters.erase("SYSID_MYGCS");
  line.run(8.0);
  EXPECT_EQ(line.companion.state(), State::preparing);
  EXPECT_THAT(line.warnings, Contains(HasSubstr("it does not tell SYSID_MYGCS, which must be 1")));
}

TEST(CompanionParameters, OneThatIsChangedInFlightIsToldAndFlownOn) {
  Line line;
  line.until(State::flying, 10.0);
  ASSERT_EQ(line.companion.state(), State::flying);
  line.autopilot.set_parameter("FS_GCS_ENABL", 0.0F);
  line.run(2.0);
  EXPECT_THAT(line.warnings, Contains(HasSubstr("was changed: FS_GCS_ENABL is 0")));
  EXPECT_EQ(line.companion.state(), State::flying);
}

/// After a change of the tables, paste what this prints into docs/ardupilot.md.
TEST(ParameterCheck, IsInTheDocument) {
  std::ifstream file{SKEIN_SOURCE_DIR "/docs/ardupilot.md"};
  std::stringstream document;
  document << file.rdbuf();
  for (const Airframe airframe : {Airframe::plane, Airframe::copter, Airframe::quadplane}) {
    for (const SafetyParameter& parameter : traits_of(airframe).safety) {
      const std::string good = parameter.good.empty()
                                   ? "the vehicle's own SYSID_THISMAV"
                                   : fmt::format("{}", fmt::join(parameter.good, " or "));
      const std::string later =
          parameter.later_name.empty() ? "" : fmt::format(" (later {})", parameter.later_name);
      const std::string row = fmt::format("| {} | {}{} | {} | {} |\n", to_string(airframe),
                                          parameter.name, later, good, parameter.why);
      EXPECT_NE(document.str().find(row), std::string::npos) << "docs/ardupilot.md lacks:\n" << row;
    }
  }
}

}  // namespace
}  // namespace skein::ardupilot
