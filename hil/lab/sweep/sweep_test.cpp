// SPDX-License-Identifier: Apache-2.0
#include "skein/experiments/sweep.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace skein::experiments {
namespace {

using ::testing::HasSubstr;

constexpr auto kTiny = R"(
version: 1
title: Try
scenario: coalition-6.yaml
runs: 3
axes:
  - name: method
    points:
      - {label: ours}
      - {label: "poly, nomial", allocation: polynomial}
  - name: margin
    points:
      - {label: short, formation_margin_s: 0.3}
      - {label: long, formation_margin_s: 1}
)";

class Sweeps : public ::testing::Test {
 protected:
  Sweeps() {
    std::string name = (std::filesystem::temp_directory_path() / "skein-sweep-XXXXXX").string();
    if (::mkdtemp(name.data()) != nullptr) root_ = name;
    const auto base =
        configuration::load_scenario(std::string{SKEIN_SOURCE_DIR} + "/scenarios/coalition-6.yaml");
    EXPECT_TRUE(base);
    base_ = *base;
    const auto experiment = configuration::parse_experiment(kTiny, "tiny.yaml");
    EXPECT_TRUE(experiment) << experiment.error().message;
    experiment_ = *experiment;
  }
  void TearDown() override { std::filesystem::remove_all(root_); }

  /// Flies until `runs` are flown, or all, and writes the results.
  SweepOutcome fly(const std::string& folder, std::size_t jobs = 1, std::size_t runs = 1000,
                   const shards::Shard& shard = {}) {
    SweepOptions options;
    options.shard = shard;
    options.folder = root_ / folder;
    options.jobs = jobs;
    std::size_t flown = 0;
    options.on_done = [&](const Measures&) { ++flown; };
    options.stopped = [&] { return flown >= runs; };
    auto table = RunTable::open(options.folder, experiment_, base_, shard);
    EXPECT_TRUE(table) << table.error().message;
    const auto outcome = sweep(experiment_, base_, options, *table);
    EXPECT_TRUE(outcome) << outcome.error().message;
    EXPECT_TRUE(write_results(experiment_, *table, options.folder));
    return *outcome;
  }
  [[nodiscard]] std::string text(const std::filesystem::path& file) const {
    std::ifstream in{root_ / file, std::ios::binary};
    return {std::istreambuf_iterator<char>{in}, {}};
  }

  std::filesystem::path root_;
  configuration::Scenario base_;
  configuration::Experiment experiment_;
};

TEST_F(Sweeps, FlyEveryCellAndSumUp) {
  const auto outcome = fly("a");
  EXPECT_EQ(outcome.wanted, 12U);
  EXPECT_EQ(outcome.present, 12U);
  EXPECT_EQ(outcome.flown, 12U);
  const std::string cells = text("a/cells.csv");
  EXPECT_THAT(cells, HasSubstr("method,margin,measure,runs,mean,half_width_95,deviation\n"));
  EXPECT_THAT(cells, HasSubstr("\nours,short,tasks_done,3,6,0,0\n"));
  EXPECT_THAT(cells, HasSubstr("\n\"poly, nomial\",long,safe,3,1,0,0\n"));
  EXPECT_THAT(text("a/value.svg"), HasSubstr("margin long"));
  const auto table = RunTable::open(root_ / "a", experiment_, base_);
  EXPECT_THAT(text_table(experiment_, *table), HasSubstr("poly, nomial"));
}

TEST_F(Sweeps, GiveTheSameWithAnyNumberOfJobs) {
  fly("one", 1);
  fly("three", 3);
  EXPECT_EQ(text("one/cells.csv"), text("three/cells.csv"));
  EXPECT_EQ(text("one/runs.csv"), text("three/runs.csv"));
}

TEST_F(Sweeps, AreTheSameInShards) {
  fly("whole");
  const auto second = fly("2", 1, 1000, {2, 2});
  EXPECT_EQ(second.wanted, 6U);
  EXPECT_EQ(second.flown, 6U);
  EXPECT_EQ(fly("1", 1, 2, {1, 2}).present, 2U);  // interrupted
  {
    auto table = RunTable::open(root_ / "merged", experiment_, base_);
    ASSERT_TRUE(table);
    for (const char* folder : {"2", "1"}) ASSERT_TRUE(table->take_over(root_ / folder));
    const auto lacking = missing(experiment_, *table);
    ASSERT_EQ(lacking.size(), 4U);
    EXPECT_EQ(lacking.front().number, 4U);
    EXPECT_EQ(lacking.front().seed, 2U);
    EXPECT_EQ(fly("1", 1, 1000, {1, 2}).flown, 4U);
    ASSERT_TRUE(table->take_over(root_ / "1"));
    ASSERT_TRUE(table->sort());
    EXPECT_TRUE(missing(experiment_, *table).empty());
    ASSERT_TRUE(write_results(experiment_, *table, root_ / "merged"));
    EXPECT_TRUE(all_safe(experiment_, *table));
  }
  EXPECT_EQ(text("merged/runs.csv"), text("whole/runs.csv"));
  EXPECT_EQ(text("merged/cells.csv"), text("whole/cells.csv"));
  EXPECT_EQ(text("merged/value.svg"), text("whole/value.svg"));
}

TEST_F(Sweeps, OfDifferentExperimentsAreToldApart) {
  fly("a", 1, 1);
  experiment_.title = "Another";
  experiment_.runs = 2;
  fly("b", 1, 1);
  EXPECT_TRUE(same_experiment(root_ / "a", root_ / "b"));
  EXPECT_THAT(text("b/experiment.yaml"), HasSubstr("Another"));
  experiment_.axes[1].points[0].settings.formation_margin_s = 0.4;
  fly("c", 1, 1);
  const auto differ = same_experiment(root_ / "a", root_ / "c");
  ASSERT_FALSE(differ);
  EXPECT_THAT(differ.error().message, HasSubstr("/a/experiment.yaml and "));
  EXPECT_THAT(differ.error().message, HasSubstr("/c/experiment.yaml differ"));
}

