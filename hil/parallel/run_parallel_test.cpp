// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/run_parallel.hpp"

#include <gtest/gtest.h>

#include <latch>
#include <set>
#include <string>

namespace skein::hil {
namespace {

Result<std::size_t> square(std::size_t i) { return i * i; }

TEST(RunParallel, IsInTheOrderOfRunsWhateverTheJobs) {
  for (const std::size_t jobs : {0U, 1U, 2U, 7U, 200U}) {
    std::multiset<std::size_t> seen;
    const auto runs = run_parallel<std::size_t>(100, jobs, square,
                                                [&](const std::size_t& run) { seen.insert(run); });
    ASSERT_TRUE(runs.ok());
    ASSERT_EQ(runs->size(), 100U);
    for (std::size_t i = 0; i < 100; ++i) {
      EXPECT_EQ((*runs)[i], i * i);
      EXPECT_EQ(seen.count(i * i), 1U) << jobs << " jobs";
    }
  }
}

TEST(RunParallel, OfNoRunsIsEmpty) {
  const auto runs = run_parallel<std::size_t>(0, 4, square);
  ASSERT_TRUE(runs.ok());
  EXPECT_TRUE(runs->empty());
}

TEST(RunParallel, FliesAsManyAtOnceAsThereAreJobs) {
  // Each waits until all have begun: with fewer threads this never ends.
  std::latch begun{3};
  const auto runs = run_parallel<std::size_t>(3, 3, [&](std::size_t i) -> Result<std::size_t> {
    begun.arrive_and_wait();
    return i;
  });
  EXPECT_TRUE(runs.ok());
}

TEST(RunParallel, StopsAtTheFirstThatFails) {
  std::size_t flown = 0;
  const auto runs = run_parallel<std::size_t>(100, 1, [&](std::size_t i) -> Result<std::size_t> {
    ++flown;
    if (i == 5) return Error{"the sixth fails"};
    return i;
  });
  ASSERT_FALSE(runs.ok());
  EXPECT_EQ(runs.error().message, "the sixth fails");
  EXPECT_EQ(flown, 6U);
}

TEST(RunParallel, NamesTheFirstOfTwoThatFailWhicheverIsSooner) {
  for (const std::size_t sooner : {0U, 1U}) {
    std::latch failed{1};
    const auto runs = run_parallel<std::size_t>(100, 2, [&](std::size_t i) -> Result<std::size_t> {
      if (i > 1) return i;
      if (i == sooner) {
        failed.count_down();
      } else {
        failed.wait();
      }
      return Error{"run " + std::to_string(i)};
    });
    ASSERT_FALSE(runs.ok());
    EXPECT_EQ(runs.error().message, "run 0");
  }
}

TEST(RunParallel, AsksTheMachineOnlyWhereNobodySaysHowManyJobs) {
  EXPECT_EQ(jobs_of(3), 3U);
  EXPECT_GE(jobs_of(0), 1U);
}

TEST(EachParallel, HandsOverWhatEndsUntilItIsAskedToStop) {
  std::set<std::size_t> taken;
  const auto take = [&](std::size_t i, std::size_t&& run) -> Result<void> {
    EXPECT_EQ(run, i * i);
    taken.insert(i);
    return {};
  };
  EXPECT_TRUE(each_parallel<std::size_t>(100, 3, square, take));
  EXPECT_EQ(taken.size(), 100U);
  taken.clear();
  const auto stopped = [&] { return taken.size() == 5; };
  EXPECT_TRUE(each_parallel<std::size_t>(100, 1, square, take, stopped));
  EXPECT_EQ(taken, (std::set<std::size_t>{0, 1, 2, 3, 4}));
}

TEST(EachParallel, EndsWhereARunCannotBeTaken) {
  std::size_t flown = 0;
  const auto fly = [&](std::size_t i) {
    ++flown;
    return square(i);
  };
  const auto take = [](std::size_t i, std::size_t&&) -> Result<void> {
    if (i == 5) return Error{"the disk is full"};
    return {};
  };
  const auto done = each_parallel<std::size_t>(100, 1, fly, take);
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().message, "the disk is full");
  EXPECT_EQ(flown, 6U);
}

}  // namespace
}  // namespace skein::hil
