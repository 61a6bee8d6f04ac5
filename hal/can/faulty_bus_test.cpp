// SPDX-License-Identifier: Apache-2.0
#include "skein/can/faulty_bus.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <memory>
#include <vector>

namespace skein::can {
namespace {

/// A bus in memory: what is sent can be looked at, what is put in is received.
class MemoryBus final : public Bus {
 public:
  using Bus::send;
  bool send(std::span<const Frame> frames) override {
    sent.insert(sent.end(), frames.begin(), frames.end());
    return true;
  }
  void flush() override {}
  [[nodiscard]] std::size_t pending() const override { return 0; }
  void discard() override {}
  std::optional<Frame> receive() override {
    if (incoming.empty()) return std::nullopt;
    const Frame frame = incoming.front();
    incoming.pop_front();
    return frame;
  }
  [[nodiscard]] int descriptor() const override { return -1; }
  Result<void> set_filters(std::span<const Filter> /*filters*/) override { return {}; }
  [[nodiscard]] State state() const override { return State::error_active; }
  [[nodiscard]] const Statistics& statistics() const override { return statistics_; }
  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] bool fd() const override { return true; }

  std::vector<Frame> sent;
  std::deque<Frame> incoming;

 private:
  Statistics statistics_;
  std::string name_ = "memory";
};

Frame numbered(std::uint32_t number) {
  Frame frame;
  frame.extended = true;
  frame.id = number;
  return frame;
}

struct FaultyBusTest : testing::Test {
  void send(std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) {
      if (!bus.send(numbered(i))) ++refused;
    }
  }
  std::vector<std::uint32_t> receive(std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i) memory->incoming.push_back(numbered(i));
    std::vector<std::uint32_t> ids;
    while (const auto frame = bus.receive()) ids.push_back(frame->id);
    return ids;
  }

  std::unique_ptr<MemoryBus> owned = std::make_unique<MemoryBus>();
  MemoryBus* memory = owned.get();
  FaultyBus bus{std::move(owned), Random{1}};
  std::uint32_t refused = 0;
};

BusFaults with(double BusFaults::*fault, double value) {
  BusFaults faults;
  faults.*fault = value;
  return faults;
}

TEST_F(FaultyBusTest, WithoutFaultsItIsTheBusBelow) {
  send(100);
  EXPECT_EQ(memory->sent.size(), 100U);
  const auto ids = receive(100);
  ASSERT_EQ(ids.size(), 100U);
  EXPECT_TRUE(std::is_sorted(ids.begin(), ids.end()));
}

TEST_F(FaultyBusTest, LossTakesItsShareBothWays) {
  bus.set(with(&BusFaults::loss, 0.25));
  send(4000);
  EXPECT_NEAR(static_cast<double>(memory->sent.size()), 3000, 150);
  const auto received = receive(4000).size();
  EXPECT_NEAR(static_cast<double>(received), 3000, 150);
  EXPECT_EQ(bus.lost_by_intent(), 8000 - memory->sent.size() - received);
}

TEST_F(FaultyBusTest, DuplicatesComeInPairs) {
  bus.set(with(&BusFaults::duplication, 1));
  EXPECT_EQ(receive(3), (std::vector<std::uint32_t>{0, 0, 1, 1, 2, 2}));
}

TEST_F(FaultyBusTest, ReorderChangesPlacesAndLosesNothing) {
  bus.set(with(&BusFaults::reorder, 0.3));
  auto ids = receive(1000);
  ASSERT_EQ(ids.size(), 1000U);
  EXPECT_FALSE(std::is_sorted(ids.begin(), ids.end()));
  std::sort(ids.begin(), ids.end());
  for (std::uint32_t i = 0; i < 1000; ++i) ASSERT_EQ(ids[i], i);
}

