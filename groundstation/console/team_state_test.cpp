// SPDX-License-Identifier: Apache-2.0
#include "skein/console/team_state.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace skein::console {
namespace {

using mission::Activity;
using mission::ActivityDetail;
using testing::ElementsAre;
using testing::HasSubstr;

class TeamStateTest : public testing::Test {
 protected:
  void hear(std::uint16_t id, Activity activity, ActivityDetail detail, double time_s = 10.0) {
    mission::Telemetry said;
    said.vehicle = {id};
    said.instance = {id};
    said.state.time = at_seconds(time_s);
    said.activity = activity;
    said.detail = detail;
    fleet_.on_message(mission::Message{said}, at_seconds(time_s));
  }
  void all(Activity activity, ActivityDetail detail) {
    for (const std::uint16_t id : std::initializer_list<std::uint16_t>{1, 2, 3})
      hear(id, activity, detail);
  }
  [[nodiscard]] std::vector<TeamState> states(double time_s = 10.0, bool nobody = false) {
    fleet_.on_timeout(at_seconds(time_s));
    std::vector<TeamState> all;
    for (const auto& row : team_state(fleet_, {nobody}, at_seconds(time_s))) {
      EXPECT_FALSE(row.title.empty());
      EXPECT_FALSE(row.means.empty());
      all.push_back(row.state);
    }
    return all;
  }

  mission::Fleet fleet_{{.expected = {VehicleId{1}, VehicleId{2}, VehicleId{3}}}};
};

TEST_F(TeamStateTest, IsNormalWhereAllDoTheirPart) {
  EXPECT_THAT(states(-5.0), ElementsAre(TeamState::normal)) << "they are still to come";
  all(Activity::searching, ActivityDetail::none);
  EXPECT_THAT(states(), ElementsAre(TeamState::normal));
}

TEST_F(TeamStateTest, NamesWhoCannotDoItsPart) {
  hear(1, Activity::searching, ActivityDetail::none);
  hear(2, Activity::holding, ActivityDetail::range_reserve);
  const auto rows = team_state(fleet_, {}, at_seconds(10.0));
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].state, TeamState::degraded);
  EXPECT_THAT(rows[0].vehicles, ElementsAre(VehicleId{2}, VehicleId{3}))
      << "one at its reserve, one never heard";
  EXPECT_THAT(team_text(rows), HasSubstr("Degraded: 2, 3"));
  EXPECT_THAT(team_json(rows), HasSubstr(R"("vehicles":[2,3])"));
}

TEST_F(TeamStateTest, TellsHeldAndRecallOfAllFromThoseOfSome) {
  all(Activity::holding, ActivityDetail::ordered);
  EXPECT_THAT(states(), ElementsAre(TeamState::held));
  hear(1, Activity::searching, ActivityDetail::none, 11.0);
  EXPECT_THAT(states(11.0), ElementsAre(TeamState::part_held));
  all(Activity::holding, ActivityDetail::returning);
  EXPECT_THAT(states(), ElementsAre(TeamState::part_recall))
      << "what is older than the newest word of vehicle 1 is passed over";
  for (const std::uint16_t id : std::initializer_list<std::uint16_t>{1, 2, 3}) {
    hear(id, Activity::holding, ActivityDetail::returning, 12.0);
  }
  EXPECT_THAT(states(12.0), ElementsAre(TeamState::recall));
  hear(1, Activity::landed, ActivityDetail::on_ground, 13.0);
  EXPECT_THAT(states(13.0), ElementsAre(TeamState::recall));
  for (const std::uint16_t id : std::initializer_list<std::uint16_t>{2, 3})
    hear(id, Activity::landed, ActivityDetail::on_ground, 13.0);
  EXPECT_THAT(states(13.0), ElementsAre(TeamState::on_ground));
}

TEST_F(TeamStateTest, ALostLinkComesBeforeWhatItHides) {
  all(Activity::holding, ActivityDetail::ordered);
  EXPECT_THAT(states(16.0), ElementsAre(TeamState::lost_link, TeamState::degraded));
  EXPECT_THAT(states(16.0, true),
              ElementsAre(TeamState::no_command, TeamState::lost_link, TeamState::degraded));
  hear(2, Activity::searching, ActivityDetail::none, 17.0);
  EXPECT_THAT(states(17.0), ElementsAre(TeamState::degraded));
}

TEST_F(TeamStateTest, WhoIsSilentOnTheGroundIsNotMissed) {
  hear(1, Activity::searching, ActivityDetail::none, 10.0);
  hear(2, Activity::searching, ActivityDetail::none, 10.0);
  hear(3, Activity::landed, ActivityDetail::on_ground, 3.0);
  EXPECT_THAT(states(), ElementsAre(TeamState::normal));
}

TEST_F(TeamStateTest, WhoDoesNotGiveWayToAnAircraftIsNotNormal) {
  all(Activity::searching, ActivityDetail::none);
  const auto tell = [&](std::uint16_t id, mission::EventBody body) {
    fleet_.on_message(mission::MissionEvent{{id}, at_seconds(10.0), {}, {}, std::move(body)},
                      at_seconds(10.0));
  };
  tell(2, mission::event::TrafficWarning{0xabc, 100, 20, {}, true});
  EXPECT_THAT(states(), ElementsAre(TeamState::keeps_clear));
  tell(2, mission::event::TrafficWarning{0xdef, 100, 20, {}, false});
  tell(3, mission::event::TrafficWarning{0xabc, 100, 20, {}, true});
  EXPECT_THAT(states(), ElementsAre(TeamState::in_the_way, TeamState::keeps_clear));
  tell(2, mission::event::TrafficClear{0xdef});
  EXPECT_THAT(states(), ElementsAre(TeamState::keeps_clear));
  tell(2, mission::event::TrafficClear{0xabc});
  tell(3, mission::event::TrafficClear{0xabc});
  EXPECT_THAT(states(), ElementsAre(TeamState::normal));
}

TEST_F(TeamStateTest, WhoHoldsByOrderIsHeldWhileItKeepsClear) {
  all(Activity::holding, ActivityDetail::avoiding_traffic);
  EXPECT_THAT(states(), ElementsAre(TeamState::normal));
  for (const std::uint16_t id : std::initializer_list<std::uint16_t>{1, 2, 3}) {
    fleet_.on_message(
        mission::MissionEvent{
            {id}, at_seconds(10.0), {}, {}, mission::event::Commanded{mission::CommandKind::hold}},
        at_seconds(10.0));
  }
  EXPECT_THAT(states(), ElementsAre(TeamState::held));
}

}  // namespace
}  // namespace skein::console
