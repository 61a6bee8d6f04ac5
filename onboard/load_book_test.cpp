// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/load_book.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <string>

namespace skein::onboard {
namespace {

constexpr std::int64_t kEpoch = 1'700'000'000'000'000'000;

class LoadBookTest : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_ =
      std::filesystem::path{testing::TempDir()} / ("load-book-" + std::to_string(::getpid()));
};

TEST_F(LoadBookTest, TheNextProgramOfTheMissionKnowsWhatIsUsed) {
  LoadBook first{folder_, kEpoch};
  EXPECT_EQ(first.used(), 0U);
  EXPECT_TRUE(first.use());
  LoadBook second{folder_, kEpoch};
  EXPECT_EQ(second.used(), 1U);
  EXPECT_TRUE(second.use());
  EXPECT_EQ((LoadBook{folder_, kEpoch}.used()), 2U);
}

TEST_F(LoadBookTest, AnotherMissionBeginsWithAllLoads) {
  EXPECT_TRUE((LoadBook{folder_, kEpoch}.use()));
  EXPECT_EQ((LoadBook{folder_, kEpoch + 1}.used()), 0U);
}

TEST_F(LoadBookTest, WhatIsNoFileOfItsIsNotRead) {
  std::ofstream{folder_ / "loads-used"} << "one\n";
  EXPECT_EQ((LoadBook{folder_, kEpoch}.used()), 0U);
}

TEST_F(LoadBookTest, CountsWhereNothingCanBeWrittenAndSaysSo) {
  LoadBook book{folder_ / "nowhere", kEpoch};
  EXPECT_FALSE(book.use());
  EXPECT_EQ(book.used(), 1U);
  LoadBook none{{}, kEpoch};
  EXPECT_TRUE(none.use());
}

}  // namespace
}  // namespace skein::onboard
