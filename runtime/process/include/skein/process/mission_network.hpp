// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "skein/base/ids.hpp"
#include "skein/configuration/process_config.hpp"
#include "skein/network/node.hpp"

namespace skein::process {

/// Made at random: two processes with one vehicle id differ in it.
[[nodiscard]] InstanceId new_instance();

/// The node that the configuration describes. The ground station is the node with its id (0).
/// `on_received` is called on a thread of the network; see network::NodeConfig.
[[nodiscard]] network::NodeConfig node_config(const configuration::NetworkConfig& config,
                                              VehicleId self, InstanceId instance,
                                              std::function<void()> on_received);

/// Are nodes of the team on other machines, by their addresses?
[[nodiscard]] bool among_machines(const configuration::NetworkConfig& config);

/// What a node counted, in three numbers.
struct Traffic {
  std::uint64_t sent = 0;
  std::uint64_t received = 0;
  std::uint64_t dropped = 0;  ///< for whatever reason, in both directions
};
[[nodiscard]] Traffic traffic_of(const network::Node& node);

/// Tells the log of nodes whose messages cannot be read for their version, each type once.
void log_misfits(network::Node& node);

}  // namespace skein::process
