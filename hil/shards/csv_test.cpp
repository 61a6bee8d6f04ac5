// SPDX-License-Identifier: Apache-2.0
#include "skein/shards/csv.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

namespace skein::shards {
namespace {

TEST(Csv, GivesBackWhatWasWritten) {
  const std::vector<std::string> fields{"24", "ours, all in range", "say \"so\"", "", "1.5"};
  const std::string line = csv_line(fields);
  ASSERT_EQ(line.back(), '\n');
  EXPECT_EQ(csv_fields(line.substr(0, line.size() - 1)), fields);
}

TEST(Csv, PartsWhatWasJoined) {
  const std::vector<std::string> texts{"",         "a|b",      "\\", "\\n", "two\nlines\r",
                                       "a, \"b\"", "\xff\xfe", "|"};
  const std::string field = joined(texts);
  EXPECT_EQ(field.find('\n'), std::string::npos);
  EXPECT_EQ(parted(field), texts);
  const std::string line = csv_line({"1", field});
  EXPECT_EQ(csv_fields(line.substr(0, line.size() - 1)).back(), field);
}

TEST(Csv, TakesOnlyWholeNumbersOfTheKind) {
  EXPECT_EQ(number_of<std::uint64_t>("18446744073709551615"), 18446744073709551615U);
  EXPECT_EQ(number_of<double>("1e9"), 1e9);
  EXPECT_FALSE(number_of<std::uint64_t>("-1"));
  EXPECT_FALSE(number_of<double>("1.5 "));
  EXPECT_FALSE(number_of<double>(""));
}

}  // namespace
}  // namespace skein::shards
