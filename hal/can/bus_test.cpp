// SPDX-License-Identifier: Apache-2.0
#include "skein/can/bus.hpp"

#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "test_frames.hpp"

namespace skein::can {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kPatience{20};  // a loaded machine; nothing waits for it to pass

std::unique_ptr<Bus> opened(const std::string& name) {
  auto bus = open(name);
  EXPECT_TRUE(bus) << (bus ? "" : bus.error().message);
  return bus ? std::move(*bus) : nullptr;
}

/// Waits for frames until there are `count` of them.
std::vector<Frame> receive(Bus& bus, std::size_t count) {
  std::vector<Frame> frames;
  const auto deadline = Clock::now() + kPatience;
  while (frames.size() < count && Clock::now() < deadline) {
    while (auto frame = bus.receive()) frames.push_back(*frame);
    if (frames.size() >= count) break;
    pollfd waiting{bus.descriptor(), POLLIN, 0};
    (void)::poll(&waiting, 1, 100);
  }
  return frames;
}

/// The kernel begins to stamp what arrives some time after the first socket of the machine asked
/// for it; until then a frame has the time at which it is read, so that its time may be later than
/// that of one behind it.
void wait_until_arrivals_are_stamped(Bus& from, Bus& to) {
  const auto deadline = Clock::now() + kPatience;
  while (Clock::now() < deadline) {
    ASSERT_TRUE(from.send(Frame{}));
    pollfd waiting{to.descriptor(), POLLIN, 0};
    while (::poll(&waiting, 1, 1000) != 1) ASSERT_LT(Clock::now(), deadline);
    const Duration there = std::chrono::system_clock::now().time_since_epoch();
    const auto frame = to.receive();
    ASSERT_TRUE(frame);
    if (frame->timestamp <= there) return;
  }
  FAIL() << "frames have the times at which they were read";
}

/// Every test runs on its own bus, so that tests of other processes are not heard: the group is
/// chosen by the process.
std::string own_mcast() { return "mcast:" + std::to_string(100 + ::getpid() % 150); }

/// The buses that there are here: multicast always, SocketCAN where an interface is named.
class BusTest : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (std::string_view{GetParam()} == "mcast") {
      name_ = own_mcast();
      return;
    }
    // One thread. NOLINTNEXTLINE(concurrency-mt-unsafe)
    const char* interface = std::getenv("SKEIN_CAN_INTERFACE");
    name_ = interface != nullptr ? interface : "vcan0";
    const auto bus = open(name_);
    if (!bus && interface == nullptr) {
      GTEST_SKIP() << "SocketCAN is not tested here: " << bus.error().message
                   << " (SKEIN_CAN_INTERFACE names another interface)";
    }
    ASSERT_TRUE(bus) << bus.error().message;
  }

  std::string name_;
};

INSTANTIATE_TEST_SUITE_P(, BusTest, testing::Values("mcast", "socketcan"),
                         [](const auto& kind) { return std::string{kind.param}; });

TEST_P(BusTest, FramesArriveAsTheyWereSent) {
  auto a = opened(name_);
  auto b = opened(name_);
  ASSERT_TRUE(a && b);
  ASSERT_NO_FATAL_FAILURE(wait_until_arrivals_are_stamped(*a, *b));
  const auto sent_before = a->statistics().sent;
  const auto received_before = b->statistics().received;
  Random random{1};
  std::vector<Frame> sent;
  for (int i = 0; i < 100; ++i) {
    Frame frame = random_frame(random);
    frame.brs = false;
    if (frame.fd && !a->fd()) continue;
    ASSERT_TRUE(a->send(frame));
    sent.push_back(frame);
  }
  const auto received = receive(*b, sent.size());
  ASSERT_EQ(received.size(), sent.size());
  for (std::size_t i = 0; i < sent.size(); ++i) {
    EXPECT_TRUE(same_content(received[i], sent[i])) << i;
    EXPECT_GT(received[i].timestamp, std::chrono::hours{24 * 365 * 50}) << "the kernel's time";
  }
  EXPECT_TRUE(std::is_sorted(received.begin(), received.end(), [](const Frame& x, const Frame& y) {
    return x.timestamp < y.timestamp;
  }));
  EXPECT_EQ(a->statistics().sent - sent_before, sent.size());
  EXPECT_EQ(b->statistics().received - received_before, sent.size());
  EXPECT_EQ(b->statistics().lost, 0U);
}

TEST_P(BusTest, OwnFramesAreNotReceived) {
  auto a = opened(name_);
  auto b = opened(name_);
  ASSERT_TRUE(a && b);
  Frame mine;
  mine.id = 1;
  Frame theirs;
  theirs.id = 2;
  ASSERT_TRUE(a->send(mine));
  ASSERT_TRUE(b->send(theirs));
  const auto received = receive(*a, 1);
  ASSERT_EQ(received.size(), 1U);
  EXPECT_EQ(received[0].id, 2U);
  EXPECT_FALSE(a->receive());
}

