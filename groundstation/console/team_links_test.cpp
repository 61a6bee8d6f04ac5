// SPDX-License-Identifier: Apache-2.0
#include "skein/console/team_links.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace skein::console {
namespace {

using mission::Fleet;
using mission::Health;
using mission::Message;
using mission::Telemetry;
using ::testing::HasSubstr;

Telemetry telemetry(std::uint16_t id) {
  Telemetry told;
  told.vehicle = {id};
  told.instance = {id};
  return told;
}

/// Vehicle 1 hears the ground station well, vehicle 2 through others alone and 3 no more; 2 is of
/// an older release; 3 has told nothing.
Fleet fleet() {
  Fleet fleet{{.expected = {{1}, {2}, {3}}}};
  for (const std::uint16_t id : std::initializer_list<std::uint16_t>{1, 2, 3}) {
    fleet.on_message(Message{telemetry(id)}, at_seconds(id == 3 ? 1.0 : 20.0));
  }
  Health health;
  health.vehicle = {1};
  health.instance = {1};
  health.heard = {
      {.vehicle = {2}, .age = std::chrono::milliseconds{200}, .datagrams = 0, .lost_percent = 100},
      {.vehicle = kGroundStation,
       .age = std::chrono::milliseconds{400},
       .datagrams = 95,
       .lost_percent = 5},
      {.vehicle = {3}, .age = std::chrono::seconds{19}, .datagrams = 0, .lost_percent = 255}};
  fleet.on_message(Message{health}, at_seconds(20.0));
  health = {};
  health.vehicle = {2};
  health.instance = {2};
  health.heard = {
      {.vehicle = {1}, .age = std::chrono::seconds{1}, .datagrams = 0, .lost_percent = 255}};
  fleet.on_message(Message{health}, at_seconds(14.0));
  return fleet;
}

const LinkFigures& link(const std::vector<LinkRow>& rows, std::uint16_t who, std::uint16_t whom) {
  const auto row = std::ranges::find(rows, VehicleId{who}, &LinkRow::who);
  return *std::ranges::find(row->hears, VehicleId{whom}, &LinkFigures::whom);
}

TEST(TeamLinks, TellWhoHearsWhomAndHowWell) {
  const auto rows =
      team_links(fleet(), {{{1}, 100, 2, 1234.0}, {{3}, 0, 255, 0.0}}, at_seconds(21.0));
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[0].who, kGroundStation);
  EXPECT_EQ(link(rows, 0, 1).per_s, 10.0);
  EXPECT_EQ(link(rows, 0, 1).lost_percent, 2);
  EXPECT_EQ(link(rows, 0, 1).bytes_per_s, 1234.0);
  EXPECT_FALSE(link(rows, 0, 2).per_s);
  EXPECT_FALSE(link(rows, 0, 3).lost_percent);
  EXPECT_EQ(link(rows, 0, 3).age, std::chrono::seconds{20});
  EXPECT_EQ(link(rows, 1, 0).lost_percent, 5);
  EXPECT_EQ(link(rows, 1, 0).age, std::chrono::milliseconds{1400});  // its word is a second old
  EXPECT_FALSE(rows[3].told_age);
}

TEST(TeamLinks, WhoIsReachedThroughOthersAloneIsToldApart) {
  const auto rows = team_links(fleet(), {{{2}, 0, 100, 0.0}}, at_seconds(21.0));
  EXPECT_TRUE(link(rows, 0, 2).through_others);
  EXPECT_TRUE(link(rows, 1, 2).through_others);
  EXPECT_FALSE(link(rows, 1, 0).through_others);
  EXPECT_FALSE(link(rows, 1, 3).through_others);
  // Nothing comes any more, on whatever way.
  const auto later = team_links(fleet(), {}, at_seconds(60.0));
  EXPECT_FALSE(link(later, 1, 2).through_others);
}

TEST(TeamLinks, WhoIsNotOfTheTeamIsLeftOut) {
  Fleet one{{.expected = {{1}}}};
  Health health;
  health.vehicle = {1};
  health.heard = {{VehicleId{65'535}, std::chrono::seconds{1}, 10, 0},
                  {kGroundStation, std::chrono::seconds{1}, 10, 0}};
  one.on_message(Message{health}, at_seconds(1.0));
  const auto rows = team_links(one, {}, at_seconds(1.0));
  ASSERT_EQ(rows.size(), 2U);
  ASSERT_EQ(rows[1].hears.size(), 1U);
  EXPECT_EQ(rows[1].hears[0].whom, kGroundStation);
}

TEST(TeamLinks, AnOlderReleaseTellsNoLoss) {
  const auto rows = team_links(fleet(), {}, at_seconds(21.0));
  EXPECT_TRUE(rows[1].tells_loss);
  EXPECT_FALSE(rows[2].tells_loss);
  EXPECT_FALSE(link(rows, 2, 1).lost_percent);
}

TEST(TeamLinks, AreToldInWordsAndAsData) {
  const auto rows = team_links(fleet(), {{{1}, 100, 2, 1234.0}}, at_seconds(21.0));
  const std::string text = links_text(rows);
  EXPECT_THAT(text, HasSubstr("ground  1 10.0/s 2 % 1234 B/s, 2, 3 20 s ago\n"));
  EXPECT_THAT(text,
              HasSubstr("1       ground 9.5/s 5 %, 2 0.0/s 100 % through others, 3 20 s ago\n"));
  EXPECT_THAT(text, HasSubstr("2       1 8 s ago; loss is not told; told 7 s ago\n"));
  EXPECT_THAT(text, HasSubstr("3       has not told\n"));
  const auto json = nlohmann::json::parse(links_json(rows));
  EXPECT_EQ(json[0]["hears"][0]["lost_percent"], 2);
  EXPECT_TRUE(json[1]["hears"][1]["through_others"].get<bool>());
  EXPECT_TRUE(json[2]["hears"][0]["per_s"].is_null());
  EXPECT_TRUE(json[3]["told_age_s"].is_null());
}

}  // namespace
}  // namespace skein::console
