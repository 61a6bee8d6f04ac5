// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "skein/base/time.hpp"
#include "skein/console/server.hpp"
#include "skein/mission/fleet.hpp"
#include "skein/process/host.hpp"

namespace skein::groundstation {

/// What the ground station knows of itself and of the fleet, for machines that watch it.
struct HealthFacts {
  std::string version;
  Instant now{};
  std::uint64_t sent = 0;
  std::uint64_t received = 0;
  std::uint64_t dropped = 0;
  std::uint64_t of_strangers = 0;  ///< datagrams
  std::uint64_t unproven = 0;      ///< decisions
  std::uint64_t restarts = 0;      ///< of the process that carries the network
  std::uint64_t refused = 0;       ///< messages that were not their sender's to say
  std::size_t authorisations_waiting = 0;
  std::size_t recordings = 0;                    ///< that run
  bool shall_record = false;                     ///< by the configuration
  std::optional<std::uint64_t> disk_free_bytes;  ///< where it records
  std::optional<process::ClockState> clock;
  /// Whether other machines are in the team: else it does not matter what time it is here.
  bool among_machines = true;
};

/// /health and /metrics (docs/packages.md). Healthy is a ground station that can do its part; how
/// the vehicles are, the metrics say.
[[nodiscard]] console::Server::MachineReport machine_report(const HealthFacts& facts,
                                                            const mission::Fleet& fleet);

}  // namespace skein::groundstation
