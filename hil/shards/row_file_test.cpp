// SPDX-License-Identifier: Apache-2.0
#include "skein/shards/row_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "skein/shards/csv.hpp"
#include "skein/shards/run_folder.hpp"

namespace skein::shards {
namespace {

using ::testing::HasSubstr;

const std::vector<std::string> kColumns{"seed", "what"};

Result<RowKey> key_of(const std::vector<std::string>& fields) {
  const auto seed = number_of<std::uint64_t>(fields[0]);
  if (!seed) return Error{"has no seed"};
  return RowKey{*seed, 0};
}

class RowFiles : public ::testing::Test {
 protected:
  RowFiles() {
    std::string name = (std::filesystem::temp_directory_path() / "skein-rows-XXXXXX").string();
    if (::mkdtemp(name.data()) != nullptr) root_ = name;
  }
  void TearDown() override { std::filesystem::remove_all(root_); }

  Result<RowFile> open(const std::string& name) {
    return RowFile::open(root_ / name, kColumns, key_of);
  }
  void write(const std::string& name, const std::string& rows) const {
    std::ofstream{root_ / name, std::ios::binary | std::ios::app} << rows;
  }
  [[nodiscard]] std::string text(const std::string& name) const { return text_of(root_ / name); }
  static std::vector<std::string> seeds(const RowFile& file) {
    std::vector<std::string> seeds;
    EXPECT_TRUE(file.each([&](const std::vector<std::string>& fields) -> Result<void> {
      seeds.push_back(fields[0]);
      return {};
    }));
    return seeds;
  }

  std::filesystem::path root_;
};

TEST_F(RowFiles, KeepRowsAndGiveThemInOrder) {
  {
    auto file = open("a");
    ASSERT_TRUE(file) << file.error().message;
    for (const char* seed : {"7", "3", "5"})
      ASSERT_TRUE(file->append(*key_of({seed, ""}), {seed, "a, \"b\""}));
    EXPECT_EQ(seeds(*file), (std::vector<std::string>{"3", "5", "7"}));
  }
  auto file = open("a");
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ(file->size(), 3U);
  EXPECT_TRUE(file->has({5, 0}));
  EXPECT_FALSE(file->has({4, 0}));
  ASSERT_TRUE(file->sort());
  const std::string sorted =
      "seed,what\n3,\"a, \"\"b\"\"\"\n5,\"a, \"\"b\"\"\"\n7,\"a, \"\"b\"\"\"\n";
  EXPECT_EQ(text("a"), sorted);
  // It goes on after that.
  ASSERT_TRUE(file->append({4, 0}, {"4", "x"}));
  EXPECT_EQ(seeds(*file), (std::vector<std::string>{"3", "4", "5", "7"}));
  EXPECT_EQ(text("a"), sorted + "4,x\n");
}

TEST_F(RowFiles, CutOffWhatIsNoWholeRow) {
  write("a", "seed,what\n1,x\n2,");
  auto file = open("a");
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_FALSE(file->has({2, 0}));
  ASSERT_TRUE(file->append({2, 0}, {"2", "y"}));
  EXPECT_EQ(text("a"), "seed,what\n1,x\n2,y\n");

  write("header", "seed,wh");
  EXPECT_TRUE(open("header"));
  EXPECT_EQ(text("header"), "seed,what\n");
}

TEST_F(RowFiles, SayWhichLineIsWrong) {
  write("columns", "seed,other\n");
  EXPECT_THAT(open("columns").error().message, HasSubstr("columns:1: has other columns"));
  write("short", "seed,what\n1,x\n2\n");
  EXPECT_THAT(open("short").error().message, HasSubstr("short:3: has not one field a column"));
  write("seed", "seed,what\nx,x\n");
  EXPECT_THAT(open("seed").error().message, HasSubstr("seed:2: has no seed; remove the line"));
}

TEST_F(RowFiles, TakeARunTwiceOnlyIfItIsTheSame) {
  write("same", "seed,what\n1,x\n1,x\n");
  auto same = open("same");
  ASSERT_TRUE(same) << same.error().message;
  EXPECT_EQ(same->size(), 1U);
  write("other", "seed,what\n1,x\n1,y\n");
  EXPECT_THAT(open("other").error().message, HasSubstr("other:3: the run of seed 1 is not what"));
}

TEST_F(RowFiles, TakeOverOthersRowsAndNameBothFilesOfAContradiction) {
  write("one", "seed,what\n1,x\n3,x\n5,cut o");
  write("two", "seed,what\n2,x\n3,x\n");
  write("three", "seed,what\n4,x\n3,y\n");
  auto whole = open("whole");
  ASSERT_TRUE(whole);
  ASSERT_TRUE(whole->take_over(root_ / "one", key_of));
  ASSERT_TRUE(whole->take_over(root_ / "two", key_of));
  EXPECT_EQ(seeds(*whole), (std::vector<std::string>{"1", "2", "3"}));
  EXPECT_EQ(text("one"), "seed,what\n1,x\n3,x\n5,cut o") << "it may be at work";
  const auto taken = whole->take_over(root_ / "three", key_of);
  ASSERT_FALSE(taken);
  EXPECT_THAT(taken.error().message, HasSubstr((root_ / "three").string() + ":3: "));
  EXPECT_THAT(taken.error().message, HasSubstr((root_ / "one").string() + " says"));
  EXPECT_FALSE(whole->take_over(root_ / "none", key_of));
}

}  // namespace
}  // namespace skein::shards
