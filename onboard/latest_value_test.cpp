// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/latest_value.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <thread>

namespace skein::onboard {
namespace {

TEST(LatestValue, GivesTheNewestOnce) {
  LatestValue<int> slot;
  EXPECT_EQ(slot.read(), nullptr);
  slot.write(1);
  slot.write(2);
  const int* value = slot.read();
  ASSERT_NE(value, nullptr);
  EXPECT_EQ(*value, 2);
  EXPECT_EQ(slot.read(), nullptr);
  slot.write(3);
  ASSERT_NE(value = slot.read(), nullptr);
  EXPECT_EQ(*value, 3);
}

TEST(LatestValue, WritesDoNotDisturbWhatIsBeingRead) {
  LatestValue<int> slot;
  slot.write(1);
  const int* value = slot.read();
  ASSERT_NE(value, nullptr);
  for (int i = 2; i < 10; ++i) slot.write(i);
  EXPECT_EQ(*value, 1);
}

TEST(LatestValue, NeverTearsNorGoesBackBetweenThreads) {
  constexpr std::uint64_t kLast = 100000;
  using Block = std::array<std::uint64_t, 32>;
  LatestValue<Block> slot;
  std::thread writer{[&] {
    for (std::uint64_t i = 1; i <= kLast; ++i) {
      Block block;
      block.fill(i);
      slot.write(block);
    }
  }};
  std::uint64_t last = 0;
  while (last < kLast) {
    const Block* block = slot.read();
    if (block == nullptr) {
      std::this_thread::yield();
      continue;
    }
    const std::uint64_t first = block->front();
    if (first <= last) ADD_FAILURE() << "went back from " << last << " to " << first;
    for (const auto word : *block) {
      if (word != first) ADD_FAILURE() << "torn: " << first << " and " << word;
    }
    last = first;
    if (::testing::Test::HasFailure()) break;
  }
  writer.join();
}

}  // namespace
}  // namespace skein::onboard
