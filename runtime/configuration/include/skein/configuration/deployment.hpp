// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "skein/configuration/ground_config.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/configuration/vehicle_config.hpp"

namespace skein::configuration {

/// How one run of a scenario is spread over processes. Node i (the ground station is node 0, the
/// vehicles follow in the order of the file) has port port_base + 2 i, on the air port_base, of
/// this machine's `address`, unless it is one of `elsewhere`.
struct Deployment {
  std::string address = "127.0.0.1";
  std::uint16_t port_base = 17400;
  std::uint16_t domain_id = 0;
  bool dds = false;  ///< everybody speaks to each by itself, with Fast DDS; else by the air
  std::string transport_plugin;
  std::map<VehicleId, std::string> keys;  ///< folders; who has none speaks in clear
  bool isolated = true;                   ///< NetworkConfig's, of all
  OperatorConfig op;                      ///< of the ground station
  TimeConfig time;
  std::uint16_t console_port = 0;  ///< of the ground station's page; 0: it has none
  std::string recording_folder;    ///< each process gets its own in it; empty: no recordings
  /// For the vehicles whose flight controller is on a CAN bus that the scenario does not name: one
  /// for each, or one for all. They get node ids of their own on it, and are taken over in flight.
  std::vector<std::string> can_buses;
  std::map<VehicleId, std::string> elsewhere;  ///< addresses
};

/// The configuration of every vehicle process. Vehicles know
/// the hazards whose known_from is the epoch; the later ones must be reported to them. Each
/// vehicle's seed is drawn from the scenario's. Preconditions: the ports fit in 16 bits, and there
/// is one CAN bus, or as many as are needed.
[[nodiscard]] std::vector<VehicleConfig> vehicle_configs(const Scenario& scenario,
                                                         const Deployment& deployment);
[[nodiscard]] GroundConfig ground_config(const Scenario& scenario, const Deployment& deployment);

}  // namespace skein::configuration
