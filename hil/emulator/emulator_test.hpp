// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/base/attitude.hpp"
#include "skein/dronecan/node.hpp"
#include "skein/dronecan/tunnel.hpp"
#include "skein/hil/emulated_flight_controller.hpp"
#include "skein/mavlink/enums.hpp"
#include "skein/mavlink/parser.hpp"

namespace skein::hil {

/// A plane in flight over the origin, to the north, without wind or noise.
[[nodiscard]] inline EmulatorConfig in_flight() {
  EmulatorConfig config;
  config.origin = {31.5, 105.0, 480.0};
  config.start = {0.0, 0.0, kPi / 2.0};
  config.height_m = 300.0;
  config.airborne = true;
  config.noise = false;
  return config;
}

/// A companion on the same bus, in virtual time: what it sends are bytes, and bytes are what it
/// knows of the flight controller.
class Companion {
 public:
  static constexpr Duration kTick = std::chrono::milliseconds{5};

  explicit Companion(const EmulatorConfig& config, std::uint8_t own_node = 42)
      : controller_{EmulatedFlightController::make(config, Instant{}).value()},
        node_{node_params(own_node), Instant{}},
        port_{port_params(config), Instant{}},
        encoder_{config.companion_system, mavlink::kComponentOnboardComputer} {}

  /// For that long, with a heartbeat each second unless `heartbeats` is off.
  void run(double seconds) {
    const Instant end = now_ + from_seconds(seconds);
    while (now_ < end) tick();
  }
  /// Until the condition holds; false after `seconds`.
  template <class Condition>
  bool run_until(const Condition& condition, double seconds) {
    const Instant end = now_ + from_seconds(seconds);
    while (!condition()) {
      if (now_ >= end) return false;
      tick();
    }
    return true;
  }

  template <class Message>
  void send(const Message& message) {
    ASSERT_TRUE(port_.write(encoder_.encode(message)));
  }
  /// The answer, or nothing within two seconds.
  std::optional<mavlink::CommandResult> command(mavlink::CommandInt command) {
    command.target_system = 1;
    command.target_component = mavlink::kComponentAutopilot;
    return answer_to(command);
  }
  std::optional<mavlink::CommandResult> command(mavlink::CommandLong command) {
    command.target_system = 1;
    command.target_component = mavlink::kComponentAutopilot;
    return answer_to(command);
  }
  std::optional<mavlink::CommandResult> command(mavlink::Command number, float p1 = 0.0F,
                                                float p2 = 0.0F, float p3 = 0.0F) {
    mavlink::CommandLong c;
    c.command = static_cast<std::uint16_t>(number);
    c.param1 = p1;
    c.param2 = p2;
    c.param3 = p3;
    return command(c);
  }
  std::optional<mavlink::CommandResult> mode(std::uint32_t number) {
    return command(mavlink::Command::do_set_mode, 1.0F, static_cast<float>(number));
  }
  std::optional<mavlink::CommandResult> stream(std::uint32_t id, double hertz) {
    return command(mavlink::Command::set_message_interval, static_cast<float>(id),
                   static_cast<float>(1e6 / hertz));
  }
  void hold_roll(double roll_rad, double pitch_rad, std::uint8_t mask) {
    const Eigen::Quaterniond q = attitude_from({.roll_rad = roll_rad, .pitch_rad = pitch_rad});
    mavlink::SetAttitudeTarget target;
    target.q = {static_cast<float>(q.w()), static_cast<float>(q.x()), static_cast<float>(q.y()),
                static_cast<float>(q.z())};
    target.type_mask = mask;
    send(target);
  }
  void interfere(const std::string& line) {
    const auto done = controller_.interfere(line, now_);
    EXPECT_TRUE(done.ok()) << done.error().message;
  }