TEST_P(BusTest, FiltersLetThroughWhatTheySay) {
  auto a = opened(name_);
  auto b = opened(name_);
  ASSERT_TRUE(a && b);
  ASSERT_TRUE(b->set_filters(std::vector<Filter>{{0x100BB900, 0x00FFFF00, true}}));
  for (const std::uint32_t id : {0x100BB90AU, 0x1001550AU, 0x080BB92AU}) {
    Frame frame;
    frame.extended = true;
    frame.id = id;
    ASSERT_TRUE(a->send(frame));
  }
  Frame standard;
  standard.id = 0x100;
  ASSERT_TRUE(a->send(standard));
  const auto received = receive(*b, 2);
  ASSERT_EQ(received.size(), 2U);
  EXPECT_EQ(received[0].id, 0x100BB90AU);
  EXPECT_EQ(received[1].id, 0x080BB92AU);
  ASSERT_TRUE(b->set_filters({}));
  ASSERT_TRUE(a->send(standard));
  const auto all = receive(*b, 1);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].id, 0x100U) << "filtered ones had gone, not waited";
}

/// A burst far beyond what a queue of the kernel holds: nothing is skipped, nothing overtakes.
TEST_P(BusTest, ABurstKeepsItsOrder) {
  auto a = opened(name_);
  auto b = opened(name_);
  ASSERT_TRUE(a && b);
  constexpr std::uint32_t kFrames = 5000;
  std::uint32_t sent = 0;
  std::uint32_t expected = 0;
  const auto deadline = Clock::now() + kPatience;
  while (expected < kFrames && Clock::now() < deadline) {
    std::vector<Frame> transfer(19);
    for (Frame& frame : transfer) {
      frame.extended = true;
      frame.id = sent + static_cast<std::uint32_t>(&frame - transfer.data());
    }
    if (sent < kFrames && a->send(transfer)) sent += 19;
    a->flush();
    while (const auto frame = b->receive()) ASSERT_EQ(frame->id, expected++);
  }
  EXPECT_GE(expected, kFrames);
  EXPECT_EQ(b->statistics().lost, 0U);
}

TEST_P(BusTest, WhatNobodyReadsIsCountedAsLost) {
  auto a = opened(name_);
  ASSERT_TRUE(a);
  BusOptions small;
  small.receive_buffer_bytes = 4096;
  auto b = open(name_, small);
  ASSERT_TRUE(b);
  constexpr std::uint64_t kFrames = 2000;
  const auto deadline = Clock::now() + kPatience;
  for (std::uint64_t i = 0; i < kFrames; ++i) {
    Frame frame;
    frame.id = 7;
    while (!a->send(frame) && Clock::now() < deadline) a->flush();
  }
  while (a->pending() > 0 && Clock::now() < deadline) a->flush();
  std::uint64_t received = 0;
  while ((*b)->receive()) ++received;
  EXPECT_LT(received, kFrames);
  // The kernel tells with the next frame how many it dropped before it.
  Frame last;
  last.id = 8;
  ASSERT_TRUE(a->send(last));
  const auto rest = receive(**b, 1);
  ASSERT_EQ(rest.size(), 1U);
  EXPECT_EQ((*b)->statistics().lost, kFrames - received);
}

TEST_P(BusTest, ManyListen) {
  auto a = opened(name_);
  auto b = opened(name_);
  auto c = opened(name_);
  ASSERT_TRUE(a && b && c);
  Frame frame;
  frame.id = 42;
  ASSERT_TRUE(a->send(frame));
  EXPECT_EQ(receive(*b, 1).size(), 1U);
  EXPECT_EQ(receive(*c, 1).size(), 1U);
}

TEST(OpenBus, MulticastBusesDoNotHearEachOther) {
  auto a = opened(own_mcast());
  auto other = opened("mcast:99");
  auto same = opened(own_mcast() + "@lo");
  ASSERT_TRUE(a && other && same);
  Frame frame;
  frame.id = 5;
  ASSERT_TRUE(a->send(frame));
  EXPECT_EQ(receive(*same, 1).size(), 1U);
  EXPECT_FALSE(other->receive());
}

TEST(OpenBus, ReasonsSayWhatToDo) {
  const auto reason = [](const std::string& name) {
    const auto bus = open(name);
    return bus ? std::string{"opened"} : bus.error().message;
  };
  EXPECT_NE(reason("mcast:256").find("from 0 to 255"), std::string::npos);
  EXPECT_NE(reason("mcast:").find("mcast:NUMBER"), std::string::npos);
  EXPECT_NE(reason("mcast:1x").find("mcast:NUMBER"), std::string::npos);
  EXPECT_NE(reason("mcast:1@").find("mcast:NUMBER"), std::string::npos);
  EXPECT_NE(reason("mcast:1@none9").find("no interface 'none9'"), std::string::npos);
  EXPECT_NE(reason("").find("names no bus"), std::string::npos);
  EXPECT_NE(reason("a name").find("names no bus"), std::string::npos);
  const std::string missing = reason("can_missing9");
  EXPECT_TRUE(missing.find("no CAN") != std::string::npos ||
              missing.find("no such interface") != std::string::npos)
      << missing;
}

}  // namespace
}  // namespace skein::can
