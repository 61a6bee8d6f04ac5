// SPDX-License-Identifier: Apache-2.0
#include "skein/process/mission_network.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <random>
#include <utility>

#include "skein/wording/wording.hpp"

namespace skein::process {

InstanceId new_instance() {
  std::random_device device;
  const std::uint64_t high = device();
  return {high << 32U | device()};
}

network::NodeConfig node_config(const configuration::NetworkConfig& config, VehicleId self,
                                InstanceId instance, std::function<void()> on_received) {
  network::NodeConfig node;
  node.domain = config.domain_id;
  node.self = self;
  node.instance = instance;
  node.role = self == kGroundStation ? codec::Role::ground : codec::Role::vehicle;
  node.endpoint = {config.address, config.port};
  for (const auto& peer : config.peers) node.peers.push_back({peer.id, {peer.address, peer.port}});
  node.transport_plugin = config.transport_plugin;
  node.on_received = std::move(on_received);
  return node;
}

bool among_machines(const configuration::NetworkConfig& config) {
  return std::ranges::any_of(config.peers, [&config](const configuration::NetworkPeer& peer) {
    return peer.address != config.address;
  });
}

void log_misfits(network::Node& node) {
  for (const network::Misfit& misfit : node.take_misfits()) {
    spdlog::warn("{}: {}; its messages of that type are dropped until one of the two is updated",
                 wording::text_of(misfit.sender), misfit.text);
  }
}

Traffic traffic_of(const network::Node& node) {
  Traffic traffic;
  for (const auto& [name, count] : node.counters()) {
    if (name == "published") {
      traffic.sent += count;
    } else if (name == "received") {
      traffic.received += count;
    } else {
      traffic.dropped += count;
    }
  }
  return traffic;
}

}  // namespace skein::process
