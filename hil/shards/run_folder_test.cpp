// SPDX-License-Identifier: Apache-2.0
#include "skein/shards/run_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

namespace skein::shards {
namespace {

using ::testing::HasSubstr;

class RunFolders : public ::testing::Test {
 protected:
  RunFolders() {
    std::string name = (std::filesystem::temp_directory_path() / "skein-folder-XXXXXX").string();
    if (::mkdtemp(name.data()) != nullptr) root_ = name;
    series_.kind = "sites";
    series_.program = "0.2.0+g1";
    series_.file = "a folder/with: odd\nname|s.yaml";
    series_.faults = "mixed,lossy";
    series_.plan = "a plan.yaml";
    series_.first_seed = 18446744073709551615U;
    series_.runs = 12;
    series_.shard = {3, 16};
    series_.separation_m = 2.1;
  }
  void TearDown() override { std::filesystem::remove_all(root_); }
  /// As a command does that is not refused.
  Result<RunFolder> take(const Series& series) {
    auto opened = RunFolder::open(root_ / "a", series);
    if (!opened) return opened;
    if (auto kept = keep_series(root_ / "a", series); !kept) return kept.error();
    return opened;
  }
  std::filesystem::path root_;
  Series series_;
};

TEST_F(RunFolders, KeepTheirSeries) {
  ASSERT_TRUE(take(series_));
  const auto read = read_series(root_ / "a");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->kind, series_.kind);
  EXPECT_EQ(read->program, series_.program);
  EXPECT_EQ(read->file, series_.file);
  EXPECT_EQ(read->faults, series_.faults);
  EXPECT_EQ(read->plan, series_.plan);
  EXPECT_EQ(read->first_seed, series_.first_seed);
  EXPECT_EQ(read->runs, series_.runs);
  EXPECT_EQ(to_string(read->shard), "3/16");
  EXPECT_EQ(read->separation_m, series_.separation_m);
  EXPECT_THAT(read_series(root_).error().message, HasSubstr("series.txt: there is none"));
  ASSERT_TRUE(put_text(root_ / "a/series.txt", "kind: sites\nruns: many\n"));
  EXPECT_THAT(read_series(root_ / "a").error().message, HasSubstr("series.txt"));
}

TEST_F(RunFolders, AreOneExperiments) {
  ASSERT_TRUE(take(series_));
  auto more = series_;
  more.runs = 100;
  more.shard = {};
  more.file = "elsewhere.yaml";
  EXPECT_TRUE(RunFolder::open(root_ / "a", more));
  // Who opens it may still find that its scenario is another.
  EXPECT_EQ(read_series(root_ / "a")->runs, series_.runs);
  EXPECT_TRUE(take(more));
  EXPECT_EQ(read_series(root_ / "a")->runs, 100U);
  const auto refused = [&](const Series& other) {
    const auto opened = RunFolder::open(root_ / "a", other);
    return opened ? std::string{"taken"} : opened.error().message;
  };
  EXPECT_TRUE(take(series_));  // and its shard again
  auto other = series_;
  other.shard = {3, 17};
  EXPECT_THAT(refused(other), HasSubstr("of shard 3/16, and this command's of 3/17"));
  other = series_;
  other.program = "0.2.0+g2";
  EXPECT_THAT(refused(other), HasSubstr("of the program 0.2.0+g1, and those of this command of"));
  other = series_;
  other.faults = "none";
  EXPECT_THAT(refused(other), HasSubstr("of the faults mixed,lossy"));
  other = series_;
  other.plan.clear();
  EXPECT_THAT(refused(other), HasSubstr("of the plan (--routes) a plan, and those of"));
  other = series_;
  other.kind = "formation";
  EXPECT_THAT(refused(other), HasSubstr("of the kind sites"));
  other = series_;
  other.first_seed = 1;
  EXPECT_THAT(refused(other), HasSubstr("of the first seed 18446744073709551615"));
}

TEST_F(RunFolders, HaveOneProgramAtATime) {
  {
    const auto first = RunFolder::open(root_ / "a", series_);
    ASSERT_TRUE(first);
    const auto second = RunFolder::open(root_ / "a", series_);
    ASSERT_FALSE(second);
    EXPECT_THAT(second.error().message, HasSubstr("another program writes"));
  }
  EXPECT_TRUE(RunFolder::open(root_ / "a", series_));
}

TEST_F(RunFolders, KeepATextThatMayNotChange) {
  const auto file = root_ / "scenario.yaml";
  EXPECT_TRUE(keep_text(file, "a\n", "scenario"));
  EXPECT_TRUE(keep_text(file, "a\n", "scenario"));
  const auto changed = keep_text(file, "b\n", "scenario");
  ASSERT_FALSE(changed);
  EXPECT_THAT(changed.error().message, HasSubstr("the scenario has changed"));
  EXPECT_EQ(text_of(file), "a\n");
}

}  // namespace
}  // namespace skein::shards
