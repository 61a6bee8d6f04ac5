// SPDX-License-Identifier: Apache-2.0
#include "queued_bus.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <deque>
#include <thread>
#include <vector>

namespace skein::can {
namespace {

/// A kernel that does as it is told.
class ToldBus final : public QueuedBus {
 public:
  explicit ToldBus(std::size_t capacity) : QueuedBus{"told", capacity} {}

  [[nodiscard]] int descriptor() const override { return -1; }
  Result<void> set_filters(std::span<const Filter> /*filters*/) override { return {}; }
  [[nodiscard]] bool fd() const override { return false; }

  std::size_t room = 0;  ///< frames that the kernel takes
  bool there = true;     ///< the interface
  std::deque<State> heard;
  std::vector<std::uint32_t> written;

 protected:
  Written write(const Frame& frame) override {
    if (!there) return Written::gone;
    if (room == 0) return Written::no_room;
    --room;
    written.push_back(frame.id);
    return Written::done;
  }
  std::optional<Frame> read() override {
    if (heard.empty()) return std::nullopt;
    enter(heard.front());
    heard.pop_front();
    Frame frame;
    frame.error = true;
    return frame;
  }
  bool reattach() override { return there; }
};

std::vector<Frame> transfer(std::uint32_t first, std::uint32_t count) {
  std::vector<Frame> frames(count);
  for (std::uint32_t i = 0; i < count; ++i) frames[i].id = first + i;
  return frames;
}

/// The interface is looked for now and then only.
template <class Done>
void call_until(ToldBus& bus, Done done) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds{20};
  while (!done() && std::chrono::steady_clock::now() < deadline) {
    bus.flush();
    std::this_thread::yield();
  }
}

TEST(QueuedBus, WithoutRoomFramesWaitAndGoInOrder) {
  ToldBus bus{100};
  bus.room = 5;
  ASSERT_TRUE(bus.send(transfer(0, 19)));
  ASSERT_TRUE(bus.send(transfer(19, 19)));
  EXPECT_EQ(bus.pending(), 33U);
  EXPECT_GT(bus.statistics().retries, 0U);
  for (int i = 0; i < 11; ++i) {
    bus.room = 3;
    bus.flush();
  }
  ASSERT_EQ(bus.written.size(), 38U);
  for (std::uint32_t i = 0; i < 38; ++i) EXPECT_EQ(bus.written[i], i);
  EXPECT_EQ(bus.statistics().sent, 38U);
}

TEST(QueuedBus, ATransferIsTakenWholeOrNotAtAll) {
  ToldBus bus{20};
  ASSERT_TRUE(bus.send(transfer(0, 19)));
  EXPECT_FALSE(bus.send(transfer(19, 2)));
  EXPECT_EQ(bus.pending(), 19U);
  EXPECT_EQ(bus.statistics().refused, 2U);
  EXPECT_TRUE(bus.send(transfer(19, 1)));
  bus.room = 100;
  bus.flush();
  ASSERT_TRUE(bus.send(transfer(20, 20))) << "the ring goes round";
  for (std::uint32_t i = 0; i < 40; ++i) ASSERT_EQ(bus.written.at(i), i);
}

TEST(QueuedBus, BusOffDiscardsAndRefusesUntilTheRestart) {
  ToldBus bus{100};
  ASSERT_TRUE(bus.send(transfer(0, 10)));
  bus.heard = {State::error_passive};
  ASSERT_TRUE(bus.receive());
  EXPECT_EQ(bus.state(), State::error_passive);
  EXPECT_EQ(bus.pending(), 10U) << "passive still sends";
  bus.heard = {State::bus_off};
  ASSERT_TRUE(bus.receive());
  EXPECT_EQ(bus.pending(), 0U);
  EXPECT_EQ(bus.statistics().discarded, 10U);
  bus.room = 100;
  EXPECT_FALSE(bus.send(transfer(10, 1)));
  bus.heard = {State::error_active};
  ASSERT_TRUE(bus.receive());
  EXPECT_TRUE(bus.send(transfer(20, 1)));
  EXPECT_EQ(bus.written, std::vector<std::uint32_t>{20});
  EXPECT_EQ(bus.statistics().bus_offs, 1U);
  EXPECT_EQ(bus.statistics().restarts, 1U);
  EXPECT_EQ(bus.statistics().error_frames, 3U);
}

TEST(QueuedBus, AnInterfaceThatGoesIsTakenUpAgain) {
  ToldBus bus{100};
  bus.room = 100;
  bus.there = false;
  ASSERT_TRUE(bus.send(transfer(0, 3))) << "it is known only when the kernel says so";
  EXPECT_EQ(bus.state(), State::gone);
  EXPECT_EQ(bus.statistics().discarded, 3U);
  EXPECT_FALSE(bus.send(transfer(3, 1)));
  EXPECT_FALSE(bus.receive());
  bus.there = true;
  call_until(bus, [&] { return bus.state() == State::error_active; });
  EXPECT_TRUE(bus.send(transfer(4, 1)));
  EXPECT_EQ(bus.written, std::vector<std::uint32_t>{4});
  EXPECT_EQ(bus.statistics().restarts, 1U);
}

TEST(QueuedBus, WhatIsForgottenIsNotSentLater) {
  ToldBus bus{8};
  ASSERT_TRUE(bus.send(transfer(1, 3)));
  bus.discard();
  EXPECT_EQ(bus.pending(), 0U);
  EXPECT_EQ(bus.statistics().discarded, 3U);
  bus.room = 8;
  ASSERT_TRUE(bus.send(transfer(4, 1)));
  EXPECT_EQ(bus.written, std::vector{4U});
}

TEST(QueuedBus, ABusThatIsGoneIsReadEmpty) {
  ToldBus bus{8};
  bus.there = false;
  bus.heard = {State::gone, State::gone, State::gone};
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(bus.receive().has_value());
  EXPECT_FALSE(bus.receive().has_value());
  EXPECT_EQ(bus.state(), State::gone);
}

}  // namespace
}  // namespace skein::can
