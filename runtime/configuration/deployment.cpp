// SPDX-License-Identifier: Apache-2.0
#include "skein/configuration/deployment.hpp"

#include "skein/base/assert.hpp"
#include "skein/base/random.hpp"

namespace skein::configuration {
namespace {

/// The network of every node, the ground station first.
std::vector<NetworkPeer> nodes_of(const Scenario& scenario, const Deployment& deployment) {
  SKEIN_ASSERT(deployment.port_base + 2 * scenario.vehicles.size() + 1 <= 65535);
  std::vector<NetworkPeer> nodes;
  const auto add = [&](VehicleId id) {
    const auto port = static_cast<std::uint16_t>(deployment.port_base + 2 * nodes.size());
    const auto other = deployment.elsewhere.find(id);
    nodes.push_back(
        {id, other != deployment.elsewhere.end() ? other->second : deployment.address, port});
  };
  add(kGroundStation);
  for (const ScenarioVehicle& vehicle : scenario.vehicles) add(vehicle.spec.id);
  return nodes;
}

NetworkConfig network_of(std::size_t node, const std::vector<NetworkPeer>& nodes,
                         const AirConfig& air, const Deployment& deployment) {
  const auto keys = deployment.keys.find(nodes[node].id);
  NetworkConfig network;
  network.domain_id = deployment.domain_id;
  network.address = nodes[node].address;
  network.port = nodes[node].port;
  network.keys = keys == deployment.keys.end() ? "" : keys->second;
  network.transport_plugin = deployment.transport_plugin;
  network.isolated = deployment.isolated;
  network.air = air;
  if (!deployment.dds) {
    network.port = deployment.port_base;
    return network;
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (i != node) network.peers.push_back(nodes[i]);
  }
  return network;
}

/// As recording::folder_name, which this module must not know.
std::string vehicle_folder(VehicleId id) {
  return (id.value < 10 ? "vehicle-0" : "vehicle-") + std::to_string(id.value);
}

std::string folder_of(const Deployment& deployment, const std::string& name) {
  return deployment.recording_folder.empty() ? "" : deployment.recording_folder + "/" + name;
}

constexpr std::uint8_t kFirstNode = 10;
constexpr std::uint8_t kFirstCompanionNode = 70;

/// For the `index`th vehicle that needs a bus.
ArdupilotConfig on_bus(ArdupilotConfig ardupilot, const Deployment& deployment, std::size_t index) {
  const auto& buses = deployment.can_buses;
  SKEIN_ASSERT(buses.size() == 1 || index < buses.size());
  SKEIN_ASSERT(kFirstNode + index < kFirstCompanionNode);
  ardupilot.can = buses[buses.size() == 1 ? 0 : index];
  ardupilot.node_id = static_cast<std::uint8_t>(kFirstNode + index);
  ardupilot.companion_node_id = static_cast<std::uint8_t>(kFirstCompanionNode + index);
  ardupilot.take_over = TakeOverKind::in_flight;
  return ardupilot;
}

}  // namespace

std::vector<VehicleConfig> vehicle_configs(const Scenario& scenario, const Deployment& deployment) {
  const std::vector<NetworkPeer> nodes = nodes_of(scenario, deployment);
  Random seeds{scenario.seed};
  std::vector<VehicleConfig> configs;
  std::size_t on_buses = 0;
  for (const ScenarioVehicle& vehicle : scenario.vehicles) {
    VehicleConfig config;
    config.vehicle = vehicle.spec;
    config.origin = scenario.origin;
    config.start = vehicle.start;
    config.search = vehicle.search;
    config.route = vehicle.route;
    config.flight_controller = vehicle.flight_controller;
    config.flight_controller.wind = scenario.wind;
    ArdupilotConfig& ardupilot = config.flight_controller.ardupilot;
    if (config.flight_controller.kind == FlightControllerKind::ardupilot && ardupilot.can.empty()) {
      ardupilot = on_bus(ardupilot, deployment, on_buses++);
    }
    config.network = network_of(configs.size() + 1, nodes, scenario.air, deployment);
    config.protocol = scenario.protocol;
    config.planning = scenario.planning;
    config.traffic = scenario.traffic;
    config.remote_id = scenario.remote_id.of(vehicle.spec.id);
    config.hazards = hazards_known_at(scenario.hazards, Instant{});
    config.fence = scenario.fence;
    config.formation = scenario.formation;
    config.formation.script.clear();
    config.time = deployment.time;
    config.recording_folder = folder_of(deployment, vehicle_folder(vehicle.spec.id));
    config.seed = seeds.next() >> 2U;  // the file holds numbers up to 9e18
    configs.push_back(config);
  }
  return configs;
}

GroundConfig ground_config(const Scenario& scenario, const Deployment& deployment) {
  GroundConfig config;
  config.origin = scenario.origin;
  config.network = network_of(0, nodes_of(scenario, deployment), scenario.air, deployment);
  config.time = deployment.time;
  config.protocol = scenario.protocol;
  config.planning = scenario.planning;
  config.traffic = scenario.traffic;
  config.remote_id = scenario.remote_id;
  for (const ScenarioVehicle& vehicle : scenario.vehicles) {
    config.vehicles.push_back(vehicle.spec.id);
  }
  config.operator_decisions = scenario.operator_decisions;
  config.site_templates = scenario.site_templates;
  config.hazards = hazards_known_at(scenario.hazards, Instant{});
  config.fence = scenario.fence;
  config.console.videos = scenario.console.videos;
  config.console.port = deployment.console_port;
  config.agencies = scenario.agencies;
  config.op = deployment.op;
  config.formation = scenario.formation;
  for (const ScenarioVehicle& vehicle : scenario.vehicles) {
    if (!vehicle.spec.is_copter()) config.planes.push_back(vehicle.spec);
  }
  config.recording_folder = folder_of(deployment, "ground");
  return config;
}

}  // namespace skein::configuration
