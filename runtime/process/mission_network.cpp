// SPDX-License-Identifier: Apache-2.0
#include "skein/process/mission_network.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <limits>
#include <random>
#include <system_error>
#include <utility>

#include "skein/base/stations.hpp"
#include "skein/identity_desk/given.hpp"
#include "skein/wording/wording.hpp"

namespace skein::process {

namespace {

/// How often others may have started that were not heard.
constexpr std::uint32_t kStartsUnheard = 200;

InstanceId random_instance() {
  std::random_device device;
  const std::uint64_t high = device();
  return {high << 32U | device()};
}

/// In clear nobody counts a ground station's starts: by its clock, in steps of 256 ms since 2024,
/// and by chance where two start in one; 40 bits, as all carriers have them.
InstanceId instance_by_clock() {
  constexpr std::int64_t kYear2024_unix_ms = 1'704'067'200'000;
  const auto since_1970 = std::chrono::duration_cast<std::chrono::milliseconds>(
      std::chrono::system_clock::now().time_since_epoch());
  const std::int64_t steps =
      std::max<std::int64_t>(0, since_1970.count() - kYear2024_unix_ms) / 256;
  std::random_device device;
  return {(static_cast<std::uint64_t>(steps) & 0x7FFF'FFFFU) << 9U | (device() & 0x1FFU)};
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
  // The mission's own ground station has no certificate besides for the number that it listens as.
  const bool is_own_ear = is_station(self) && known->own().node == kGroundStation &&
                          known->own().role == identity::Role::ground;
  if (known->own().node != self && !is_own_ear) {
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
    start.instance = self == kGroundStation ? instance_by_clock() : random_instance();
    return start;
  }
  const auto counted = identity::count_start(identity::KeyFolder::of(config.keys), self);
  if (!counted) return counted.error();
  start.instance = identity::instance_of(*counted);
  start.seal = network::SealConfig{*counted, start.identity->epoch_key()};
  return start;
}

Result<Voice> start_voice(const configuration::NetworkConfig& config, const NodeStart& heard_as,
                          std::optional<InstanceId> newest) {
  Voice voice;
  if (!heard_as.seal) {
    voice.instance = instance_by_clock();
    if (newest && voice.instance <= *newest) voice.instance = {newest->value + 1};
    return voice;
  }
  const auto keys = identity::KeyFolder::of(config.keys);
  const auto starts = identity::starts_of(keys);
  if (!starts) return starts.error();
  // Who has heard no other does not know how often they have started.
  const auto beyond = std::max<std::uint32_t>(newest ? identity::start_number(*newest) + 1U : 0U,
                                              newest ? 0U : *starts + kStartsUnheard);
  const auto at_least = static_cast<std::uint16_t>(
      std::min<std::uint32_t>(beyond, std::numeric_limits<std::uint16_t>::max()));
  const auto counted = identity::count_start(keys, kGroundStation, at_least);
  if (!counted) return counted.error();
  voice.instance = identity::instance_of(*counted);
  voice.start = *counted;
  return voice;
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
  const bool is_ground = start.self == kGroundStation || is_station(start.self);
  node.role = is_ground ? codec::Role::ground : codec::Role::vehicle;
  node.overhears = is_station(start.self);
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
    } else if (!name.starts_with("air_") && name != "station_superseded") {
      traffic.dropped += count;
    }
  }
  return traffic;
}

}  // namespace skein::process
