// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/configuration/vehicle_config.hpp"
#include "user_autopilots.hpp"

namespace skein::hil {

/// `count` multicast CAN buses on which nobody speaks: each is listened to for a moment, since all
/// programs of the machine share them. `seed`: where to begin to look.
[[nodiscard]] Result<std::vector<std::string>> quiet_buses(std::size_t count, std::uint64_t seed);

/// The command line of the skein-fc that flies this vehicle: in the air at its start, which it
/// leaves at mission time 0; what it really does it says to that port of loopback. Of the faults it
/// does those of its battery. Precondition: its flight controller is an ardupilot.
[[nodiscard]] std::vector<std::string> flight_controller_command(
    const std::filesystem::path& programs, const configuration::VehicleConfig& vehicle,
    std::optional<std::uint16_t> truth_port, const std::vector<configuration::Fault>& faults);

/// Fails where a battery is to fall that is not emulated.
[[nodiscard]] Result<void> batteries_can_fall(const configuration::Scenario& scenario,
                                              const UserAutopilots& autopilots);

}  // namespace skein::hil
