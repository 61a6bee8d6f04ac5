// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <utility>

#include "skein/configuration/process_config.hpp"
#include "skein/network/node.hpp"
#include "skein/process/mission_network.hpp"
#include "two_nodes.hpp"

namespace skein {

/// A ground station beside one vehicle, and what its operator says.
class OperatorDesk {
 public:
  using Epoch = std::chrono::system_clock::time_point;
  OperatorDesk(VehicleId vehicle, Epoch epoch)
      : vehicle_{vehicle}, epoch_{epoch}, nodes_{vehicle} {}

  [[nodiscard]] configuration::NetworkConfig network_of(VehicleId self) const {
    return nodes_.network_of(self);
  }
  void open() {
    const auto start = process::start_node(network_of(kGroundStation), kGroundStation);
    ASSERT_TRUE(start.ok()) << start.error().message;
    auto opened =
        network::Node::open(process::node_config(network_of(kGroundStation), *start, [] {}));
    ASSERT_TRUE(opened.ok()) << opened.error().message;
    node_ = std::move(opened).value();
  }
  void hear() {
    while (node_ && node_->poll()) continue;
  }
  /// Answers what was said at that mission time, by a clock that may be a little behind the
  /// vehicle's.
  void give_back(double answers_s) {
    const double now_s =
        std::chrono::duration<double>(std::chrono::system_clock::now() - epoch_).count();
    mission::Command command;
    command.vehicle = vehicle_;
    const double issued_s = std::max(now_s, answers_s + 1e-3);
    command.number = static_cast<std::uint32_t>(1e3 * issued_s) + 1;  // tells when it was issued
    command.kind = mission::CommandKind::give_back;
    node_->publish(mission::Message{command});
  }

 private:
  VehicleId vehicle_;
  Epoch epoch_;
  TwoNodes nodes_;
  std::unique_ptr<network::Node> node_;
};

}  // namespace skein
