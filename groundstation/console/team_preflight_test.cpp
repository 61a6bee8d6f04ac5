// SPDX-License-Identifier: Apache-2.0
#include "skein/console/team_preflight.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace skein::console {
namespace {

using mission::CheckGroup;
using mission::CheckVerdict;
using mission::Preflight;
using ::testing::HasSubstr;
using ::testing::Not;

/// A fleet of three, and short words for what it hears.
struct Team {
  mission::Fleet fleet{{.expected = {{1}, {2}, {3}}}};

  void speak(VehicleId vehicle, double seconds, std::uint64_t instance = 1) {
    mission::Telemetry telemetry;
    telemetry.vehicle = vehicle;
    telemetry.instance = {instance};
    telemetry.state.time = at_seconds(seconds);
    fleet.on_message(mission::Message{telemetry}, at_seconds(seconds));
  }
  void hear(const Preflight& told, double seconds) {
    speak(told.vehicle, seconds, told.instance.value);
    fleet.on_message(mission::Message{told}, at_seconds(seconds));
  }
  [[nodiscard]] TeamPreflight at(double seconds) {
    fleet.on_timeout(at_seconds(seconds));
    return team_preflight(fleet, at_seconds(seconds));
  }
};

Preflight good(VehicleId vehicle) {
  Preflight told;
  told.vehicle = vehicle;
  told.instance = {1};
  told.complete = true;
  told.release = "1.0";
  told.firmware = "4.6.3";
  told.parameters = 0xABC;
  told.configuration = 0xDEF;
  told.counts = {{CheckGroup::clock, 3, 0, 0}, {CheckGroup::parameters, 7, 0, 0}};
  return told;
}

Preflight failing(VehicleId vehicle) {
  Preflight told = good(vehicle);
  told.counts[1].failed = 1;
  told.lines = {{CheckGroup::parameters, CheckVerdict::fail, "FS_LONG_ACTN", "not told", "set it"}};
  return told;
}

TEST(TeamPreflight, CountsWhoIsReadyAndNamesWhoIsNot) {
  Team team;
  EXPECT_EQ(team.at(0.0).summary,
            "0 of 3 ready, 3 not: 1 (never heard), 2 (never heard), 3 (never heard)");
  team.hear(good({1}), 1.0);
  team.hear(failing({2}), 1.0);
  team.speak({3}, 1.0);
  EXPECT_EQ(team.at(1.0).summary, "1 of 3 ready, 2 not: 2 (parameters), 3 (has not told yet)");
  team.hear(good({2}), 2.0);
  team.hear(good({3}), 2.0);
  EXPECT_EQ(team.at(2.0).summary, "3 of 3 ready");
  Preflight flying = failing({3});
  flying.in_flight = true;
  team.hear(flying, 3.0);
  EXPECT_EQ(team.at(3.0).summary, "2 of 3 ready, 1 armed or in the air");
}

TEST(TeamPreflight, NothingIsGoodThatIsNotHeardNow) {
  Team team;
  team.hear(good({1}), 1.0);
  EXPECT_TRUE(team.at(2.0).rows[0].counts);
  EXPECT_FALSE(team.at(6.5).rows[0].counts);  // silent
  EXPECT_EQ(team.at(6.5).rows[0].readiness, Readiness::not_ready);
  EXPECT_EQ(team.at(6.5).rows[0].why, "silent");
  team.speak({1}, 7.0);
  EXPECT_EQ(team.at(7.0).rows[0].readiness, Readiness::ready);
  team.speak({1}, 76.5);  // it is heard, but has not told for long
  EXPECT_EQ(team.at(76.5).rows[0].why, "has not told lately");
  EXPECT_EQ(team.at(76.5).rows[0].readiness, Readiness::not_known);
}

TEST(TeamPreflight, AVehicleThatKnowsNoPlaceYetIsHeardAllTheSame) {
  Team team;
  mission::Health health;  // and no telemetry, while its flight controller tells no state
  health.vehicle = {1};
  health.instance = {1};
  team.fleet.on_message(mission::Message{health}, at_seconds(1.0));
  EXPECT_EQ(team.at(1.0).rows[0].why, "has not told yet");
  team.fleet.on_message(mission::Message{failing({1})}, at_seconds(2.0));
  EXPECT_EQ(team.at(2.0).rows[0].why, "parameters");
  EXPECT_EQ(team.at(6.0).rows[0].why, "silent");
}

TEST(TeamPreflight, WhatAnEarlierStartHasToldDoesNotCount) {
  Team team;
  team.hear(good({1}), 1.0);
  team.speak({1}, 10.0, 2);
  EXPECT_EQ(team.at(10.0).rows[0].why, "has not told yet");
  Preflight again = good({1});
  again.instance = {2};
  team.hear(again, 11.0);
  EXPECT_EQ(team.at(11.0).rows[0].readiness, Readiness::ready);
}

TEST(TeamPreflight, AGroupThatWasNotToldIsNeverGood) {
  Team team;
  Preflight first = good({1});
  first.complete = false;
  first.counts.pop_back();
  team.hear(first, 1.0);
  auto row = team.at(1.0).rows[0];
  const auto parameters = static_cast<std::size_t>(CheckGroup::parameters);
  EXPECT_EQ(row.marks.at(parameters), CheckMark::not_known);
  EXPECT_EQ(row.readiness, Readiness::not_known);
  first.complete = true;
  team.hear(first, 2.0);
  row = team.at(2.0).rows[0];
  EXPECT_EQ(row.marks.at(parameters), CheckMark::not_looked_at);
  EXPECT_EQ(row.readiness, Readiness::ready);
}

TEST(TeamPreflight, TheOddOneOutIsMarkedAmongThoseOfItsKind) {
  Team team;
  team.hear(good({1}), 1.0);
  team.hear(good({2}), 1.0);
  Preflight other = good({3});
  other.firmware = "4.5.7";
  other.parameters = 0x123;
  team.hear(other, 1.0);
  auto rows = team.at(1.0).rows;
  EXPECT_TRUE(rows[2].odd.firmware && rows[2].odd.parameters);
  EXPECT_FALSE(rows[2].odd.release || rows[2].odd.configuration);
  EXPECT_FALSE(rows[0].odd.firmware || rows[1].odd.parameters);
  other.copter = true;  // its parameters are not a plane's
  other.configuration = 0x456;
  team.hear(other, 2.0);
  rows = team.at(2.0).rows;
  EXPECT_FALSE(rows[2].odd.firmware || rows[2].odd.parameters);
  EXPECT_TRUE(rows[2].odd.configuration);
}

TEST(TeamPreflight, OfTwoThatDifferNobodyKnowsWhichIsRight) {
  Team team;
  team.hear(good({1}), 1.0);
  Preflight other = good({2});
  other.configuration = 0x456;
  team.hear(other, 1.0);
  const auto rows = team.at(1.0).rows;
  EXPECT_TRUE(rows[0].odd.configuration);
  EXPECT_TRUE(rows[1].odd.configuration);
}

TEST(TeamPreflight, ThePromptHasTheWordsOfTheCheckOnBoard) {
  Team team;
  team.hear(good({1}), 1.0);
  Preflight told = failing({2});
  told.lines.push_back({CheckGroup::clock, CheckVerdict::warn, "time source", "none", "start one"});
  told.parameters = 0x77;
  team.hear(told, 1.0);
  const auto all = preflight_text(team.at(4.0), at_seconds(4.0));
  EXPECT_THAT(all, HasSubstr("1 of 3 ready, 2 not: 2 (parameters), 3 (never heard)\n"));
  EXPECT_THAT(all, HasSubstr("FAIL  FS_LONG_ACTN: not told; set it\n"));
  EXPECT_THAT(all, HasSubstr("00000077*"));
  EXPECT_THAT(all, Not(HasSubstr("time source")));
  const auto one = preflight_text(team.at(4.0), {2}, at_seconds(4.0)).value();
  EXPECT_THAT(one, HasSubstr("warn  time source: none; start one\n"));
  EXPECT_THAT(one, HasSubstr("ok: clock 3, parameters 7\n"));
  EXPECT_FALSE(preflight_text(team.at(4.0), {9}, at_seconds(4.0)));
  EXPECT_THAT(preflight_text(team.at(7.0), {2}, at_seconds(7.0)).value(),
              HasSubstr("as it was told last:"));
}

TEST(TeamPreflight, ThePageIsGivenWhatItDraws) {
  Team team;
  team.hear(failing({2}), 1.5);
  const auto json = nlohmann::json::parse(preflight_json(team.at(2.0)));
  EXPECT_EQ(json["groups"].size(), kCheckGroups);
  EXPECT_EQ(json["groups"][9], "GNSS");
  const auto& first = json["vehicles"][0];
  EXPECT_TRUE(first["told_s"].is_null());
  EXPECT_EQ(first["marks"][0], "not_known");
  const auto& second = json["vehicles"][1];
  EXPECT_EQ(second["readiness"], "not_ready");
  EXPECT_EQ(second["why"], "parameters");
  EXPECT_EQ(second["told_s"], 1.5);
  EXPECT_EQ(second["marks"][0], "ok");
  EXPECT_EQ(second["marks"][8], "fail");
  EXPECT_EQ(second["marks"][1], "not_looked_at");
  EXPECT_EQ(second["parameters"], "00000abc");
  EXPECT_EQ(second["lines"][0]["verdict"], "fail");
  EXPECT_EQ(second["lines"][0]["remedy"], "set it");
}

}  // namespace
}  // namespace skein::console