  /// The newest of a kind, or nothing.
  template <class Message>
  [[nodiscard]] std::optional<Message> last() const {
    for (std::size_t i = packets_.size(); i > 0; --i) {
      if (const auto message = mavlink::decode<Message>(packets_[i - 1])) return message;
    }
    return std::nullopt;
  }
  template <class Message>
  [[nodiscard]] std::size_t count() const {
    return static_cast<std::size_t>(
        std::count_if(packets_.begin(), packets_.end(),
                      [](const mavlink::Packet& p) { return p.id == Message::kDefinition.id; }));
  }
  [[nodiscard]] bool said(const std::string& text) const {
    return std::any_of(packets_.begin(), packets_.end(), [&](const mavlink::Packet& p) {
      const auto line = mavlink::decode<mavlink::Statustext>(p);
      return line && mavlink::text_of(line->text).find(text) != std::string::npos;
    });
  }
  [[nodiscard]] std::uint32_t mode_now() const {
    return last<mavlink::Heartbeat>().value().custom_mode;
  }
  [[nodiscard]] bool armed() const {
    return (last<mavlink::Heartbeat>().value().base_mode & mavlink::mode_safety_armed) != 0;
  }
  void forget() { packets_.clear(); }

  [[nodiscard]] Instant now() const { return now_; }
  [[nodiscard]] double seconds() const { return to_seconds(now_); }
  [[nodiscard]] EmulatedFlightController& controller() { return controller_; }
  [[nodiscard]] dronecan::Node& node() { return node_; }
  [[nodiscard]] dronecan::TunnelPort& port() { return port_; }
  [[nodiscard]] const std::vector<mavlink::Packet>& packets() const { return packets_; }
  [[nodiscard]] const mavlink::ParserStatistics& parser() const { return parser_.statistics(); }
  [[nodiscard]] std::uint64_t frames() const { return frames_; }

  bool heartbeats = true;
  bool connected = true;  ///< off: the bus is cut

 private:
  static dronecan::NodeParams node_params(std::uint8_t own_node) {
    dronecan::NodeParams params;
    params.node_id = own_node;
    return params;
  }
  static dronecan::TunnelParams port_params(const EmulatorConfig& config) {
    dronecan::TunnelParams params;
    params.remote_node = config.node_id;
    params.serial_id = config.serial_id;
    return params;
  }

  template <class CommandMessage>
  std::optional<mavlink::CommandResult> answer_to(const CommandMessage& command) {
    std::optional<mavlink::CommandResult> result;
    const std::size_t before = packets_.size();
    send(command);
    (void)run_until(
        [&] {
          for (std::size_t i = before; i < packets_.size(); ++i) {
            const auto ack = mavlink::decode<mavlink::CommandAck>(packets_[i]);
            if (!ack || ack->command != command.command) continue;
            EXPECT_EQ(ack->target_component, mavlink::kComponentOnboardComputer);
            result = static_cast<mavlink::CommandResult>(ack->result);
          }
          return result.has_value();
        },
        2.0);
    return result;
  }

  void tick() {
    now_ += kTick;
    if (heartbeats && now_ >= heartbeat_at_) {
      heartbeat_at_ = now_ + std::chrono::seconds{1};
      mavlink::Heartbeat heartbeat;
      heartbeat.type = static_cast<std::uint8_t>(mavlink::VehicleType::onboard_controller);
      heartbeat.autopilot = static_cast<std::uint8_t>(mavlink::Autopilot::invalid);
      send(heartbeat);
    }
    port_.step(node_, now_);
    node_.step(now_);
    for (auto frames = node_.front(); !frames.empty(); frames = node_.front()) {
      for (const can::Frame& frame : frames) {
        if (connected) controller_.on_frame(frame, now_);
      }
      node_.pop();
    }
    controller_.step(now_);
    for (auto frames = controller_.front(); !frames.empty(); frames = controller_.front()) {
      for (const can::Frame& frame : frames) hear(frame);
      controller_.pop();
    }
  }
  void hear(const can::Frame& frame) {
    if (!connected) return;
    ++frames_;
    if (const dronecan::Transfer* const transfer = node_.on_frame(frame, 0, now_)) {
      port_.on_transfer(*transfer, node_.node_id(), now_);
    }
    std::array<std::uint8_t, 256> bytes{};
    while (const std::size_t size = port_.read(bytes)) {
      parser_.parse(std::span{bytes}.first(size),
                    [this](const mavlink::Packet& p) { packets_.push_back(p); });
    }
  }

  EmulatedFlightController controller_;
  dronecan::Node node_;
  dronecan::TunnelPort port_;
  mavlink::Encoder encoder_;
  mavlink::Parser parser_;
  std::vector<mavlink::Packet> packets_;
  std::uint64_t frames_ = 0;
  Instant now_;
  Instant heartbeat_at_;
};

}  // namespace skein::hil
