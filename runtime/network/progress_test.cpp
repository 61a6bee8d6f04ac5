// SPDX-License-Identifier: Apache-2.0
#include "progress.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <list>

namespace skein::network {
namespace {

constexpr Instant at(int seconds) { return Instant{std::chrono::seconds{seconds}}; }

TEST(Progress, IsTheLongestOfThoseThatAreAtIt) {
  Progress progress;
  EXPECT_EQ(progress.longest(at(9)), Duration{});
  {
    const Progress::Receiving one{progress, at(2)};
    const Progress::Receiving other{progress, at(5)};
    EXPECT_EQ(progress.longest(at(9)), std::chrono::seconds{7});
  }
  EXPECT_EQ(progress.longest(at(9)), Duration{});
}

TEST(Progress, WhatIsWrittenMustBeSent) {
  Progress progress;
  progress.sent();
  EXPECT_EQ(progress.longest(at(9)), Duration{});
  progress.written(at(3));
  progress.written(at(4));
  EXPECT_EQ(progress.longest(at(9)), std::chrono::seconds{6});
  progress.sent();
  EXPECT_EQ(progress.longest(at(9)), Duration{});
}

TEST(Progress, MoreThreadsThanItKnowsAreNotSeenAndDoNoHarm) {
  Progress progress;
  std::list<Progress::Receiving> all;
  for (int i = 0; i < 100; ++i) all.emplace_back(progress, at(1 + i));
  EXPECT_EQ(progress.longest(at(101)), std::chrono::seconds{100});
  all.clear();
  EXPECT_EQ(progress.longest(at(101)), Duration{});
}

}  // namespace
}  // namespace skein::network
