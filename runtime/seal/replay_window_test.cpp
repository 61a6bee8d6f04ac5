// SPDX-License-Identifier: Apache-2.0
#include "skein/seal/replay_window.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "skein/base/random.hpp"

namespace skein::seal {
namespace {

TEST(ReplayWindow, TakesEachOnceAndNoneThatIsTooOld) {
  ReplayWindow window;
  EXPECT_TRUE(window.is_new(5));
  window.note(5);
  EXPECT_FALSE(window.is_new(5));
  EXPECT_TRUE(window.is_new(4));
  window.note(5 + ReplayWindow::kReach);
  EXPECT_FALSE(window.is_new(5));
  EXPECT_TRUE(window.is_new(6));
  window.note(1'000'000'000'000);
  EXPECT_FALSE(window.is_new(5 + ReplayWindow::kReach));
  EXPECT_TRUE(window.is_new(1'000'000'000'000 - ReplayWindow::kReach + 1));
}

// Against a set of all that was ever noted.
TEST(ReplayWindow, KnowsWhatASetKnows) {
  Random random{3};
  for (int round = 0; round < 20; ++round) {
    ReplayWindow window;
    std::set<std::uint64_t> noted;
    std::uint64_t newest = 0;
    for (int i = 0; i < 20'000; ++i) {
      const std::uint64_t jump = random.index(random.chance(0.01) ? 3000 : 5);
      const std::uint64_t back = random.index(random.chance(0.1) ? 1500 : 20);
      const std::uint64_t counter = newest + jump > back ? newest + jump - back : 0;
      const bool too_old = !noted.empty() && counter + ReplayWindow::kReach <= newest;
      ASSERT_EQ(window.is_new(counter), !too_old && !noted.contains(counter)) << counter;
      if (!window.is_new(counter)) continue;
      window.note(counter);
      noted.insert(counter);
      newest = std::max(newest, counter);
    }
  }
}

}  // namespace
}  // namespace skein::seal
