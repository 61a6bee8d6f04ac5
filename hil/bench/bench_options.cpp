// SPDX-License-Identifier: Apache-2.0
#include "bench_options.hpp"

#include <sys/socket.h>

#include <algorithm>
#include <string>

#include "flight_controllers.hpp"
#include "ports.hpp"
#include "skein/hil/radio/link_table.hpp"

namespace skein::hil {
namespace {

constexpr const char* kLoopback = "127.0.0.1";

Result<void> check_autopilots(const configuration::Scenario& scenario,
                              const ExternalHosts& external, const UserAutopilots& autopilots) {
  if (std::ranges::none_of(scenario.vehicles, [&](const auto& vehicle) {
        return user_flown(vehicle.spec, vehicle.flight_controller, external, autopilots);
      })) {
    return Error{
        "--autopilot: no vehicle of the scenario has a flight controller of that kind; give one "
        "flight_controller: {kind: ardupilot}"};
  }
  return autopilot_bus_is_free();
}

}  // namespace

bool user_flown(const VehicleSpec& spec, const configuration::FlightControllerConfig& controller,
                const ExternalHosts& external, const UserAutopilots& autopilots) {
  return controller.kind == configuration::FlightControllerKind::ardupilot &&
         autopilots.of(spec) != nullptr && external.host_of(spec.id) == nullptr;
}

std::vector<Fault> all_faults(const configuration::Scenario& scenario,
                              const BenchOptions& options) {
  std::vector<Fault> faults = faults_of(scenario);
  faults.insert(faults.end(), options.faults.begin(), options.faults.end());
  return faults;
}

Result<void> check_options(const configuration::Scenario& scenario, const BenchOptions& options,
                           const ExternalHosts& external, const UserAutopilots& autopilots) {
  if (!port_free(SOCK_DGRAM, options.address, 0)) {
    return Error{"no network interface of this machine has the address " + options.address +
                 "; give --address the one where the hosts reach it"};
  }
  if (options.console_port != 0 && !port_free(SOCK_STREAM, kLoopback, options.console_port)) {
    return Error{"port " + std::to_string(options.console_port) +
                 " of loopback is in use; name another for --console, or stop who uses it "
                 "(ss -tlpn shows who)"};
  }
  if (!options.autopilots.empty()) {
    if (auto possible = check_autopilots(scenario, external, autopilots); !possible) {
      return possible;
    }
  }
  for (const auto& vehicle : scenario.vehicles) {
    const std::string id = std::to_string(vehicle.spec.id.value);
    if (vehicle.spec.id.value >= radio::LinkTable::kNodes) {
      return Error{"vehicle " + id + " is beyond the bench's radio, which has ids 1 to " +
                   std::to_string(radio::LinkTable::kNodes - 1) + "; give it a smaller one"};
    }
    const bool has_controller =
        vehicle.flight_controller.kind == configuration::FlightControllerKind::ardupilot;
    if (!options.faults.empty() && !has_controller) {
      return Error{"faults are drawn for aircraft that outlive their programs; give vehicle " + id +
                   ", or all, flight_controller: {kind: ardupilot}"};
    }
  }
  return batteries_can_fall(scenario, autopilots);
}

}  // namespace skein::hil
