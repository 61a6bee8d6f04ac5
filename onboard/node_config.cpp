// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/node_config.hpp"

#include <utility>

#include "skein/codec/codec.hpp"
#include "skein/configuration/setup_params.hpp"

namespace skein::onboard {
namespace {

mission::FormationAgentConfig formation_agent(const configuration::VehicleConfig& config,
                                              InstanceId instance) {
  mission::FormationAgentConfig agent;
  agent.vehicle = config.vehicle.id;
  agent.instance = instance;
  agent.range_m = config.vehicle.range_m;
  agent.battery_reserve_percent = config.vehicle.battery_reserve_percent;
  agent.limits = config.formation.limits;
  agent.avoidance = config.formation.avoidance;
  agent.passage.tolerance_m = config.formation.tracking_m;
  agent.passage.silent_after = formation::silent_after(config.protocol.message_delay);
  return agent;
}

mission::TrackAgentConfig track_agent(const configuration::VehicleConfig& config,
                                      InstanceId instance) {
  mission::TrackAgentConfig agent;
  agent.vehicle = config.vehicle;
  agent.instance = instance;
  agent.hazards = config.hazards;
  agent.fence = config.fence;
  agent.place_tolerance_m = config.formation.place_tolerance_m;
  return agent;
}

bool is_on_ardupilot(const configuration::VehicleConfig& config) {
  return config.flight_controller.kind == configuration::FlightControllerKind::ardupilot;
}

/// A plane comes down to real ground only where somebody has said that it is free.
bool lands_by_itself(const configuration::VehicleConfig& config) {
  const LandingSpec& landing = config.vehicle.landing;
  const bool is_told_where = landing.x_m && landing.y_m && landing.heading_rad;
  return !is_on_ardupilot(config) || config.vehicle.is_copter() ||
         (is_told_where && config.vehicle.recovery == Recovery::home);
}

mission::VehicleAgentConfig vehicle_agent(const configuration::VehicleConfig& config,
                                          const std::optional<TimedPath>& route,
                                          InstanceId instance) {
  mission::VehicleAgentConfig agent;
  agent.vehicle = config.vehicle;
  agent.instance = instance;
  agent.protocol = config.protocol;
  agent.traffic = config.traffic;
  agent.planning = config.planning;
  agent.search = config.search;
  agent.route = route;
  agent.hazards = config.hazards;
  agent.fence = config.fence;
  agent.turn_lead_s = config.flight_controller.follower().turn_lead_s;
  // In still air a simulated plane is where its plan has it at once, and needs no lead.
  agent.heeds_wind = is_on_ardupilot(config) || config.flight_controller.wind.speed_mps > 0.0;
  agent.lands_by_itself = lands_by_itself(config);
  return agent;
}

}  // namespace

mission::VehicleNodeConfig node_config(const configuration::VehicleConfig& config,
                                       const std::optional<TimedPath>& route, InstanceId instance,
                                       std::string program) {
  mission::VehicleNodeConfig node;
  if (configuration::flies_formation(config.vehicle)) {
    node.agent = formation_agent(config, instance);
  } else if (config.formation.planes) {
    node.agent = track_agent(config, instance);
  } else {
    node.agent = vehicle_agent(config, route, instance);
  }
  node.fence = config.fence;
  node.traffic = config.traffic;
  node.setup = configuration::setup_params(
      config, {program.substr(program.rfind(' ') + 1), codec::wire_versions()});
  node.program = std::move(program);
  node.flight_controller = is_on_ardupilot(config) ? "ardupilot" : "simulated";
  return node;
}

}  // namespace skein::onboard
