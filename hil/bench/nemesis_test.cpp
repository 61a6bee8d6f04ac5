// SPDX-License-Identifier: Apache-2.0
#include "nemesis.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

namespace skein::hil {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr VehicleId kOne{1};
constexpr VehicleId kTwo{2};

/// The letter that /proc has of a process: S sleeps, R runs, T is stopped.
char state_of(const ChildProcess& process) {
  std::ifstream stat{"/proc/" + std::to_string(process.pid()) + "/stat"};
  std::string pid;
  std::string name;
  char state = '?';
  stat >> pid >> name >> state;
  return state;
}

bool comes_to(const ChildProcess& process, bool stopped) {
  for (int i = 0; i < 500; ++i) {
    if ((state_of(process) == 'T') == stopped) return true;
    std::this_thread::sleep_for(milliseconds{10});
  }
  return false;
}

class NemesisTest : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_);
    start(kOne);
    start(kTwo);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void start(VehicleId id, std::optional<std::size_t> file_bytes_max = {}) {
    auto child =
        ChildProcess::start({"/bin/sleep", "1000"}, folder_ / "log", {}, -1, file_bytes_max);
    ASSERT_TRUE(child) << child.error().message;
    programs_.erase(id);
    programs_.emplace(id, std::move(child).value());
  }

  std::filesystem::path folder_ =
      std::filesystem::path{testing::TempDir()} / ("nemesis-" + std::to_string(::getpid()));
  std::map<VehicleId, ChildProcess> programs_;
  std::vector<std::optional<std::size_t>> started_;  ///< with files of so many bytes at most
  Nemesis nemesis_{{programs_,
                    [this](VehicleId id, std::optional<std::size_t> bytes) -> Result<void> {
                      started_.push_back(bytes);
                      start(id, bytes);
                      return {};
                    },
                    [](const std::string&) {}}};
};

TEST_F(NemesisTest, AProgramIsKilledAndStartsAnewWhenItIsTime) {
  const pid_t before = programs_.at(kOne).pid();
  ASSERT_TRUE(nemesis_.begin({{}, seconds{3}, ProgramsEnd{{kOne}}}, {kOne}, at_seconds(10.0)));
  EXPECT_TRUE(programs_.at(kOne).wait(seconds{5}));
  EXPECT_TRUE(nemesis_.is_down(kOne));
  EXPECT_FALSE(nemesis_.is_down(kTwo));
  ASSERT_TRUE(nemesis_.step(at_seconds(12.9)));
  EXPECT_TRUE(nemesis_.is_down(kOne));
  ASSERT_TRUE(nemesis_.step(at_seconds(13.0)));
  EXPECT_FALSE(nemesis_.anybody_down());
  EXPECT_NE(programs_.at(kOne).pid(), before);
  ASSERT_EQ(nemesis_.spans().size(), 1U);
  EXPECT_EQ(nemesis_.spans()[0].from, at_seconds(10.0));
  EXPECT_EQ(nemesis_.spans()[0].until, at_seconds(13.0));
}

TEST_F(NemesisTest, AnEndForGoodIsNotIts) {
  EXPECT_FALSE(nemesis_.begin({{}, {}, ProgramsEnd{{kOne}}}, {kOne}, at_seconds(1.0)));
  EXPECT_FALSE(nemesis_.begin({{}, {}, Healing{}}, {}, at_seconds(1.0)));
  EXPECT_FALSE(programs_.at(kOne).ended());
}

TEST_F(NemesisTest, WhoStandsStillGoesOn) {
  ASSERT_TRUE(nemesis_.begin({{}, seconds{4}, ProgramsStall{{kTwo}}}, {kTwo}, at_seconds(1.0)));
  EXPECT_TRUE(comes_to(programs_.at(kTwo), true));
  ASSERT_TRUE(nemesis_.step(at_seconds(4.9)));
  EXPECT_EQ(state_of(programs_.at(kTwo)), 'T');
  EXPECT_NE(state_of(programs_.at(kOne)), 'T');
  ASSERT_TRUE(nemesis_.step(at_seconds(5.0)));
  EXPECT_TRUE(comes_to(programs_.at(kTwo), false));
}

TEST_F(NemesisTest, WhoIsSlowStandsStillForItsShareOfTheTime) {
  for (const double share : {0.3, 0.55}) {
    const Instant from = at_seconds(100.0 * share);
    ASSERT_TRUE(nemesis_.begin({{}, seconds{4}, ProgramSlow{kOne, share}}, {}, from));
    int stopped = 0;
    constexpr int kSteps = 80;
    for (int i = 0; i < kSteps; ++i) {
      ASSERT_TRUE(nemesis_.step(from + i * milliseconds{50}));
      const bool stops = nemesis_.has_stopped(kOne);
      ASSERT_TRUE(comes_to(programs_.at(kOne), stops));
      stopped += stops ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(stopped) / kSteps, share, 1.5 / kSteps);
    ASSERT_TRUE(nemesis_.step(from + seconds{4}));
    EXPECT_TRUE(comes_to(programs_.at(kOne), false));
  }
}

