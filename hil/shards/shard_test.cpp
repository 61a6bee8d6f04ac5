// SPDX-License-Identifier: Apache-2.0
#include "skein/shards/shard.hpp"

#include <gtest/gtest.h>

#include <string>

namespace skein::shards {
namespace {

TEST(Shards, HaveEveryDrawOnceAndAboutAsManyEach) {
  std::size_t all = 0;
  for (std::size_t number = 1; number <= 7; ++number) {
    const Shard shard{number, 7};
    std::size_t mine = 0;
    for (std::uint64_t draw = 0; draw < 100; ++draw) {
      mine += shard.has(draw) ? 1 : 0;
      EXPECT_EQ(shard.has(draw), shard.of(draw) == number);
    }
    EXPECT_GE(mine, 14U);
    EXPECT_LE(mine, 15U);
    all += mine;
  }
  EXPECT_EQ(all, 100U);
  EXPECT_TRUE(Shard{}.has(99));
}

TEST(Shards, AreReadAndWritten) {
  const auto shard = parse_shard("3/16");
  ASSERT_TRUE(shard);
  EXPECT_EQ(shard->number, 3U);
  EXPECT_EQ(shard->count, 16U);
  EXPECT_EQ(to_string(*shard), "3/16");
  EXPECT_TRUE(parse_shard("16/16"));
  for (const std::string text : {"", "3", "0/4", "5/4", "1/0", "-1/4", "1/4/2", "a/b", "1 /4"})
    EXPECT_FALSE(parse_shard(text)) << text;
}

TEST(Shards, AreListedAsJobEnginesTakeThem) {
  EXPECT_EQ(ranges({}), "");
  EXPECT_EQ(ranges({3}), "3");
  EXPECT_EQ(ranges({3, 7, 11, 12, 13}), "3,7,11-13");
  EXPECT_EQ(ranges({1, 2, 4}), "1-2,4");
}

}  // namespace
}  // namespace skein::shards
