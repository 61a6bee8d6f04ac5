// SPDX-License-Identifier: Apache-2.0
#include "skein/onboard/make_agent.hpp"

#include "skein/mission/formation_agent.hpp"
#include "skein/mission/vehicle_agent.hpp"

namespace skein::onboard {
namespace {

std::unique_ptr<mission::OnboardAgent> formation_agent(const configuration::VehicleConfig& config,
                                                       InstanceId instance, Instant now) {
  mission::FormationAgentConfig agent;
  agent.vehicle = config.vehicle.id;
  agent.instance = instance;
  agent.limits = config.formation.limits;
  agent.avoidance = config.formation.avoidance;
  agent.passage.tolerance_m = config.formation.tracking_m;
  return std::make_unique<mission::FormationAgent>(agent, now);
}

}  // namespace

std::unique_ptr<mission::OnboardAgent> make_agent(const configuration::VehicleConfig& config,
                                                  const std::optional<TimedPath>& route,
                                                  InstanceId instance, Instant now) {
  if (config.flight_controller.is_multirotor()) return formation_agent(config, instance, now);
  mission::VehicleAgentConfig agent;
  agent.vehicle = config.vehicle;
  agent.instance = instance;
  agent.protocol = config.protocol;
  agent.planning = config.planning;
  agent.search = config.search;
  agent.route = route;
  agent.hazards = config.hazards;
  return std::make_unique<mission::VehicleAgent>(agent, now);
}

}  // namespace skein::onboard
