// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/judged_runs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "skein/hil/team_mission.hpp"

namespace skein::hil {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

configuration::Scenario small() {
  auto scenario =
      configuration::load_scenario(std::string{SKEIN_SOURCE_DIR} + "/scenarios/coalition-6.yaml");
  EXPECT_TRUE(scenario) << scenario.error().message;
  return *scenario;
}

JudgedRun fly(const configuration::Scenario& scenario, std::uint64_t seed,
              const std::string& faults = "none") {
  const auto mission = seeded_mission(scenario, seed, faults);
  EXPECT_TRUE(mission) << mission.error().message;
  return fly_judged(*mission, limits_of(scenario.expect));
}

std::vector<std::string> names(const JudgedRun& run) {
  std::vector<std::string> names;
  for (const auto& check : run.broken) names.push_back(check.name);
  return names;
}

TEST(JudgedRuns, TheSmallMissionHolds) {
  const auto run = fly(small(), 1);
  EXPECT_THAT(names(run), IsEmpty());
  EXPECT_TRUE(run.sites_done);
}

TEST(JudgedRuns, AMissionThatIsNotFinishedIsFound) {
  auto scenario = small();
  scenario.duration_max = std::chrono::seconds{20};
  const auto run = fly(scenario, 1);
  EXPECT_FALSE(run.sites_done);
  EXPECT_THAT(names(run), ElementsAre("completion"));
}

TEST(JudgedRuns, TheJudgesHoldAMissionToTheScenariosLimits) {
  auto scenario = small();
  scenario.expect.miss_distance_m = 0.0;
  EXPECT_THAT(names(fly(scenario, 1)), ElementsAre("deliveries"));
}

TEST(JudgedRuns, ASeriesIsTheSameForAnyNumberOfThreads) {
  auto scenario = small();
  scenario.wind.gust_mps = 1.0;
  scenario.radio.loss_ratio = 0.2;
  std::size_t told = 0;
  const auto alone = fly_series(scenario, {"none", 5, 6, 1}, [&](const JudgedRun&) { ++told; });
  const auto shared = fly_series(scenario, {"none", 5, 6, 3});
  EXPECT_EQ(told, 6U);
  ASSERT_EQ(alone.size(), 6U);
  ASSERT_EQ(shared.size(), 6U);
  for (std::size_t i = 0; i < alone.size(); ++i) {
    EXPECT_EQ(alone[i].seed, 5 + i);
    EXPECT_EQ(alone[i].seed, shared[i].seed);
    EXPECT_EQ(alone[i].result.ended_at, shared[i].result.ended_at);
    EXPECT_EQ(alone[i].result.messages, shared[i].result.messages);
    EXPECT_EQ(names(alone[i]), names(shared[i]));
  }
}

TEST(JudgedRuns, TheSummaryCounts) {
  std::vector<JudgedRun> runs(3);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    runs[i].sites_done = i < 2;
    runs[i].result.ended_at = at_seconds(10.0 * static_cast<double>(i + 1));
  }
  runs[2].broken = {{"leases", "", 1, "", "", {{VehicleId{1}, {}, "twice"}}}};
  const auto summary = summarise(runs);
  EXPECT_EQ(summary.runs, 3U);
  EXPECT_EQ(summary.held, 2U);
  EXPECT_EQ(summary.finished, 2U);
  EXPECT_DOUBLE_EQ(summary.time_min_s, 10.0);
  EXPECT_DOUBLE_EQ(summary.time_mean_s, 15.0);
  EXPECT_DOUBLE_EQ(summary.time_max_s, 20.0);
  ASSERT_EQ(summary.broken.size(), 1U);
  EXPECT_EQ(summary.broken[0].check, "leases");
  EXPECT_EQ(summary.broken[0].runs, 1U);
}

}  // namespace
}  // namespace skein::hil