TEST_F(NemesisTest, WhoIsSlowAndKilledRunsWhenItStartsAnew) {
  ASSERT_TRUE(nemesis_.begin({{}, seconds{60}, ProgramSlow{kOne, 0.5}}, {}, at_seconds(10.0)));
  ASSERT_TRUE(nemesis_.begin({{}, seconds{3}, ProgramsEnd{{kOne}}}, {kOne}, at_seconds(10.0)));
  EXPECT_TRUE(programs_.at(kOne).wait(seconds{5}));
  for (int i = 0; i < 59; ++i) {
    ASSERT_TRUE(nemesis_.step(at_seconds(10.0) + i * milliseconds{50}));
    EXPECT_FALSE(nemesis_.has_stopped(kOne)) << "it is down, and not stopped";
  }
}

TEST_F(NemesisTest, OneStopAfterAnotherIsOneAndAKillEndsIt) {
  const auto stop = [this](double at_s, seconds lasts) {
    ASSERT_TRUE(nemesis_.begin({{}, lasts, ProgramsStall{{kTwo}}}, {kTwo}, at_seconds(at_s)));
  };
  stop(1.0, seconds{4});
  stop(3.0, seconds{1});
  stop(4.0, seconds{3});
  ASSERT_EQ(nemesis_.spans().size(), 1U);
  EXPECT_EQ(nemesis_.spans()[0].until, at_seconds(7.0));
  ASSERT_TRUE(nemesis_.step(at_seconds(7.0)));
  stop(10.0, seconds{20});
  ASSERT_TRUE(nemesis_.begin({{}, seconds{1}, ProgramsEnd{{kTwo}}}, {kTwo}, at_seconds(12.0)));
  ASSERT_TRUE(nemesis_.step(at_seconds(13.0)));
  ASSERT_EQ(nemesis_.spans().size(), 3U);
  EXPECT_EQ(nemesis_.spans()[1].until, at_seconds(12.0));
  EXPECT_EQ(nemesis_.spans()[2].until, at_seconds(13.0));
}

TEST_F(NemesisTest, AStepOfTheClockAndAFullDiskAreFoundByWhoStartsAnew) {
  nemesis_.set_clock(kOne, milliseconds{100});
  ASSERT_TRUE(nemesis_.begin({{}, {}, ClockStep{kOne, seconds{2}}}, {}, at_seconds(1.0)));
  ASSERT_TRUE(nemesis_.begin({{}, {}, DiskFull{kOne}}, {}, at_seconds(1.0)));
  ASSERT_TRUE(nemesis_.begin({{}, seconds{1}, ProgramsEnd{{kOne}}}, {kOne}, at_seconds(2.0)));
  ASSERT_TRUE(nemesis_.step(at_seconds(3.0)));
  ASSERT_EQ(started_.size(), 1U);
  EXPECT_EQ(nemesis_.clock_off(kOne), milliseconds{2100});
  EXPECT_EQ(started_[0], Nemesis::kRoom_bytes);
}

TEST_F(NemesisTest, WhoHasAFullDiskIsRefusedWhatGoesBeyondAndLives) {
  // It writes for as long as it may, says when it may not any more, and goes on.
  auto child = ChildProcess::start(
      {"/bin/sh", "-c",
       "while dd if=/dev/zero bs=1000 count=1 2>/dev/null >>" + (folder_ / "data").string() +
           "; do :; done; echo refused; exec sleep 1000"},
      folder_ / "full.log", {});
  ASSERT_TRUE(child);
  programs_.erase(kOne);
  programs_.emplace(kOne, std::move(child).value());
  ASSERT_TRUE(nemesis_.begin({{}, {}, DiskFull{kOne}}, {}, at_seconds(1.0)));
  bool refused = false;
  for (int i = 0; i < 1000 && !refused; ++i) {
    std::this_thread::sleep_for(milliseconds{10});
    std::ifstream log{folder_ / "full.log"};
    for (std::string line; std::getline(log, line);) refused = refused || line == "refused";
  }
  EXPECT_TRUE(refused);
  EXPECT_FALSE(programs_.at(kOne).ended());
}

TEST_F(NemesisTest, WhatItHasStoppedGoesOnInTheEnd) {
  ASSERT_TRUE(nemesis_.begin({{}, seconds{400}, ProgramsStall{{kTwo}}}, {kTwo}, at_seconds(1.0)));
  EXPECT_TRUE(comes_to(programs_.at(kTwo), true));
  nemesis_.let_go();
  EXPECT_TRUE(comes_to(programs_.at(kTwo), false));
}

}  // namespace
}  // namespace skein::hil
