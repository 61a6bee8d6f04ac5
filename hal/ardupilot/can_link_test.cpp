// SPDX-License-Identifier: Apache-2.0
#include "skein/ardupilot/can_link.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <memory>
#include <string>
#include <utility>

#include "autopilot_double.hpp"

namespace skein::ardupilot {
namespace {

using State = Companion::State;
using std::chrono::milliseconds;

/// What is on the wire, by who has not read it yet.
struct Wire {
  std::vector<std::deque<can::Frame>*> ears;
  bool cut = false;
  int discards = 0;
};

/// A bus in memory.
class WireBus final : public can::Bus {
 public:
  explicit WireBus(Wire& wire) : wire_{&wire} { wire.ears.push_back(&heard_); }
  WireBus(const WireBus&) = delete;
  WireBus& operator=(const WireBus&) = delete;
  ~WireBus() override { std::erase(wire_->ears, &heard_); }

  using Bus::send;
  bool send(std::span<const can::Frame> frames) override {
    if (wire_->cut) return false;
    for (auto* ear : wire_->ears) {
      if (ear != &heard_) ear->insert(ear->end(), frames.begin(), frames.end());
    }
    return true;
  }
  void flush() override {}
  [[nodiscard]] std::size_t pending() const override { return 0; }
  void discard() override { ++wire_->discards; }
  std::optional<can::Frame> receive() override {
    if (heard_.empty()) return std::nullopt;
    const can::Frame frame = heard_.front();
    heard_.pop_front();
    return frame;
  }
  [[nodiscard]] int descriptor() const override { return -1; }
  Result<void> set_filters(std::span<const can::Filter> /*filters*/) override { return {}; }
  [[nodiscard]] can::State state() const override { return can::State::error_active; }
  [[nodiscard]] const can::Statistics& statistics() const override { return statistics_; }
  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] bool fd() const override { return false; }

 private:
  Wire* wire_;
  std::deque<can::Frame> heard_;
  can::Statistics statistics_;
  std::string name_ = "wire";
};

/// The flight controller's node, with the double behind it.
struct FlightControllerNode {
  FlightControllerNode(Wire& wire, Instant now)
      : bus{wire}, node{node_params(), now}, port{tunnel_params(), now}, autopilot{now} {}
  static dronecan::NodeParams node_params() {
    dronecan::NodeParams p;
    p.node_id = 10;
    return p;
  }
  static dronecan::TunnelParams tunnel_params() {
    dronecan::TunnelParams p;
    p.remote_node = 42;
    return p;
  }
  void step(Instant now) {
    while (const auto frame = bus.receive()) {
      if (const auto* transfer = node.on_frame(*frame, 0, now))
        port.on_transfer(*transfer, 10, now);
    }
    std::array<std::uint8_t, 256> bytes{};
    while (const auto size = port.read(bytes)) autopilot.hear(std::span{bytes}.first(size), now);
    (void)port.write(autopilot.speak(now));
    port.step(node, now);
    node.step(now);
    for (auto frames = node.front(); !frames.empty(); frames = node.front()) {
      (void)bus.send(frames);
      node.pop();
    }
  }
  WireBus bus;
  dronecan::Node node;
  dronecan::TunnelPort port;
  AutopilotDouble autopilot;
};

CanLinkParams link_params() {
  CanLinkParams p;
  p.companion.take_over = TakeOver::in_flight;
  p.companion.vehicle.id = {3};
  p.companion.vehicle.speed_min_mps = 40.0;
  p.companion.vehicle.speed_max_mps = 60.0;
  p.companion.vehicle.turn_radius_m = 150.0;
  return p;
}

struct Bench {
  Instant now = at_seconds(-5.0);
  Wire wire;
  std::unique_ptr<FlightControllerNode> fc = std::make_unique<FlightControllerNode>(wire, now);
  CanLink link{std::make_unique<WireBus>(wire), link_params(),
               MissionOrigin::make(kTestOrigin).value(), now};

