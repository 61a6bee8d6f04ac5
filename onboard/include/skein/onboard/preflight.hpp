// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "skein/ardupilot/survey.hpp"
#include "skein/can/interface.hpp"
#include "skein/configuration/vehicle_config.hpp"

/// What is looked at before a flight (docs/ardupilot.md).
namespace skein::onboard {

enum class Verdict : std::uint8_t { ok, warn, fail };

/// One thing that was looked at.
struct Check {
  std::string what;
  Verdict verdict = Verdict::ok;
  std::string found;
  std::string remedy;  ///< empty where it is ok
};
using Checks = std::vector<Check>;

/// "FAIL  node id: ...; set ...", a line each.
[[nodiscard]] std::string text_of(const Checks& checks);
/// {"good": ..., "checks": [{"what", "verdict", "found", "remedy"}]}, without its end.
[[nodiscard]] std::string json_of(const Checks& checks);
/// None fails.
[[nodiscard]] bool is_good(const Checks& checks);

/// Of the clock: mission time at `now_unix_ns`.
[[nodiscard]] Check check_epoch(const configuration::TimeConfig& time, std::int64_t now_unix_ns);
/// This machine, its network, its keys, and who else runs on it. Writes nothing that stays.
[[nodiscard]] Checks check_host(const configuration::VehicleConfig& config,
                                std::int64_t now_unix_ns);
[[nodiscard]] Checks check_interface(const can::InterfaceFacts& facts);
/// The bus and who is on it, then the autopilot; where it is not heard, what depends on it is
/// warned of. `unix_s_at_gnss`: this machine's clock when the autopilot told the time of its GNSS.
[[nodiscard]] Checks check_autopilot(const configuration::VehicleConfig& config,
                                     const ardupilot::AutopilotFacts& facts,
                                     std::int64_t unix_s_at_gnss);
/// All of them, of a configuration that is good; takes some seconds.
[[nodiscard]] Checks check_before_flight(const configuration::VehicleConfig& config);

}  // namespace skein::onboard
