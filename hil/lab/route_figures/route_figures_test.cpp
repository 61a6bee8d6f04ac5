// SPDX-License-Identifier: Apache-2.0
#include "skein/route_figures/route_figures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <sstream>

namespace skein::route_figures {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

Options small() {
  Options options;
  options.runs = {.maps = 1,
                  .convergence = 1,
                  .weights = 1,
                  .worlds = 2,
                  .known_worlds = 0,
                  .quality = 2,
                  .best_known = 0,
                  .flights = 2,
                  .teams = {1, 1, 0}};
  return options;
}

std::map<std::string, std::string> files_of(const Figures& figures) {
  std::map<std::string, std::string> files;
  for (const File& file : figures.files) files[file.name] = file.text;
  return files;
}

std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

TEST(RouteFigures, ExperimentsAreFoundByName) {
  EXPECT_THAT(*find_experiments({"scale", "maps", "scale"}),
              ElementsAre(Experiment::maps, Experiment::scale));
  EXPECT_EQ(find_experiments({"maps", "all"})->size(), static_cast<std::size_t>(Experiment::count));
  const auto none = find_experiments({"map"});
  ASSERT_FALSE(none.ok());
  EXPECT_THAT(none.error().message, HasSubstr("maps, convergence"));
}

/// Those that are soon done.
class QuickOnes : public ::testing::TestWithParam<Experiment> {};

TEST_P(QuickOnes, GivesTheSameFilesWithAnyNumberOfThreadsAndCountsItsRuns) {
  Options options = small();
  std::size_t done = 0;
  options.on_done = [&done] { ++done; };
  const auto one = draw(GetParam(), options);
  options.jobs = 3;
  const auto three = draw(GetParam(), options);
  ASSERT_TRUE(one.ok() && three.ok());
  EXPECT_EQ(done, 2 * steps_of(GetParam(), options.runs));
  EXPECT_EQ(one->text, three->text);
  EXPECT_EQ(files_of(*one), files_of(*three));
  options.seed = 2;
  EXPECT_NE(one->text, draw(GetParam(), options)->text);
  for (const File& file : one->files) {
    EXPECT_EQ(file.text.find("nan"), std::string::npos) << file.name;
    if (file.name.find(".svg") != std::string::npos) {
      EXPECT_THAT(file.text, StartsWith("<svg "));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, QuickOnes,
                         ::testing::Values(Experiment::weights, Experiment::worlds,
                                           Experiment::quality, Experiment::flights),
                         [](const auto& one) { return std::string{to_string(one.param)}; });

TEST(RouteFigures, MapsHaveARowForEachRunAndThePapersMeansBesideThem) {
  const auto figures = draw(Experiment::maps, small());
  ASSERT_TRUE(figures.ok());
  const auto files = files_of(*figures);
  const std::string& csv = files.at("maps.csv");
  EXPECT_EQ(lines(csv), 1U + 24U);
  EXPECT_THAT(csv, HasSubstr("\nstart,logistic,1,1."));
  EXPECT_THAT(csv, HasSubstr("\na,intermittency,1,1."));
  EXPECT_THAT(figures->text, HasSubstr("paper 1.186 to 1.546"));
  EXPECT_THAT(files.at("maps.svg"), HasSubstr("intermittency"));
}

TEST(RouteFigures, ConvergenceFallsAndEqualsEndEqual) {
  const auto figures = draw(Experiment::convergence, small());
  ASSERT_TRUE(figures.ok());
  const auto files = files_of(*figures);
  EXPECT_EQ(lines(files.at("convergence.csv")), 1U + 32U);
  EXPECT_THAT(files.at("convergence.csv"),
              HasSubstr("\nevaluations,\"chaotic grey wolf, free points\",1,7500,1."));
  EXPECT_THAT(files.at("convergence.csv"),
              HasSubstr("\niterations,\"grey wolf, free points\",1,7550,1."));
  std::istringstream rows{files.at("convergence-curves.csv")};
  std::string row;
  std::map<std::string, double> last;
  while (std::getline(rows, row)) {
    if (row.find('"') == std::string::npos) continue;  // the header, and ours
    const std::string cell = row.substr(0, row.rfind('"'));
    const double value = std::stod(row.substr(row.rfind(',') + 1));
    if (last.contains(cell)) {
      EXPECT_LE(value, last[cell] + 1e-9) << row;
    }
    last[cell] = value;
  }
  EXPECT_GE(last.size(), 30U);
  EXPECT_THAT(files.at("convergence-evaluations.svg"), HasSubstr("CGWO (the paper"));
  EXPECT_THAT(figures->text, HasSubstr("1.35"));
}

TEST(RouteFigures, WorldsAreCountedBothWaysBesideThePaper) {
  Options options = small();
  options.runs.worlds = 4;
  const auto figures = draw(Experiment::worlds, options);
  ASSERT_TRUE(figures.ok());
  const auto files = files_of(*figures);
  EXPECT_EQ(lines(files.at("worlds.csv")), 1U + 8U);
  EXPECT_THAT(figures->text, HasSubstr("74.0 %"));
  EXPECT_THAT(figures->text, HasSubstr("-0.0466"));
  EXPECT_THAT(files.at("worlds-wins.svg"), HasSubstr("ours over PSO"));
}

TEST(RouteFigures, TheCooperativeCaseIsCheckedAndDrawn) {
  const auto figures = draw(Experiment::cooperative, small());
  ASSERT_TRUE(figures.ok());
  EXPECT_THAT(figures->text, HasSubstr("finds nothing broken"));
  const auto files = files_of(*figures);
  EXPECT_EQ(lines(files.at("cooperative.csv")), 4U);
  EXPECT_GT(lines(files.at("cooperative-tracks.csv")), 3U * 160U);
  EXPECT_THAT(files.at("cooperative.svg"), HasSubstr("vehicle 3: 17"));
  EXPECT_THAT(files.at("cooperative-distances.svg"), HasSubstr("asked for"));
}

TEST(RouteFigures, TeamsThatCanBePlannedArePlannedAndChecked) {
  const auto figures = draw(Experiment::scale, small());
  ASSERT_TRUE(figures.ok());
  const auto files = files_of(*figures);
  EXPECT_EQ(lines(files.at("scale.csv")), 1U + 2U);
  EXPECT_THAT(files.at("scale.csv"), HasSubstr("\n5,1,1,1,0,0.0"));
  EXPECT_THAT(files.at("scale.csv"), HasSubstr("\n10,1,1,1,0,0.0"));
  EXPECT_THAT(figures->text, HasSubstr("100.0 %"));
}

}  // namespace
}  // namespace skein::route_figures
