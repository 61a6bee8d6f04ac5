// SPDX-License-Identifier: Apache-2.0
#include "skein/series/series_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace skein::series {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

configuration::Scenario scenario(const std::string& name) {
  auto loaded =
      configuration::load_scenario(std::string{SKEIN_SOURCE_DIR} + "/scenarios/" + name + ".yaml");
  EXPECT_TRUE(loaded) << loaded.error().message;
  return *loaded;
}

class SeriesTables : public ::testing::Test {
 protected:
  SeriesTables() {
    std::string name = (std::filesystem::temp_directory_path() / "skein-series-XXXXXX").string();
    if (::mkdtemp(name.data()) != nullptr) root_ = name;
    series_.kind = kSites;
    series_.program = "1";
    series_.file = "s.yaml";
    series_.first_seed = 5;
    series_.runs = 7;
  }
  void TearDown() override { std::filesystem::remove_all(root_); }

  Result<SeriesTable> open(const std::string& name) {
    return SeriesTable::open(root_ / name, series_, "scenario\n");
  }
  static void fly(SeriesTable& table, std::uint64_t seed, double ended_s = 10.0) {
    RunRow row;
    row.seed = seed;
    row.done = true;
    row.ended_s = ended_s;
    EXPECT_TRUE(table.append(row));
  }

  std::filesystem::path root_;
  shards::Series series_;
};

TEST_F(SeriesTables, KnowWhatIsMissingOfTheirShard) {
  EXPECT_THAT(open("a")->missing(), ElementsAre(5, 6, 7, 8, 9, 10, 11));
  series_.shard = {2, 3};
  {
    auto table = open("a");
    EXPECT_THAT(table->missing(), ElementsAre(6, 9));
    fly(*table, 6);
  }
  std::ofstream{root_ / "a/runs.csv", std::ios::app} << "9,1,10";  // ended while it wrote
  auto table = open("a");
  EXPECT_THAT(table->missing(), ElementsAre(9));
  fly(*table, 9);
  EXPECT_THAT(table->missing(), IsEmpty());
}

TEST_F(SeriesTables, SumUpTheRunsThatAreAskedFor) {
  auto table = open("a");
  for (const std::uint64_t seed : {6U, 5U, 7U, 8U}) fly(*table, seed, static_cast<double>(seed));
  EXPECT_EQ(table->others(), 0U);
  series_.runs = 3;
  table = Error{"closed"};
  table = open("a");
  EXPECT_EQ(table->others(), 1U);
  const auto summary = table->summary("hil");
  ASSERT_TRUE(summary);
  EXPECT_THAT(summary->text(), HasSubstr("runs       3, seeds 5 to 7\n"));
  EXPECT_THAT(summary->text(), HasSubstr("5.0 s at least, 6.0 s on average, 7.0 s at most"));
}

TEST_F(SeriesTables, AreOfOneScenario) {
  ASSERT_TRUE(open("a"));
  ASSERT_TRUE(open("b"));
  EXPECT_TRUE(same_scenario(root_ / "a", root_ / "b"));
  const auto other = SeriesTable::open(root_ / "a", series_, "another\n");
  ASSERT_FALSE(other);
  EXPECT_THAT(other.error().message,
              HasSubstr("the scenario, or its plan (--routes), has changed"));
  auto fewer = series_;
  fewer.runs = 1;
  EXPECT_FALSE(SeriesTable::open(root_ / "a", fewer, "another\n"));
  EXPECT_EQ(shards::read_series(root_ / "a")->runs, series_.runs) << "refused, and nothing changed";
  ASSERT_TRUE(SeriesTable::open(root_ / "c", series_, "another\n"));
  const auto differ = same_scenario(root_ / "a", root_ / "c");
  ASSERT_FALSE(differ);
  EXPECT_THAT(differ.error().message, HasSubstr("/a/scenario.yaml and "));
  EXPECT_THAT(differ.error().message, HasSubstr("/c/scenario.yaml differ"));
}

TEST_F(SeriesTables, AScenarioIsTheSameWhereverItsFilesLie) {
  const auto planes = scenario("formation-planes-5");
  ASSERT_FALSE(planes.formation.tracks.empty());
  const std::filesystem::path track = planes.formation.tracks[0].file;
  std::filesystem::copy_file(track, root_ / track.filename());
  auto moved = planes;
  moved.title = "Elsewhere";
  moved.seed = 17;
  moved.formation.tracks[0].file = (root_ / track.filename()).string();
  const std::string text = identity(planes);
  EXPECT_EQ(identity(moved), text);
  EXPECT_THAT(text, Not(HasSubstr(track.parent_path().string())));
  EXPECT_TRUE(configuration::parse_scenario(text, "s.yaml"));
  std::ofstream{root_ / track.filename(), std::ios::app} << "# another track\n";
  EXPECT_NE(identity(moved), text);
}

}  // namespace
}  // namespace skein::series
