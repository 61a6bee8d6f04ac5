// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "skein/configuration/vehicle_config.hpp"

namespace skein::onboard {

/// How the process is seen from its host.
struct HostOptions {
  std::string status_socket;  ///< path; empty: none
  Duration clock_ahead{};     ///< as if this machine's clock was so far ahead, for a bench
};

/// Flies one vehicle until SIGINT or SIGTERM: puts the parts together, starts the threads of
/// threads.hpp, and stops them again. Call it once, from a process without other threads. Gives the
/// exit code: 0, or process::kExitCannotStart with the reason in the log.
[[nodiscard]] int fly(const configuration::VehicleConfig& config, const HostOptions& host = {});

}  // namespace skein::onboard
