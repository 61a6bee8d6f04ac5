// SPDX-License-Identifier: Apache-2.0
#include "skein/process/mission_network.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>
#include <random>
#include <system_error>
#include <utility>

#include "skein/identity_desk/given.hpp"
#include "skein/wording/wording.hpp"

namespace skein::process {

namespace {

InstanceId random_instance() {
  std::random_device device;
  const std::uint64_t high = device();
  return {high << 32U | device()};
}

bool is_loopback(const std::string& address) { return address.starts_with("127."); }

/// What is said to a multicast group goes out where `address` is; to a broadcast address, where
/// that is.
bool is_multicast(const std::string& address) {
  in_addr parsed{};
  return inet_pton(AF_INET, address.c_str(), &parsed) == 1 && IN_MULTICAST(ntohl(parsed.s_addr));
}

bool is_this_machine_alone(const configuration::NetworkConfig& config) {
  const std::string& group = config.air.group;
  return is_loopback(config.address) &&
         (!config.peers.empty() || is_multicast(group) || is_loopback(group)) &&
         std::ranges::all_of(config.peers, [](const configuration::NetworkPeer& peer) {
           return is_loopback(peer.address);
         });
}

/// By its keys; none where it needs none.
Result<std::optional<identity::Identity>> identity_of(const configuration::NetworkConfig& config,
                                                      VehicleId self) {
  if (config.keys.empty()) {
    if (is_this_machine_alone(config)) return std::optional<identity::Identity>{};
    return Error{
        "network.keys is not given, and other machines are in the network: whoever reaches it "
        "could fly the team; enrol the nodes (docs/keys.md)"};
  }
  auto known =
      identity::Identity::open(identity::KeyFolder::of(config.keys), identity_desk::now_unix_s());
  if (!known) return known.error();
  if (known->own().node != self) {
    return Error{config.keys + ": has the keys of " + wording::text_of(known->own().node) +
                 ", and this is " + wording::text_of(self) + "; give it a folder of its own"};
  }
  return std::optional{std::move(known).value()};
}

}  // namespace

Result<void> check_start(const configuration::NetworkConfig& config, VehicleId self) {
  const auto identity = identity_of(config, self);
  if (!identity) return identity.error();
  return {};
}

void log_unused_keys(const configuration::NetworkConfig& config, const std::string& own_folder) {
  if (!config.keys.empty() || own_folder.empty()) return;
  const std::string keys = own_folder + "/keys";
  std::error_code failed;
  if (!std::filesystem::exists(keys + "/node.key", failed)) return;
  spdlog::warn("there are keys in {}, and this node speaks in clear; 'network: {{keys: {}}}' seals",
               keys, keys);
}

Result<NodeStart> start_node(const configuration::NetworkConfig& config, VehicleId self) {
  auto identity = identity_of(config, self);
  if (!identity) return identity.error();
  NodeStart start;
  start.self = self;
  start.identity = std::move(identity).value();
  if (!start.identity) {
    start.instance = random_instance();
    return start;
  }
  const auto counted = identity::count_start(identity::KeyFolder::of(config.keys), self);
  if (!counted) return counted.error();
  start.instance = identity::instance_of(*counted);
  start.seal = network::SealConfig{*counted, start.identity->epoch_key()};
  return start;
}

std::string how_it_speaks(const NodeStart& start) {
  return start.seal ? "sealed, epoch " + std::to_string(start.seal->key.epoch)
                    : "in clear, on this machine alone";
}

network::NodeConfig node_config(const configuration::NetworkConfig& config, const NodeStart& start,
                                std::function<void()> on_received) {
  network::NodeConfig node;
  node.domain = config.domain_id;
  node.self = start.self;
  node.instance = start.instance;
  node.role = start.self == kGroundStation ? codec::Role::ground : codec::Role::vehicle;
  node.seal = start.seal;
  if (start.identity) {
    node.sign = network::SignConfig{start.identity->signer(), start.identity->own(),
                                    start.identity->verifier()};
  }
  node.endpoint = {config.address, config.port};
  for (const auto& peer : config.peers) node.peers.push_back({peer.id, {peer.address, peer.port}});
  if (config.peers.empty()) {
    node.air = network::AirConfig{{config.air.group, config.port}, std::nullopt};
    const double limit = config.air.limit_bytes_per_s;
    if (limit > 0.0) node.air->bytes_per_s = limit;
    node.air->hops_max = config.air.hops_max;
  }
  node.transport_plugin = config.transport_plugin;
  node.on_received = std::move(on_received);
  return node;
}

bool among_machines(const configuration::NetworkConfig& config) {
  return (config.peers.empty() && !is_this_machine_alone(config)) ||
         std::ranges::any_of(config.peers, [&config](const configuration::NetworkPeer& peer) {
           return peer.address != config.address;
         });
}

void log_troubles(network::Node& node) {
  for (const std::string& trouble : node.take_troubles()) spdlog::warn(trouble);
  for (const network::Misfit& misfit : node.take_misfits()) {
    spdlog::warn("{}: {}; its messages of that type are dropped until one of the two is updated",
                 wording::text_of(misfit.sender), misfit.text);
  }
}

void log_air(const network::Node& node) {
  const auto counts = node.counters();
  if (!counts.contains("air_lost")) return;
  spdlog::info(
      "the air: datagrams of others passed on {}; parts said again {}, lost for good {}; given way "
      "to newer {}",
      counts.at("air_passed_on"), counts.at("air_repairs"), counts.at("air_lost"),
      counts.at("air_gave_way"));
}

Traffic traffic_of(const network::Node& node) {
  Traffic traffic;
  for (const auto& [name, count] : node.counters()) {
    if (name == "published") {
      traffic.sent += count;
    } else if (name == "received" || name == "unheeded") {
      traffic.received += count;
    } else if (name == "carrier_restarts") {
      traffic.restarts += count;
    } else if (name == "publish_unconnected") {
      traffic.unconnected += count;
    } else if (name.starts_with("signature_")) {
      traffic.unproven += count;
    } else if (name == "key_news_forged") {
      traffic.of_strangers += count;
    } else if (name.starts_with("seal_")) {
      if (name != "seal_opened") traffic.of_strangers += count;
    } else if (!name.starts_with("air_")) {
      traffic.dropped += count;
    }
  }
  return traffic;
}

}  // namespace skein::process
