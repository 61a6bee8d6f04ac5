// SPDX-License-Identifier: Apache-2.0
#include "skein/wording/wording.hpp"

#include <gtest/gtest.h>

#include <set>

namespace skein::wording {
namespace {

using mission::MissionEvent;
namespace event = mission::event;

TEST(Wording, SaysWhoWhatAndWhere) {
  MissionEvent done{{7}, {}, {}, {{1}, TaskKind::deliver, 2}, event::TaskDone{at_seconds(0.4)}};
  EXPECT_EQ(text_of(done), "vehicle 7: task done, site 1 deliver 3: planned for 0.4 s");
  done = {kGroundStation, {}, {}, {}, event::FleetWarning{event::FleetNews::silent, {2}}};
  EXPECT_EQ(text_of(done), "ground station: warning: vehicle 2 is silent");
  done = {{2}, {}, {}, {{4}, TaskKind::survey, 0}, event::CoalitionFormed{10}};
  EXPECT_EQ(text_of(done), "vehicle 2: coalition formed, site 4: 10 vehicles");
}

TEST(Wording, SaysWhyAVehicleFliesHomeAndHowFarThatIs) {
  MissionEvent spent{{3}, {}, {}, {}, event::RangeSpent{1850.2, true, 1599.6, false}};
  EXPECT_EQ(text_of(spent),
            "vehicle 3: warning: flies home: range left 1,850 m, home is 1,600 m away");
  spent.body = event::RangeSpent{12'345'678.0, true, 0.4, true};
  EXPECT_EQ(news_of(spent), "flies home: its battery leaves 12,345,678 m, home is 0 m away");
  spent.body = event::RangeSpent{-999.0, true, -1.0, false};  // of an older release
  EXPECT_EQ(news_of(spent), "flies home: range left -999 m");
  spent.body = event::RangeSpent{-1000.0, false, -1.0, false};
  EXPECT_EQ(news_of(spent), "holds, to be recovered: range left -1,000 m");
}

TEST(Wording, SaysWhoComesTooNearAndWhoGivesWay) {
  MissionEvent near{{3}, {}, {}, {}, {}};
  near.body = event::SeparationWarning{{5}, 2.7, 4.0, std::chrono::seconds{14}, {5}};
  EXPECT_EQ(text_of(near),
            "vehicle 3: warning: vehicle 5 in 14 s: 3 m to the side, 4 m in height; vehicle 5 "
            "gives way by its height");
  near.body = event::SeparationWarning{{5}, 2.7, 4.0, std::chrono::seconds{14}, {}};
  EXPECT_EQ(news_of(near),
            "vehicle 5 in 14 s: 3 m to the side, 4 m in height; neither has room to give way");
  near.body = event::SeparationRestored{{5}};
  EXPECT_EQ(news_of(near), "clear of vehicle 5");
}

TEST(Wording, EveryReasonHasASentenceOfItsOwn) {
  std::set<std::string> sentences;
  const auto count = static_cast<int>(coalition::Reason::count);
  for (int i = 0; i < count; ++i) {
    sentences.insert(text_of(coalition::Why{static_cast<coalition::Reason>(i), {3}, {}}));
  }
  EXPECT_EQ(sentences.size(), static_cast<std::size_t>(count));
  EXPECT_TRUE(sentences.contains(""));  // none
}

TEST(Wording, EveryNoticeOfAnAutopilotHasASentenceOfItsOwn) {
  std::set<std::string> sentences;
  const auto count = static_cast<int>(AutopilotNews::count);
  for (int i = 0; i < count; ++i) {
    sentences.insert(text_of(AutopilotNotice{static_cast<AutopilotNews>(i), 7, {}, {}, "so"}));
  }
  EXPECT_EQ(sentences.size(), static_cast<std::size_t>(count));
}

TEST(Wording, APlannersWordsAreShownForARefusalAndALeaderIsNamed) {
  using enum coalition::Reason;
  EXPECT_EQ(text_of(coalition::Why{no_path, {}, "No path of 3 m"}), "No path of 3 m");
  EXPECT_EQ(text_of(coalition::Why{award_refused, {3}, "No path of 3 m"}),
            "vehicle 3 refused: No path of 3 m");
  EXPECT_EQ(text_of(coalition::Why{superseded, {2}, {}}), "vehicle 2 leads the site");
}

TEST(Wording, AChangeIsNamedByItsOrder) {
  event::ChangeBegun change;
  change.order = mission::OrderKind::form;
  change.shape = formation::ShapeKind::wedge;
  EXPECT_EQ(text_of(change), "form wedge, straight");
  change.correction = true;
  EXPECT_EQ(text_of(change), "correction of form wedge, straight");
}

TEST(Wording, OfManyVehiclesTheFirstAreNamed) {
  std::vector<VehicleId> all;
  for (std::uint16_t id = 1; id <= 1000; ++id) all.push_back({id});
  MissionEvent warning;
  warning.body = mission::formation_warning(event::FormationNews::awaited, all);
  EXPECT_TRUE(news_of(warning).ends_with(", 127, 128 and 872 more")) << news_of(warning);
}

}  // namespace
}  // namespace skein::wording
