// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/spsc_ring.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <thread>

namespace skein::onboard {
namespace {

TEST(SpscRing, FirstInFirstOut) {
  SpscRing<std::string, 4> ring;
  EXPECT_FALSE(ring.pop());
  EXPECT_TRUE(ring.push("a"));
  EXPECT_TRUE(ring.push("b"));
  EXPECT_EQ(ring.pop(), "a");
  EXPECT_TRUE(ring.push("c"));
  EXPECT_EQ(ring.pop(), "b");
  EXPECT_EQ(ring.pop(), "c");
  EXPECT_FALSE(ring.pop());
}

TEST(SpscRing, RefusesAndCountsWhenFull) {
  SpscRing<int, 2> ring;
  EXPECT_TRUE(ring.push(1));
  EXPECT_TRUE(ring.push(2));
  EXPECT_FALSE(ring.push(3));
  EXPECT_EQ(ring.dropped(), 1U);
  EXPECT_EQ(ring.pop(), 1);
  EXPECT_TRUE(ring.push(4));
  EXPECT_EQ(ring.pop(), 2);
  EXPECT_EQ(ring.pop(), 4);
}

TEST(SpscRing, LetsGoOfWhatWasTaken) {
  SpscRing<std::shared_ptr<int>, 2> ring;
  const auto shared = std::make_shared<int>(1);
  ring.push(shared);
  (void)ring.pop();
  EXPECT_EQ(shared.use_count(), 1);
}

TEST(SpscRing, LosesNothingBetweenThreads) {
  constexpr int kLast = 50000;
  SpscRing<std::string, 64> ring;
  std::thread producer{[&] {
    for (int i = 1; i <= kLast; ++i) {
      while (!ring.push(std::to_string(i))) std::this_thread::yield();
    }
  }};
  bool in_order = true;
  for (int expected = 1; expected <= kLast;) {
    const auto item = ring.pop();
    if (!item) {
      std::this_thread::yield();
      continue;
    }
    in_order = in_order && *item == std::to_string(expected);
    ++expected;
  }
  producer.join();
  EXPECT_TRUE(in_order);
}

}  // namespace
}  // namespace skein::onboard