  void run(double seconds) {
    for (const Instant end = now + from_seconds(seconds); now < end;) {
      now += milliseconds{5};
      if (fc) fc->step(now);
      link.companion().command(
          Setpoint{.heading_rad = 0.6, .airspeed_mps = 50.0, .height_m = 300.0}, now);
      link.step(now);
    }
  }
};

TEST(CanLink, FliesOverTheTunnel) {
  Bench bench;
  bench.run(6.0);
  ASSERT_EQ(bench.link.companion().state(), State::flying);
  const auto before = bench.fc->autopilot.attitudes.size();
  bench.run(2.0);
  EXPECT_GE(bench.fc->autopilot.attitudes.size() - before, 40U);
  EXPECT_EQ(bench.link.reassembly().broken(), 0U);
  EXPECT_EQ(bench.link.companion().parser().lost, 0U);
  EXPECT_EQ(bench.link.transfers_dropped(), 0U);
}

TEST(CanLink, HasAUniqueIdThatStaysTheSame) {
  Bench first;
  first.run(2.0);
  Bench second;
  second.run(2.0);
  const auto* a = first.fc->node.find(42);
  const auto* b = second.fc->node.find(42);
  ASSERT_TRUE(a != nullptr && b != nullptr && a->info && b->info);
  EXPECT_EQ(a->info->hardware_version.unique_id, b->info->hardware_version.unique_id);
  EXPECT_NE(a->info->hardware_version.unique_id, dronecan::UniqueId{});
}

TEST(CanLink, KeepsNothingThatABusDidNotTake) {
  Bench bench;
  bench.run(6.0);
  bench.wire.cut = true;
  bench.run(1.0);
  EXPECT_EQ(bench.link.companion().state(), State::lost);
  EXPECT_GT(bench.link.transfers_dropped(), 0U);
  bench.wire.cut = false;
  const auto before = bench.fc->autopilot.attitudes.size();
  bench.run(0.01);
  EXPECT_LE(bench.fc->autopilot.attitudes.size() - before, 1U);  // no burst of old ones
  bench.run(0.2);
  EXPECT_EQ(bench.link.companion().state(), State::flying);
}

TEST(CanLink, SeesARebootInTheNodesUptime) {
  Bench bench;
  bench.run(7.0);
  ASSERT_EQ(bench.link.companion().state(), State::flying);
  bench.fc.reset();
  bench.run(1.2);
  EXPECT_EQ(bench.link.companion().state(), State::lost);
  bench.fc = std::make_unique<FlightControllerNode>(bench.wire, bench.now);
  bench.fc->autopilot.mute = true;
  bench.run(0.1);
  EXPECT_EQ(bench.link.companion().state(), State::searching);
  bench.fc->autopilot.mute = false;
  bench.run(6.0);
  EXPECT_EQ(bench.link.companion().state(), State::flying);
}

TEST(CanLink, StopsSendingWhenASecondCompanionHasItsId) {
  Bench bench;
  bench.run(6.0);
  WireBus listener{bench.wire};
  dronecan::NodeParams params;
  params.node_id = 42;
  dronecan::Node second{params, bench.now};
  second.step(bench.now);
  WireBus intruder{bench.wire};
  ASSERT_TRUE(intruder.send(second.front()));
  bench.run(0.01);
  EXPECT_EQ(bench.link.companion().state(), State::duplicated);
  while (listener.receive()) {
  }
  bench.run(2.0);
  while (const auto frame = listener.receive()) {
    EXPECT_NE(dronecan::header_of(*frame)->source, 42);
  }
  EXPECT_TRUE(bench.link.companion().give_back(bench.now + milliseconds{10}, bench.now));
  bench.run(6.0);
  EXPECT_EQ(bench.link.companion().state(), State::flying);
}

TEST(CanLink, KnowsWhichLayerOfTheLinkIsMissing) {
  Bench bench;
  EXPECT_FALSE(bench.link.facts(bench.now));
  bench.run(6.0);
  const auto good = bench.link.facts(bench.now);
  ASSERT_TRUE(good);
  EXPECT_TRUE(good->node_heard && good->serial_heard && good->heartbeat && !good->own_id_taken);
  bench.fc->autopilot.mute = true;  // its node is on the bus all the same
  bench.run(1.0);
  EXPECT_FALSE(bench.link.facts(bench.now));
  bench.run(5.0);
  const auto silent = bench.link.facts(bench.now);
  ASSERT_TRUE(silent);
  EXPECT_TRUE(silent->node_heard && silent->serial_heard);
  EXPECT_FALSE(silent->heartbeat);
  EXPECT_EQ(silent->trouble->news, AutopilotNews::no_heartbeat);
  bench.fc.reset();
  bench.run(6.0);
  const auto dead = bench.link.facts(bench.now);
  ASSERT_TRUE(dead);
  EXPECT_FALSE(dead->node_heard);
  EXPECT_EQ(dead->trouble->news, AutopilotNews::no_bus_traffic);
}

TEST(CanLink, ForgetsWhatMustNotArriveLate) {
  Bench bench;
  bench.run(6.0);
  ASSERT_EQ(bench.link.companion().state(), State::flying);
  EXPECT_EQ(bench.wire.discards, 0);
  bench.fc->autopilot.mode = 6;
  bench.run(0.3);
  ASSERT_EQ(bench.link.companion().state(), State::piloted);
  EXPECT_EQ(bench.wire.discards, 1);
  ASSERT_TRUE(bench.link.companion().give_back(bench.now, bench.now));
  bench.run(1.0);
  ASSERT_EQ(bench.link.companion().state(), State::flying);
  bench.wire.cut = true;
  bench.run(1.0);
  ASSERT_EQ(bench.link.companion().state(), State::lost);
  EXPECT_EQ(bench.wire.discards, 2);
}

TEST(CanLink, IsNotGivenBackWhileASecondFlightControllerHasItsId) {
  Bench bench;
  bench.run(6.0);
  WireBus bus{bench.wire};
  dronecan::Node second{FlightControllerNode::node_params(), bench.now};
  const auto run_both = [&](double seconds) {
    for (const Instant end = bench.now + from_seconds(seconds); bench.now < end;) {
      bench.run(0.1);
      second.step(bench.now);
      for (auto frames = second.front(); !frames.empty(); frames = second.front()) {
        ASSERT_TRUE(bus.send(frames));
        second.pop();
      }
    }
  };
  run_both(10.0);
  ASSERT_EQ(bench.link.companion().state(), State::duplicated);
  for (int i = 0; i < 5; ++i) {
    run_both(1.0);
    EXPECT_FALSE(bench.link.companion().give_back(bench.now, bench.now));
  }
  bench.run(3.0);  // it has been taken off the bus
  EXPECT_TRUE(bench.link.companion().give_back(bench.now, bench.now));
}

}  // namespace
}  // namespace skein::ardupilot
