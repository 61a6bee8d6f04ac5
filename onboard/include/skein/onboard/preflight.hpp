// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "skein/ardupilot/autopilot_facts.hpp"
#include "skein/can/interface.hpp"
#include "skein/configuration/vehicle_config.hpp"
#include "skein/mission/messages.hpp"

/// What is looked at before a flight (docs/ardupilot.md).
namespace skein::onboard {

using Verdict = mission::CheckVerdict;
using mission::CheckGroup;

/// One thing that was looked at.
struct Check {
  std::string what;
  Verdict verdict = Verdict::ok;
  std::string found;
  std::string remedy;  ///< empty where it is ok
  CheckGroup group = CheckGroup::configuration;
};
using Checks = std::vector<Check>;

/// "FAIL  node id: ...; set ...", a line each.
[[nodiscard]] std::string text_of(const Checks& checks);
/// {"good": ..., "checks": [{"group", "what", "verdict", "found", "remedy"}]}, without its end.
[[nodiscard]] std::string json_of(const Checks& checks);
/// None fails.
[[nodiscard]] bool is_good(const Checks& checks);

/// Of the clock: mission time at `now_unix_ns`.
[[nodiscard]] Check check_epoch(const configuration::TimeConfig& time, std::int64_t now_unix_ns);
/// This machine, its network, its keys, and who else runs on it. Writes nothing that stays.
[[nodiscard]] Checks check_host(const configuration::VehicleConfig& config,
                                std::int64_t now_unix_ns);
/// The same while this vehicle's process runs: that has its port, and is the other process.
[[nodiscard]] Checks check_host_of_running(const configuration::VehicleConfig& config,
                                           std::int64_t now_unix_ns);
[[nodiscard]] Checks check_interface(const can::InterfaceFacts& facts);
/// The bus and who is on it, then the autopilot; where it is not heard, what depends on it is
/// warned of. In flight what is about arming is left out. `unix_s_at_gnss`: this machine's clock
/// when the autopilot told the time of its GNSS.
[[nodiscard]] Checks check_autopilot(const configuration::VehicleConfig& config,
                                     const ardupilot::AutopilotFacts& facts,
                                     std::int64_t unix_s_at_gnss);
/// All of them, of a configuration that is good; takes some seconds.
[[nodiscard]] Checks check_before_flight(const configuration::VehicleConfig& config);

}  // namespace skein::onboard
