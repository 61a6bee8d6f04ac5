// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "external_hosts.hpp"
#include "skein/base/result.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/hil/bench.hpp"
#include "user_autopilots.hpp"

namespace skein::hil {

/// One of the user's own autopilots flies it, on this machine.
[[nodiscard]] bool user_flown(const VehicleSpec& spec,
                              const configuration::FlightControllerConfig& controller,
                              const ExternalHosts& external, const UserAutopilots& autopilots);

/// Of the scenario, and those besides.
[[nodiscard]] std::vector<Fault> all_faults(const configuration::Scenario& scenario,
                                            const BenchOptions& options);

/// Whether such a run is possible here: what can be told before anything is started.
[[nodiscard]] Result<void> check_options(const configuration::Scenario& scenario,
                                         const BenchOptions& options, const ExternalHosts& external,
                                         const UserAutopilots& autopilots);

}  // namespace skein::hil
