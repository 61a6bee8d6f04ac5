// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "skein/base/assert.hpp"
#include "skein/process/close_limit.hpp"
#include "skein/process/host.hpp"
#include "skein/process/log.hpp"
#include "skein/process/mission_clock.hpp"
#include "skein/process/mission_network.hpp"
#include "skein/process/service.hpp"
#include "skein/process/shutdown.hpp"
#include "skein/process/token.hpp"

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

TEST(Shutdown, WaitsNoLongerThanItIsTold) {
  const Shutdown shutdown;
  EXPECT_EQ(shutdown.wait_for(std::chrono::milliseconds{1}), nullptr);
  std::thread other{[&] { shutdown.request(); }};
  EXPECT_STREQ(shutdown.wait_for(std::chrono::seconds{60}), "SIGTERM");
  other.join();
}

TEST(ProgressWatch, IsContentOnlyWhereEveryPartHasMovedSince) {
  const auto start = ProgressWatch::Time{};
  const auto at = [start](int s) { return start + std::chrono::seconds{s}; };
  ProgressWatch watch{2, start};
  const auto moved = [&watch, at](std::uint64_t control, std::uint64_t agent, int s) {
    return watch.all_moved(std::array{control, agent}, at(s));
  };
  EXPECT_FALSE(moved(0, 0, 1));
  EXPECT_FALSE(moved(5, 0, 2));  // control alone
  EXPECT_TRUE(moved(5, 1, 3));   // each since the last time, not at one moment
  EXPECT_FALSE(moved(5, 2, 4));  // a stuck control
  EXPECT_FALSE(moved(5, 9, 9));
  EXPECT_EQ(watch.age(0, at(9)), std::chrono::seconds{7});
  EXPECT_EQ(watch.age(1, at(9)), std::chrono::seconds{0});
  EXPECT_TRUE(moved(6, 9, 10));
}

TEST(Host, KnowsItsClockAndItsDisk) {
  const auto folder = std::filesystem::temp_directory_path() /
                      ("skein-host-" + std::to_string(unix_ns_in(Duration::zero())));
  EXPECT_EQ(bytes_in(folder), 0U);
  EXPECT_FALSE(free_bytes(folder));
  std::filesystem::create_directories(folder / "deeper");
  std::ofstream{folder / "a"} << "123";
  std::ofstream{folder / "b"} << "45";
  std::ofstream{folder / "deeper" / "c"} << "6";
  EXPECT_EQ(bytes_in(folder), 5U);
  EXPECT_TRUE(free_bytes(folder));
  std::filesystem::remove_all(folder);
  const auto clock = clock_state();
  EXPECT_TRUE(!clock || clock->error_max.count() >= 0);
}

TEST(MissionNetwork, KnowsATeamOnOneMachine) {
  configuration::NetworkConfig network;
  EXPECT_FALSE(among_machines(network));
  network.peers = {{.id = {1}, .address = network.address, .port = 7402}};
  EXPECT_FALSE(among_machines(network));
  network.peers.push_back({.id = {2}, .address = "10.0.0.2", .port = 7400});
  EXPECT_TRUE(among_machines(network));
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

TEST(Token, IsKeptForThisUserAlone) {
  std::string name = testing::TempDir() + "skein-token-XXXXXX";
  ASSERT_NE(::mkdtemp(name.data()), nullptr);
  const std::filesystem::path file = std::filesystem::path{name} / kConsoleTokenFile;
  const auto made = read_or_make_token(file);
  ASSERT_TRUE(made.ok()) << made.error().message;
  EXPECT_EQ(made->size(), 32U);
  EXPECT_NE(*made, make_token());
  EXPECT_EQ(read_or_make_token(file).value(), *made) << "at the next start, too";
  EXPECT_FALSE(keep_token(file, make_token())) << "it is there";
  std::filesystem::permissions(file, std::filesystem::perms::group_read,
                               std::filesystem::perm_options::add);
  EXPECT_FALSE(read_or_make_token(file)) << "others can read it";
  std::filesystem::permissions(file, std::filesystem::perms::owner_read,
                               std::filesystem::perm_options::replace);
  std::filesystem::remove(file);
  std::ofstream{file} << "none\n";
  std::filesystem::permissions(file, std::filesystem::perms::owner_read);
  EXPECT_FALSE(read_or_make_token(file));
  std::filesystem::remove_all(name);
}

}  // namespace
}  // namespace skein::process
