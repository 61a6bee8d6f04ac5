// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "skein/configuration/experiment.hpp"
#include "skein/configuration/scenario.hpp"

namespace skein::configuration {
namespace {

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

constexpr auto kExperiment = R"(
version: 1
title: Try
scenario: s.yaml
runs: 3
axes:
  - name: range
    points:
      - {label: near, radio_range_m: 1000}
      - {label: far, radio_range_m: 2500, allocation: greedy}
)";

std::string experiment_error(const std::string& from, const std::string& to) {
  const auto result = parse_experiment(replaced(kExperiment, from, to), "e.yaml");
  return result.ok() ? "no error" : result.error().message;
}

TEST(ExperimentFile, IsReadAndWrittenAlike) {
  const auto read = parse_experiment(kExperiment, "e.yaml");
  ASSERT_TRUE(read.ok()) << read.error().message;
  ASSERT_EQ(read->axes.size(), 1U);
  ASSERT_EQ(read->axes[0].points.size(), 2U);
  EXPECT_EQ(read->axes[0].points[1].settings.radio_range_m, 2500.0);
  EXPECT_EQ(read->axes[0].points[1].settings.allocation, planning::AllocationMethod::greedy);
  EXPECT_FALSE(read->axes[0].points[0].settings.allocation.has_value());
  EXPECT_FALSE(read->team.has_value());
  const auto again = parse_experiment(to_yaml(*read), "again.yaml");
  ASSERT_TRUE(again.ok()) << again.error().message;
  EXPECT_EQ(to_yaml(*again), to_yaml(*read));
}

TEST(ExperimentFile, SaysWhereItIsWrongAndWhatToDo) {
  EXPECT_THAT(
      experiment_error("greedy", "greddy"),
      ::testing::HasSubstr("e.yaml:10: axes[1].points[2].allocation: is \"greddy\", not one of"));
  EXPECT_THAT(experiment_error("runs: 3", "runs: 0"),
              ::testing::HasSubstr("e.yaml:5: runs: is 0, outside 1"));
  EXPECT_THAT(experiment_error("radio_range_m: 1000", "radio_rang_m: 1000"),
              ::testing::HasSubstr("did you mean radio_range_m?"));
  EXPECT_THAT(experiment_error("label: far", "label: near"),
              ::testing::HasSubstr("has a label twice"));
  EXPECT_THAT(experiment_error("scenario: s.yaml\n", ""),
              ::testing::HasSubstr("scenario: is missing"));
  EXPECT_THAT(experiment_error("runs: 3",
                               "runs: 3\nrandom_team: [{west_m: 5, east_m: 1, south_m: 0, "
                               "north_m: 1}]"),
              ::testing::HasSubstr("random_team[1].east_m: must be greater than west_m"));
}

TEST(ExperimentFile, ThoseThatAreShippedAreGoodAndNameTheirScenario) {
  std::size_t files = 0;
  const std::filesystem::path folder =
      std::filesystem::path{SKEIN_SOURCE_DIR} / "scenarios" / "experiments";
  for (const auto& entry : std::filesystem::directory_iterator{folder}) {
    const auto experiment = load_experiment(entry.path());
    ASSERT_TRUE(experiment.ok()) << experiment.error().message;
    const auto scenario = load_scenario(folder / experiment->scenario);
    EXPECT_TRUE(scenario.ok()) << scenario.error().message;
    ++files;
  }
  EXPECT_GE(files, 3U);
}

}  // namespace
}  // namespace skein::configuration
