// SPDX-License-Identifier: Apache-2.0
#include "link_listener.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace skein::hil {
namespace {

using namespace std::chrono_literals;

constexpr VehicleId kOne{1};
constexpr VehicleId kTwo{2};
const radio::Link kUp{true, 0.02, 20ms, 5ms, std::nullopt};
const radio::Link kDown{false, 0.02, 20ms, 5ms, std::nullopt};

class LinkListenerTest : public testing::Test {
 protected:
  std::filesystem::path log_ = std::filesystem::temp_directory_path() /
                               ("skein-links-" + std::to_string(::getpid()) + ".log");
  void TearDown() override { std::filesystem::remove(log_); }
  [[nodiscard]] std::string output() const {
    std::stringstream text;
    text << std::ifstream{log_}.rdbuf();
    return text.str();
  }
};

TEST_F(LinkListenerTest, IsToldOfEachChangeOnce) {
  auto listener = LinkListener::start("cat", log_);
  ASSERT_TRUE(listener);
  for (const auto& link : {kUp, kUp, kDown, kUp}) {
    listener->tell(kOne, kTwo, link);
    listener->tell(kTwo, kOne, kDown);
    listener->hand_on();
  }
  EXPECT_TRUE(listener->stop()) << "it ends with its input";
  EXPECT_EQ(output(),
            "1 2 up 20.000 5.000 0.020000\n"
            "2 1 down\n"
            "1 2 down\n"
            "1 2 up 20.000 5.000 0.020000\n");
}

TEST_F(LinkListenerTest, WhoDoesNotReadStopsNobody) {
  auto listener = LinkListener::start("exec sleep 1000", log_);
  ASSERT_TRUE(listener);
  for (int i = 0; i < 100'000; ++i) {
    listener->tell(kOne, kTwo, i % 2 == 0 ? kUp : kDown);
    if (i % 100 == 0) listener->hand_on();
  }
  EXPECT_FALSE(listener->ended());
}

TEST_F(LinkListenerTest, WhoReadsLateIsToldWhatEachLinkIsByThen) {
  const std::filesystem::path go = log_.string() + ".go";
  auto listener =
      LinkListener::start("while [ ! -e " + go.string() + " ]; do sleep 0.01; done; cat", log_);
  ASSERT_TRUE(listener);
  constexpr int kChanges = 100'000;  // far more than a socket holds
  for (int i = 0; i < kChanges; ++i) {
    listener->tell(kOne, kTwo, i % 2 == 0 ? kUp : kDown);
    if (i % 100 == 99) listener->tell(kTwo, kOne, i % 200 == 99 ? kUp : kDown);
    listener->hand_on();
  }
  std::ofstream{go} << "go";
  const auto end = std::chrono::steady_clock::now() + 60s;
  const std::string newest = "1 2 down\n2 1 down\n";
  while (!output().ends_with(newest) && std::chrono::steady_clock::now() < end) {
    listener->hand_on();
    ::usleep(1000);
  }
  std::filesystem::remove(go);
  const std::string told = output();
  EXPECT_TRUE(told.ends_with(newest));
  EXPECT_LT(std::ranges::count(told, '\n'), kChanges / 2);
  EXPECT_TRUE(listener->stop());
}

TEST_F(LinkListenerTest, ItsEndIsTold) {
  auto listener = LinkListener::start("exit 3", log_);
  ASSERT_TRUE(listener);
  while (!listener->ended()) ::usleep(1000);
  EXPECT_EQ(listener->ended(), "exit status 3");
  listener->tell(kOne, kTwo, kUp);
  listener->hand_on();  // into the void
}

}  // namespace
}  // namespace skein::hil