TEST_F(Sweeps, GoOnWhereTheyWereInterrupted) {
  fly("whole");
  EXPECT_EQ(fly("cut", 1, 5).present, 5U);
  EXPECT_NE(text("cut/cells.csv"), text("whole/cells.csv"));
  // The first draws of all four cells come first.
  EXPECT_THAT(text("cut/cells.csv"), HasSubstr("\n\"poly, nomial\",long,safe,1,1,,\n"));
  std::ofstream{root_ / "cut/runs.csv", std::ios::app} << "ours,short,7,0.5,0.";  // half a row
  EXPECT_EQ(fly("cut").flown, 7U);
  EXPECT_EQ(text("cut/cells.csv"), text("whole/cells.csv"));
  EXPECT_EQ(text("cut/runs.csv"), text("whole/runs.csv"));
  EXPECT_EQ(fly("cut").flown, 0U);
}

TEST_F(Sweeps, AddDrawsAndCountOnlyThoseAskedFor) {
  experiment_.runs = 1;
  fly("less");
  const std::string one = text("less/cells.csv");
  experiment_.runs = 2;
  EXPECT_EQ(fly("less").flown, 4U);
  experiment_.runs = 1;
  EXPECT_EQ(fly("less").flown, 0U);
  EXPECT_EQ(text("less/cells.csv"), one);
}

TEST_F(Sweeps, RefuseMissionsOfRoutesAndOfFormations) {
  const auto refused = [&](const std::string& scenario) {
    const auto base =
        configuration::load_scenario(std::string{SKEIN_SOURCE_DIR} + "/scenarios/" + scenario);
    EXPECT_TRUE(base);
    auto table = RunTable::open(root_ / scenario, experiment_, *base);
    EXPECT_TRUE(table);
    SweepOptions options;
    options.folder = root_ / scenario;
    const auto outcome = sweep(experiment_, *base, options, *table);
    return outcome ? std::string{"none"} : outcome.error().message;
  };
  EXPECT_THAT(refused("routes-3.yaml"), HasSubstr("planned routes, which `skein-hil run` alone"));
  EXPECT_THAT(refused("formation-5.yaml"), HasSubstr("fly a formation"));
}

TEST_F(Sweeps, RefuseAFolderOfAnotherExperiment) {
  fly("a", 1, 1);
  experiment_.title = "Another title is the same experiment";
  EXPECT_TRUE(RunTable::open(root_ / "a", experiment_, base_));
  auto longer = base_;
  longer.duration_max += std::chrono::seconds{1};
  const auto other_scenario = RunTable::open(root_ / "a", experiment_, longer);
  ASSERT_FALSE(other_scenario);
  EXPECT_THAT(other_scenario.error().message, HasSubstr("the scenario has changed"));
  experiment_.axes[1].points[0].settings.formation_margin_s = 0.4;
  const auto changed = RunTable::open(root_ / "a", experiment_, base_);
  ASSERT_FALSE(changed);
  EXPECT_THAT(changed.error().message, HasSubstr("the experiment has changed"));
  EXPECT_THAT(changed.error().message, HasSubstr("--out"));
}

TEST_F(Sweeps, TellOfARowThatIsNoRun) {
  fly("a", 1, 1);
  std::ofstream{root_ / "a/runs.csv", std::ios::app} << "ours,short,2,nonsense\n";
  const auto table = RunTable::open(root_ / "a", experiment_, base_);
  ASSERT_FALSE(table);
  EXPECT_THAT(table.error().message, HasSubstr("runs.csv:3: has not one field a column"));
}

TEST_F(Sweeps, AreNotSafeWhereACheckWasBrokenBefore) {
  fly("a");
  std::string rows = text("a/runs.csv");
  const auto line = rows.find('\n') + 1;
  const auto safe = rows.substr(line, rows.find('\n', line) - line);
  // The last of the measures that every scenario has.
  std::string header = rows.substr(0, line - 1);
  std::size_t column = 0;
  for (std::size_t at = 0; at < header.find("safe"); ++at) column += header[at] == ',' ? 1 : 0;
  std::size_t at = line;
  for (std::size_t i = 0; i < column; ++i) at = rows.find(',', at) + 1;
  ASSERT_EQ(rows[at], '1') << safe;
  rows[at] = '0';
  std::ofstream{root_ / "a/runs.csv", std::ios::binary} << rows;
  const auto table = RunTable::open(root_ / "a", experiment_, base_);
  ASSERT_TRUE(table) << table.error().message;
  EXPECT_FALSE(all_safe(experiment_, *table));
}

TEST_F(Sweeps, FlyNothingWhereACellCannotBeFlown) {
  experiment_.axes[1].points[1].settings.message_delay_s = 0.2;
  experiment_.axes[1].points[1].settings.vehicles = std::uint16_t{4};
  auto table = RunTable::open(root_ / "a", experiment_, base_);
  ASSERT_TRUE(table);
  SweepOptions options;
  options.folder = root_ / "a";
  const auto outcome = sweep(experiment_, base_, options, *table);
  ASSERT_FALSE(outcome);
  EXPECT_THAT(outcome.error().message, HasSubstr("method ours, margin long"));
  EXPECT_EQ(missing(experiment_, *table).size(), 12U);
}

}  // namespace
}  // namespace skein::experiments
