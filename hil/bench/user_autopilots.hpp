// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/configuration/vehicle_config.hpp"
#include "skein/hil/child_process.hpp"

namespace skein::hil {

/// A user's own ArduPilot, built for software in the loop, in place of skein-fc: flies an aircraft
/// of its own simulator, from power-up on the ground, on the multicast bus `kAutopilotBus`, which
/// is where its builds speak.
inline constexpr const char* kAutopilotBus = "mcast:0";

/// By airframe; none: skein-fc flies it.
struct UserAutopilots {
  std::optional<std::filesystem::path> plane;
  std::optional<std::filesystem::path> copter;
  std::vector<std::filesystem::path> parameters;  ///< files of its own, before those of the vehicle
  std::string plane_model = "plane";              ///< which of its simulator's planes: --model

  [[nodiscard]] const std::filesystem::path* of(const VehicleSpec& vehicle) const {
    const auto& program = vehicle.is_copter() ? copter : plane;
    return program ? &*program : nullptr;
  }
};
/// Which of the two a program is, its name says: "arduplane", "arducopter". A file plane.parm,
/// copter.parm or quadplane.parm beside it has the parameters of the simulated airframe.
[[nodiscard]] Result<UserAutopilots> user_autopilots(const std::vector<std::string>& programs,
                                                     const std::vector<std::string>& parameters,
                                                     const std::string& plane_model = {});

/// How fast a copter that flies places of a formation has to climb and sink to be where they are.
[[nodiscard]] double climb_needed_mps(const VehicleSpec& copter);

/// What the vehicle asks of an ArduPilot's parameters, a line each ("NAME VALUE"): the bus, the
/// serial port on it, what safety rests on, the speeds, the bank that its turn radius needs, the
/// wind of the simulator.
[[nodiscard]] std::string autopilot_parameters(const configuration::VehicleConfig& vehicle);

/// The command line that starts it in `folder`, which is made: on the ground, so that its take-off
/// ends where the vehicle starts. `instance` tells those of one machine apart; it says what it
/// really does where it is asked from `truth_port` of loopback.
[[nodiscard]] Result<std::vector<std::string>> autopilot_command(
    const UserAutopilots& autopilots, const configuration::VehicleConfig& vehicle, int instance,
    std::uint16_t truth_port, const std::filesystem::path& folder);

/// Nobody speaks on their bus.
[[nodiscard]] Result<void> autopilot_bus_is_free();
/// Waits until it has booted: its node speaks on the bus. `log` is named where it does not.
[[nodiscard]] Result<void> await_autopilot(const configuration::VehicleConfig& vehicle,
                                           ChildProcess& started, const std::filesystem::path& log);

/// Where copters on autopilots await their formation's orders.
inline constexpr double kHover_m = 5.0;
/// What a vehicle that begins on the ground takes until it is in the air at its height: a user's
/// autopilot from when the last of them has booted, an emulated one from its start.
[[nodiscard]] double take_off_lead_s(const VehicleSpec& vehicle, bool emulated);

}  // namespace skein::hil
