// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "free_ports.hpp"
#include "skein/base/ids.hpp"
#include "skein/configuration/process_config.hpp"

namespace skein {

/// The mission network of a vehicle and its ground station on loopback.
class TwoNodes {
 public:
  explicit TwoNodes(VehicleId vehicle) : vehicle_{vehicle} {}

  /// As one of them is configured.
  [[nodiscard]] configuration::NetworkConfig network_of(VehicleId self) const {
    const bool ground = self == kGroundStation;
    configuration::NetworkConfig network;
    network.port = ground ? ground_port() : vehicle_port();
    network.peers.push_back({.id = ground ? vehicle_ : kGroundStation,
                             .port = ground ? vehicle_port() : ground_port()});
    return network;
  }
  [[nodiscard]] std::uint16_t vehicle_port() const { return ports_.front(); }
  [[nodiscard]] std::uint16_t ground_port() const { return ports_.back(); }

 private:
  VehicleId vehicle_;
  std::vector<std::uint16_t> ports_ = network::free_port_pairs(2);
};

}  // namespace skein
