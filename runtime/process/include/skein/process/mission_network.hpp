// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "skein/base/ids.hpp"
#include "skein/base/result.hpp"
#include "skein/configuration/process_config.hpp"
#include "skein/identity/identity.hpp"
#include "skein/network/node.hpp"

namespace skein::process {

/// Which start of which node this process is.
struct NodeStart {
  VehicleId self;       ///< 0: the ground station; is_station(): one of several, which listens
  InstanceId instance;  ///< two processes with one vehicle id differ in it
  /// Who it is by its keys; none on loopback without: there it is who it says, and speaks in clear.
  std::optional<identity::Identity> identity;
  std::optional<network::SealConfig> seal;
};
/// To be called once in a process: with keys it counts the start. Fails with what to do where the
/// keys are no good, or there are none and other machines are in the network.
[[nodiscard]] Result<NodeStart> start_node(const configuration::NetworkConfig& config,
                                           VehicleId self);

/// A start of the ground station by which one of several takes the command: newer than `newest`,
/// which it has heard of another. None was heard: newer than any is likely to have been.
struct Voice {
  InstanceId instance;
  std::optional<seal::SenderStart> start;  ///< with keys
};
[[nodiscard]] Result<Voice> start_voice(const configuration::NetworkConfig& config,
                                        const NodeStart& heard_as,
                                        std::optional<InstanceId> newest);

/// Would start_node() refuse here, now? Counts no start.
[[nodiscard]] Result<void> check_start(const configuration::NetworkConfig& config, VehicleId self);
/// Tells the log where a node speaks in clear, and has keys in its folder.
void log_unused_keys(const configuration::NetworkConfig& config, const std::string& own_folder);

/// "sealed, epoch 1" or "in clear, on this machine alone".
[[nodiscard]] std::string how_it_speaks(const NodeStart& start);

/// The node that the configuration describes. `on_received` is called on a thread of the network;
/// see network::NodeConfig.
[[nodiscard]] network::NodeConfig node_config(const configuration::NetworkConfig& config,
                                              const NodeStart& start,
                                              std::function<void()> on_received);

/// Are nodes of the team on other machines, by their addresses?
[[nodiscard]] bool among_machines(const configuration::NetworkConfig& config);

/// What a node counted, in a few numbers.
struct Traffic {
  std::uint64_t sent = 0;
  std::uint64_t received = 0;
  std::uint64_t dropped = 0;       ///< of the team's, for whatever reason, in both directions
  std::uint64_t of_strangers = 0;  ///< datagrams that nobody sealed with the team's key
  std::uint64_t unproven = 0;      ///< decisions without a good signature of who they name
  std::uint64_t restarts = 0;      ///< of the process that carries the network
  std::uint64_t unconnected = 0;   ///< not sent, while it was gone
};
[[nodiscard]] Traffic traffic_of(const network::Node& node);

/// Tells the log at the end what became of datagrams on the air, where the node speaks on one.
void log_air(const network::Node& node);

/// Tells the log of nodes whose messages cannot be read for their version, each type once, and of
/// the process that carries the network, where it was started again.
void log_troubles(network::Node& node);

}  // namespace skein::process
