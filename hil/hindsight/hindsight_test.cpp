// SPDX-License-Identifier: Apache-2.0
#include "skein/hindsight/hindsight.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <string>

#include "skein/base/angles.hpp"
#include "skein/base/vectors.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/hil/judged_runs.hpp"
#include "skein/hil/team_mission.hpp"

namespace skein::hindsight {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

struct Flown {
  checks::RunRecord record;
  checks::Limits limits;
};

Flown fly(const std::string& scenario, std::uint64_t seed, const std::string& faults = "none") {
  const auto loaded =
      configuration::load_scenario(std::string{SKEIN_SOURCE_DIR} + "/scenarios/" + scenario);
  EXPECT_TRUE(loaded.ok());
  Flown flown{{}, hil::limits_of(loaded->expect)};
  const auto mission = hil::seeded_mission(*loaded, seed, faults);
  EXPECT_TRUE(mission.ok());
  (void)hil::fly_judged(*mission, flown.limits, {}, &flown.record);
  return flown;
}

TEST(Hindsight, NoMissionIsBetterThanItsBound) {
  int compared = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    for (const char* const scenario : {"coalition-6.yaml", "faults-8.yaml"}) {
      const Flown flown = fly(scenario, seed);
      const auto all = look_back(flown.record, flown.limits, 500);
      ASSERT_TRUE(all.ok()) << all.error().message;
      ASSERT_TRUE(all->end_s.bound && all->reward.bound);
      EXPECT_GE(all->end_s.best, *all->end_s.bound - 1e-6);
      EXPECT_LE(all->reward.best, *all->reward.bound + 1e-6);
      EXPECT_LE(*all->reward.flown, *all->reward.bound + 1e-6) << scenario << ", seed " << seed;
      double last_site_s = 0.0;
      for (const SiteFigure& site : all->sites) {
        last_site_s = std::max(last_site_s, *site.end_s.bound);
        EXPECT_GE(site.end_s.flown.value_or(1e9), *site.end_s.bound - 1e-6);
      }
      EXPECT_LE(last_site_s, all->end_s.best + 1e-6) << "with others to serve it is no sooner";
      if (!all->end_s.flown) continue;
      ++compared;
      EXPECT_GE(*all->end_s.flown, *all->end_s.bound - 1e-6) << scenario << ", seed " << seed;
    }
  }
  EXPECT_GT(compared, 30);
}

TEST(Hindsight, WhatAppearsLaterBarsNoWayBefore) {
  Flown flown = fly("coalition-6.yaml", 3);
  const auto before = look_back(flown.record, flown.limits, 500);
  ASSERT_TRUE(before.ok());
  const auto beside = [&flown](Instant known_from) {
    const Vec2 place = flown.record.sites.front().position + Vec2{300.0, 0.0};
    flown.record.hazards.clear();
    flown.record.hazards.push_back({{HazardId{1}, place, 250.0}, known_from});
    return look_back(flown.record, flown.limits, 500);
  };
  const auto later = beside(at_seconds(60.0));
  ASSERT_TRUE(later.ok());
  EXPECT_EQ(later->end_s.best, before->end_s.best);
  const auto always = beside(Instant{});
  EXPECT_TRUE(!always || always->end_s.best != before->end_s.best);
}

TEST(Hindsight, WhatWasNotDoneHasNoTimeAndNoReward) {
  Flown flown = fly("coalition-6.yaml", 3);
  const auto before = look_back(flown.record, flown.limits, 500);
  ASSERT_TRUE(before.ok());
  EXPECT_TRUE(before->end_s.flown);
  for (auto& recorded : flown.record.recordings) recorded.events.clear();
  const auto after = look_back(flown.record, flown.limits, 500);
  ASSERT_TRUE(after.ok());
  EXPECT_FALSE(after->end_s.flown);
  EXPECT_EQ(after->reward.flown, 0.0);
  EXPECT_EQ(after->end_s.best, before->end_s.best) << "it does not depend on what was flown";
}

TEST(Hindsight, BeginsWhereTheVehiclesWereWhenTheMissionBegan) {
  Flown flown = fly("coalition-6.yaml", 3);
  const auto before = look_back(flown.record, flown.limits, 500);
  ASSERT_TRUE(before.ok());
  for (auto& recorded : flown.record.recordings) {
    const auto later = std::ranges::find_if(
        recorded.track, [](const auto& point) { return point.state.time > Instant{}; });
    ASSERT_NE(later, recorded.track.end());
    recorded.track.erase(later + 1, recorded.track.end());
  }
  const auto after = look_back(flown.record, flown.limits, 500);
  ASSERT_TRUE(after.ok());
  EXPECT_NEAR(after->end_s.best, before->end_s.best, 0.1);
}

TEST(Hindsight, IsATableForPeople) {
  const Flown flown = fly("coalition-6.yaml", 3);
  const auto all = look_back(flown.record, flown.limits, 500);
  ASSERT_TRUE(all.ok());
  const auto rows = table_of(*all);
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[2].what, "site 1 alone");
  EXPECT_EQ(rows[0].bound, "proven");
  EXPECT_THAT(text_of(*all), StartsWith("knowing all from the start"));
  EXPECT_THAT(text_of(*all), HasSubstr("last task done"));
}

TEST(Hindsight, SaysWhyNothingIsCompared) {
  EXPECT_THAT(look_back({}, {}).error().message, HasSubstr("no sites"));
  Flown flown = fly("coalition-6.yaml", 3);
  flown.record.recordings.clear();
  EXPECT_THAT(look_back(flown.record, flown.limits).error().message, HasSubstr("no vehicle"));
}

}  // namespace
}  // namespace skein::hindsight