TEST_F(FaultyBusTest, AFullBusKeepsWhatIsSentThenRefuses) {
  bus.set(with(&BusFaults::load, 1));
  send(2000);
  EXPECT_TRUE(memory->sent.empty());
  EXPECT_EQ(bus.pending(), 1024U);
  EXPECT_EQ(refused, 2000U - 1024U);
  bus.set({});
  bus.flush();
  ASSERT_EQ(memory->sent.size(), 1024U);
  for (std::uint32_t i = 0; i < 1024; ++i) ASSERT_EQ(memory->sent[i].id, i);
}

TEST_F(FaultyBusTest, ALoadedBusIsSlowerAndKeepsTheOrder) {
  bus.set(with(&BusFaults::load, 0.9));
  send(100);
  EXPECT_LT(memory->sent.size(), 100U);
  for (int i = 0; i < 5000 && bus.pending() > 0; ++i) bus.flush();
  ASSERT_EQ(memory->sent.size(), 100U);
  for (std::uint32_t i = 0; i < 100; ++i) ASSERT_EQ(memory->sent[i].id, i);
}

TEST_F(FaultyBusTest, BusOffAndUnpluggedStopEverythingUntilTheyEnd) {
  for (const bool off : {true, false}) {
    BusFaults faults;
    faults.bus_off = off;
    faults.unplugged = !off;
    const auto before = memory->sent.size();
    bus.set(faults);
    EXPECT_EQ(bus.state(), off ? State::bus_off : State::gone);
    EXPECT_FALSE(bus.send(numbered(1)));
    EXPECT_TRUE(receive(5).empty());
    bus.set({});
    EXPECT_EQ(bus.state(), State::error_active);
    EXPECT_TRUE(bus.send(numbered(2)));
    EXPECT_EQ(memory->sent.size(), before + 1);
    EXPECT_EQ(receive(5).size(), 5U) << "what came meanwhile is gone";
  }
  EXPECT_EQ(bus.statistics().bus_offs, 1U);
  EXPECT_EQ(bus.statistics().restarts, 2U);
  EXPECT_EQ(bus.statistics().refused, 2U);
}

TEST_F(FaultyBusTest, WhatWaitedIsDiscardedAtBusOff) {
  bus.set(with(&BusFaults::load, 1));
  send(10);
  BusFaults off;
  off.bus_off = true;
  bus.set(off);
  EXPECT_EQ(bus.statistics().discarded, 10U);
  EXPECT_EQ(bus.pending(), 0U);
}

TEST_F(FaultyBusTest, ABabblingNodeSendsAtItsRate) {
  bus.set(with(&BusFaults::babble_hz, 500));
  for (int ms = 0; ms <= 2000; ++ms) bus.babble(Instant{std::chrono::milliseconds{ms}});
  EXPECT_NEAR(static_cast<double>(memory->sent.size()), 1000, 1);
  EXPECT_EQ(memory->sent[0].id, 0U);
  EXPECT_NE(memory->sent[0].data, memory->sent[1].data);
  const auto before = memory->sent.size();
  bus.set({});
  bus.babble(Instant{std::chrono::seconds{10}});
  EXPECT_EQ(memory->sent.size(), before);
  bus.set(with(&BusFaults::babble_hz, 500));
  bus.babble(Instant{std::chrono::milliseconds{10'001}});
  EXPECT_EQ(memory->sent.size(), before) << "not for the time when it was silent";
}

TEST(FaultyBus, TheSameSeedGoesWrongInTheSameWay) {
  const auto run = [] {
    auto owned = std::make_unique<MemoryBus>();
    MemoryBus* memory = owned.get();
    FaultyBus bus{std::move(owned), Random{7}};
    BusFaults faults;
    faults.loss = 0.1;
    faults.duplication = 0.1;
    faults.reorder = 0.1;
    bus.set(faults);
    for (std::uint32_t i = 0; i < 500; ++i) (void)bus.send(numbered(i));
    std::vector<std::uint32_t> ids;
    for (const Frame& frame : memory->sent) ids.push_back(frame.id);
    return ids;
  };
  EXPECT_EQ(run(), run());
}

}  // namespace
}  // namespace skein::can
