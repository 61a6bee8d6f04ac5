// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <memory>
#include <random>
#include <utility>

#include "skein/configuration/process_config.hpp"
#include "skein/network/node.hpp"
#include "skein/process/mission_network.hpp"

namespace skein {

/// p so that p and p + 1 are free, below those that the kernel hands out by itself.
inline std::uint16_t free_port_pair() {
  const auto free = [](int port) {
    const int s = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const bool bound = ::bind(s, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    ::close(s);
    return bound;
  };
  std::random_device device;
  std::uniform_int_distribution<int> half{5000, 15999};
  while (true) {
    const int port = 2 * half(device);
    if (free(port) && free(port + 1)) return static_cast<std::uint16_t>(port);
  }
}

/// A ground station beside one vehicle, and what its operator says.
class OperatorDesk {
 public:
  using Epoch = std::chrono::system_clock::time_point;
  OperatorDesk(VehicleId vehicle, Epoch epoch) : vehicle_{vehicle}, epoch_{epoch} {}

  [[nodiscard]] configuration::NetworkConfig network_of(VehicleId self) const {
    const bool ground = self == kGroundStation;
    configuration::NetworkConfig network;
    network.port = ground ? ground_port_ : vehicle_port_;
    network.peers.push_back(
        {.id = ground ? vehicle_ : kGroundStation, .port = ground ? vehicle_port_ : ground_port_});
    return network;
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
  std::uint16_t vehicle_port_ = free_port_pair();
  std::uint16_t ground_port_ = free_port_pair();
  std::unique_ptr<network::Node> node_;
};

}  // namespace skein
