// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "skein/base/assert.hpp"
#include "skein/process/close_limit.hpp"
#include "skein/process/log.hpp"
#include "skein/process/mission_clock.hpp"
#include "skein/process/shutdown.hpp"

namespace skein::process {
namespace {

std::int64_t unix_ns_in(Duration d) {
  return std::chrono::duration_cast<Duration>(
             (std::chrono::system_clock::now() + d).time_since_epoch())
      .count();
}

TEST(MissionClockDeathTest, NeverCountsFromTheMomentWhenItIsMade) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_DEATH((MissionClock{0, 1.0}), "");
}

TEST(MissionClock, CountsFromTheEpochAtTheRate) {
  const MissionClock future{unix_ns_in(std::chrono::seconds{100}), 2.0};
  EXPECT_NEAR(to_seconds(future.now()), -200.0, 5.0);
  const MissionClock past{unix_ns_in(std::chrono::seconds{-100}), 0.5};
  EXPECT_NEAR(to_seconds(past.now()), 50.0, 5.0);
}

TEST(MissionClock, RunsAtTheRate) {
  const MissionClock clock{unix_ns_in({}), 20.0};
  const auto steady_before = std::chrono::steady_clock::now();
  const Instant before = clock.now();
  clock.sleep_until(before + std::chrono::milliseconds{400});
  const Instant after = clock.now();
  const auto steady = std::chrono::steady_clock::now() - steady_before;
  EXPECT_GE(after - before, std::chrono::milliseconds{400});
  EXPECT_GE(steady, std::chrono::milliseconds{20});
  EXPECT_LE(after - before, 20 * steady);
}

TEST(MissionClock, WaitsForThePastNotAtAllAndForTheEndOfTimeOneDay) {
  const MissionClock clock{unix_ns_in({}), 1.0};
  const auto now = std::chrono::steady_clock::now();
  clock.sleep_until(Instant::min());
  EXPECT_LE(clock.steady_time_of(Instant::min()), std::chrono::steady_clock::now());
  EXPECT_GT(clock.steady_time_of(Instant::max()), now + std::chrono::hours{23});
  EXPECT_LT(clock.steady_time_of(Instant::max()), now + std::chrono::hours{25});
}

TEST(Shutdown, WaitsUntilAsked) {
  const Shutdown shutdown;
  std::thread other{[&] { shutdown.request(); }};
  EXPECT_STREQ(shutdown.wait(), "SIGTERM");
  other.join();
}

TEST(LogDeathTest, ABrokenInvariantIsLoggedAndEndsTheProcess) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const MissionClock clock{unix_ns_in({}), 1.0};
  EXPECT_EXIT(
      {
        start_log(clock);
        SKEIN_ASSERT(1 + 1 == 3);
      },
      ::testing::ExitedWithCode(kExitBrokenInvariant), "");
}

TEST(CloseLimitDeathTest, EndsAProcessThatWouldNotEnd) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        CloseLimit limit;
        limit.start(std::chrono::milliseconds{10});
        std::this_thread::sleep_until(std::chrono::steady_clock::time_point::max());
      },
      ::testing::ExitedWithCode(0), "");
}

TEST(CloseLimit, IsNotWaitedForWhereAllIsClosed) {
  CloseLimit started;
  started.start(std::chrono::hours{1});
  const CloseLimit never_started;
}

TEST(Log, WritesAnInstantForPeople) { EXPECT_EQ(text_of(at_seconds(12.3456)), "12.346 s"); }

}  // namespace
}  // namespace skein::process
