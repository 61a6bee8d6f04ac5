// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/status.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <random>
#include <thread>

namespace skein::onboard {
namespace {

using ::testing::HasSubstr;

Status status() {
  Status made;
  made.health.vehicle = {7};
  made.health.program = "skein-onboard 0.2.0";
  made.health.mode = "GUIDED";
  made.health.problems = {"12 control periods missed"};
  made.health.heard = {{{3}, std::chrono::milliseconds{400}}};
  made.now = at_seconds(61.5);
  made.network_restarts = 2;
  made.clock = process::ClockState{true, std::chrono::microseconds{1500}};
  made.recording = Status::Recording{"rec", 5'000'000'000, 2'000'000, 1500.0};
  return made;
}

class Socket : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::filesystem::path folder_ = std::filesystem::temp_directory_path() /
                                  ("skein-status-" + std::to_string(std::random_device{}()));
  std::string path_ = folder_ / "onboard-7.sock";
};

TEST(Status, IsALineForProgramsAndATextForPeople) {
  const std::string json = status_json(status());
  EXPECT_EQ(json.find('\n'), std::string::npos);
  EXPECT_THAT(json, HasSubstr(R"("flying":null)"));
  const auto text = status_text(json);
  ASSERT_TRUE(text.ok()) << text.error().message;
  EXPECT_EQ(*text,
            "vehicle     7, skein-onboard 0.2.0\n"
            "flying      not known\n"
            "mode        GUIDED\n"
            "mission     61.5 s\n"
            "clock       synchronised to 0.002 s\n"
            "recording   rec, 2.0 MB, 1.5 kB/s; 5000 MB free\n"
            "progress    control 0.0 s ago, agent 0.0 s ago, not watched\n"
            "network     started again 2 times\n"
            "hears       3 (0.4 s)\n"
            "problem     12 control periods missed\n");
  EXPECT_FALSE(status_text("{}").ok());
  EXPECT_FALSE(status_text("no").ok());
}

TEST(Status, SaysWhetherTheVehicleFlies) {
  for (const auto airborne : {hal::Airborne::unknown, hal::Airborne::no, hal::Airborne::yes}) {
    Status said = status();
    said.airborne = airborne;
    EXPECT_EQ(airborne_in(status_json(said)), airborne);
  }
  EXPECT_EQ(airborne_in("gibberish"), hal::Airborne::unknown);
}

TEST(Status, HealthTellsWhatTheNetworkCountsOfThoseThatAreHeard) {
  mission::Health health;
  health.heard = {{{3}, std::chrono::milliseconds{400}}, {{4}, std::chrono::milliseconds{500}}};
  const auto told = with_receptions(health, {{{3}, 98, 2, 1000}, {{9}, 1, 0, 10}});
  ASSERT_EQ(told.heard.size(), 2U);
  EXPECT_EQ(told.heard[0].datagrams, 98);
  EXPECT_EQ(told.heard[0].lost_percent, 2);
  EXPECT_EQ(told.heard[1].lost_percent, 255);  // not counted, so not told
}

TEST(HealthBoard, AddsWhatTheHostKnowsWithinTheMessagesLimit) {
  HealthBoard board;
  mission::Health health;
  EXPECT_TRUE(board.with_host(health).problems.empty());
  mission::HostFacts facts;
  facts.clock = mission::HostFacts::Clock{false, {}};
  board.put(facts);
  EXPECT_EQ(board.with_host(health).problems.size(), 1U);
  health.problems.assign(mission::kProblemsMax, "another");
  EXPECT_EQ(board.with_host(health).problems, health.problems);
}

TEST_F(Socket, GivesALineToWhoeverConnects) {
  auto opened = StatusSocket::open(path_);
  ASSERT_TRUE(opened.ok()) << opened.error().message;
  std::atomic<bool> done{false};
  std::thread server{[&] {
    while (!done) (*opened)->serve([] { return std::string{"{\"flying\":false}"}; });
  }};
  const auto asked = ask_status(path_, std::chrono::seconds{60});
  done = true;
  server.join();
  EXPECT_FALSE(asked.failed);
  EXPECT_EQ(asked.line, "{\"flying\":false}");
  EXPECT_FALSE(StatusSocket::open(path_).ok());  // somebody listens
}

TEST_F(Socket, TellsWhoIsNotThereFromWhoIsSilent) {
  EXPECT_EQ(ask_status(path_, std::chrono::seconds{1}).failed, NoStatus::nobody_there);
  auto opened = StatusSocket::open(path_);
  ASSERT_TRUE(opened.ok());
  EXPECT_EQ(ask_status(path_, std::chrono::milliseconds{1}).failed, NoStatus::no_answer);
}

TEST_F(Socket, WaitsNoLongerBehindOthersOfOneThatStandsStill) {
  const auto opened = StatusSocket::open(path_);
  ASSERT_TRUE(opened.ok());
  for (int i = 0; i < 40; ++i) {  // nobody takes the others from its queue
    EXPECT_EQ(ask_status(path_, std::chrono::milliseconds{1}).failed, NoStatus::no_answer) << i;
  }
}

TEST_F(Socket, TellsWhoMayNotAskFromWhoIsNotThere) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may ask everybody";
  const auto opened = StatusSocket::open(path_);
  ASSERT_TRUE(opened.ok());
  std::filesystem::permissions(path_, std::filesystem::perms::none);
  EXPECT_EQ(ask_status(path_, std::chrono::seconds{1}).failed, NoStatus::not_allowed);
}

TEST_F(Socket, TakesOverWhatAProcessThatDiedHasLeft) {
  std::filesystem::path elsewhere = folder_ / "left";
  auto first = StatusSocket::open(path_);
  ASSERT_TRUE(first.ok());
  std::filesystem::create_hard_link(path_, elsewhere);
  first->reset();  // closes it, as a process that dies; its file stays at the other name
  EXPECT_EQ(ask_status(elsewhere, std::chrono::seconds{1}).failed, NoStatus::nobody_there);
  EXPECT_TRUE(StatusSocket::open(elsewhere).ok());
}

}  // namespace
}  // namespace skein::onboard
