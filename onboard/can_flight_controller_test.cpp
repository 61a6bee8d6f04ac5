// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/can_flight_controller.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "counted_calls.hpp"
#include "skein/can/bus.hpp"
#include "skein/dronecan/node.hpp"
#include "skein/dronecan/tunnel.hpp"
#include "skein/mavlink/parser.hpp"

namespace skein::onboard {
namespace {

/// A bus without anybody on it, for what only crosses threads.
class DeadBus final : public can::Bus {
 public:
  using Bus::send;
  bool send(std::span<const can::Frame> /*frames*/) override { return true; }
  void flush() override {}
  [[nodiscard]] std::size_t pending() const override { return 0; }
  void discard() override {}
  std::optional<can::Frame> receive() override {
    if (next_ == frames.size()) return std::nullopt;
    return frames[next_++];
  }
  [[nodiscard]] int descriptor() const override { return -1; }
  Result<void> set_filters(std::span<const can::Filter> /*filters*/) override { return {}; }
  [[nodiscard]] can::State state() const override { return can::State::error_active; }
  [[nodiscard]] const can::Statistics& statistics() const override { return statistics_; }
  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] bool fd() const override { return false; }

  std::vector<can::Frame> frames;

 private:
  std::size_t next_ = 0;
  can::Statistics statistics_;
  std::string name_ = "dead";
};

/// What an autopilot says to begin with: who it is, and where it is.
std::vector<can::Frame> first_words() {
  dronecan::NodeParams node_params;
  node_params.node_id = 10;
  dronecan::Node node{node_params, Instant{}};
  dronecan::TunnelParams tunnel;
  tunnel.remote_node = 42;
  dronecan::TunnelPort port{tunnel, Instant{}};
  mavlink::Encoder encoder{1, 1};
  mavlink::Heartbeat heartbeat;
  heartbeat.type = 1;
  heartbeat.autopilot = 3;
  mavlink::GlobalPositionInt position;
  position.time_boot_ms = 1000;
  position.lat = 310000000;
  position.lon = 1050000000;
  position.vy = 5000;  // east, 50 m/s
  mavlink::Attitude attitude;
  attitude.time_boot_ms = 1000;
  attitude.yaw = 1.5707964F;
  mavlink::VfrHud hud;
  hud.airspeed = 50.0F;
  EXPECT_TRUE(port.write(encoder.encode(heartbeat)));
  EXPECT_TRUE(port.write(encoder.encode(attitude)));
  EXPECT_TRUE(port.write(encoder.encode(position)));
  EXPECT_TRUE(port.write(encoder.encode(hud)));
  port.step(node, Instant{});
  std::vector<can::Frame> frames;
  for (auto next = node.front(); !next.empty(); next = node.front()) {
    frames.insert(frames.end(), next.begin(), next.end());
    node.pop();
  }
  return frames;
}

struct Cockpit {
  Cockpit() {
    auto dead = std::make_unique<DeadBus>();
    dead->frames = first_words();
    controller = std::make_unique<CanFlightController>(
        std::move(dead), ardupilot::CanLinkParams{},
        MissionOrigin::make({31.0, 105.0, 0.0}).value(), at_seconds(9.0));
  }
  std::unique_ptr<CanFlightController> controller;
};

TEST(CanFlightController, CarriesTheStateOnToTheMomentThatItIsAskedFor) {
  Cockpit cockpit;
  EXPECT_FALSE(cockpit.controller->state(at_seconds(10.0)));
  cockpit.controller->step(at_seconds(10.0));
  const auto at_once = cockpit.controller->state(at_seconds(10.0));
  ASSERT_TRUE(at_once);
  EXPECT_EQ(at_once->time, at_seconds(10.0));
  EXPECT_NEAR(at_once->x_m, 0.0, 0.01);
  EXPECT_NEAR(at_once->heading_rad, 0.0, 1e-6);
  const auto later = cockpit.controller->state(at_seconds(10.1));
  EXPECT_EQ(later->time, at_seconds(10.1));
  EXPECT_NEAR(later->x_m, 5.0, 0.01);
  // What is old stays old, and control sees it.
  EXPECT_EQ(cockpit.controller->state(at_seconds(12.0))->time, at_seconds(10.25));
}

/// In the state `searching` nothing can be given back, and a notice says so: that tells what came
/// through to the companion.
TEST(CanFlightController, PassesOnThatItIsGivenBackOnceEachTime) {
  Cockpit cockpit;
  cockpit.controller->step(at_seconds(10.0));
  const auto refusals = [&cockpit] {
    cockpit.controller->step(at_seconds(11.0));
    int said = 0;
    while (const auto notice = cockpit.controller->poll_notice()) {
      if (notice->what.news == AutopilotNews::not_given_back) ++said;
    }
    return said;
  };
  EXPECT_EQ(refusals(), 0);
  cockpit.controller->give_back(at_seconds(10.0));
  EXPECT_EQ(refusals(), 1);
  EXPECT_EQ(refusals(), 0);
}

TEST(CanFlightController, ControlNeitherAllocatesNorLocks) {
  if (!counted_calls::available()) GTEST_SKIP() << "a sanitizer stands in for what is counted";
  Cockpit cockpit;
  cockpit.controller->step(at_seconds(10.0));
  counted_calls::reset();
  for (int i = 0; i < 1000; ++i) {
    const Instant now = at_seconds(10.0 + 0.02 * i);
    ASSERT_TRUE(cockpit.controller->state(now));
    cockpit.controller->command(Setpoint{.heading_rad = 0.1, .airspeed_mps = 50, .height_m = 1},
                                now);
    cockpit.controller->command(PositionSetpoint{}, now);
  }
  EXPECT_EQ(counted_calls::allocations(), 0);
  EXPECT_EQ(counted_calls::locks(), 0);
}

TEST(CanFlightController, ThreadsShareItWithoutRaces) {
  Cockpit cockpit;
  std::atomic<bool> stop{false};
  std::thread can{[&] {
    for (int i = 0; !stop; ++i) cockpit.controller->step(at_seconds(10.0 + 0.001 * i));
  }};
  std::thread control{[&] {
    for (int i = 0; !stop; ++i) {
      (void)cockpit.controller->state(at_seconds(10.0 + 0.001 * i));
      cockpit.controller->command(Setpoint{}, at_seconds(10.0 + 0.001 * i));
    }
  }};
  // The agent's thread: until the CAN thread has noticed that nothing more comes.
  bool found = false;
  while (!found) {
    cockpit.controller->give_back(at_seconds(9.0));
    while (const auto notice = cockpit.controller->poll_notice()) {
      found = found || notice->what.news == AutopilotNews::found;
    }
    std::this_thread::yield();
  }
  stop = true;
  can.join();
  control.join();
  EXPECT_TRUE(found);
}

}  // namespace
}  // namespace skein::onboard
