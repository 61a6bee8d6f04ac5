// SPDX-License-Identifier: Apache-2.0
#include "skein/paper_routes/route_experiments.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

namespace skein::routes {
namespace {

TEST(RouteExperiments, ASpreadIsOfItsValues) {
  const Spread spread = spread_of({4.0, 1.0, 2.0, 9.0});
  EXPECT_EQ(spread.runs, 4U);
  EXPECT_EQ(spread.least, 1.0);
  EXPECT_EQ(spread.median, 3.0);
  EXPECT_EQ(spread.mean, 4.0);
  EXPECT_EQ(spread.most, 9.0);
  EXPECT_EQ(spread_of({}).runs, 0U);
}

TEST(RouteExperiments, MapsAreComparedAtTheirPlace) {
  const double a = run_map(MapUse::start, ChaoticMap::tent, Counting::evaluations, 1);
  EXPECT_EQ(a, run_map(MapUse::start, ChaoticMap::tent, Counting::evaluations, 1));
  EXPECT_NE(a, run_map(MapUse::convergence, ChaoticMap::tent, Counting::evaluations, 1));
  EXPECT_NE(a, run_map(MapUse::start, ChaoticMap::sine, Counting::evaluations, 1));
  EXPECT_GT(a, 1.0);
}

TEST(RouteExperiments, ContendersHaveNamesAndSpendWhatTheyMay) {
  std::set<std::string> names;
  for (const Contender& contender : contenders()) {
    names.insert(name_of(contender));
    const ConvergenceRun run = run_convergence(contender, Counting::evaluations, 0, 3);
    EXPECT_EQ(run.evaluations, 7'500U) << name_of(contender);
    ASSERT_FALSE(run.progress.empty());
    EXPECT_GE(run.progress.back().best, run.value);
    EXPECT_LE(run.progress.back().evaluations, 7'500U);
  }
  EXPECT_EQ(names.size(), contenders().size());
}

TEST(RouteExperiments, AHeavierWeightGivesLessOfItsCost) {
  std::vector<WeightsRun> runs;
  for (const CostWeights& weights : paper_weights()) {
    runs.push_back(run_weights({.ours = true}, weights, 1));
    EXPECT_EQ(runs.back().curve.size(), 200U);
  }
  for (const WeightsRun& run : runs) {
    EXPECT_LE(runs[0].costs.exposure, run.costs.exposure + 1e-3);
    EXPECT_LE(runs[1].costs.length_ratio, run.costs.length_ratio + 1e-3);
  }
}

TEST(RouteExperiments, OursWinsInRandomWorlds) {
  std::vector<WorldRun> worlds;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    worlds.push_back(run_world(Counting::evaluations, seed, false));
  }
  const WorldSummary summary = summarise(worlds);
  EXPECT_EQ(summary.worlds, 12U);
  EXPECT_GE(summary.ours_over_chaotic.win_rate, 0.75);
  EXPECT_LT(summary.ours_over_wolf.mean_difference, 0.0);
  EXPECT_EQ(summary.ours_mean_gap, 0.0);
}

TEST(RouteExperiments, ATeamIsPlannedAndChecked) {
  const ScaleRun run = run_scale(3, 10, false, 1);
  EXPECT_TRUE(run.planned);
  EXPECT_TRUE(run.checked) << run.reason;
  EXPECT_GE(run.over_bound, 0.0);
  EXPECT_GE(run.separation_m, 20.0 - 1e-3);
}

}  // namespace
}  // namespace skein::routes
