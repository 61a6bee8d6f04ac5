// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "skein/base/result.hpp"
#include "skein/base/stations.hpp"
#include "skein/base/time.hpp"
#include "skein/configuration/ground_config.hpp"

namespace skein::hil {

/// "vehicle 3", "the ground station", "ground station 2"
[[nodiscard]] std::string name_of(VehicleId node);
/// Of its log, its configuration and, of ground stations, what it records: "vehicle-3", "ground",
/// "ground-2".
[[nodiscard]] std::string log_name(VehicleId node);

/// A second ground station of a run, which watches the first and takes the command when it is told.
class SecondStation {
 public:
  static constexpr VehicleId kNode = station_node(2);

  /// The first becomes one of two; this is what the second runs with. With `keys` of the run it was
  /// enrolled, and is given the operator's.
  [[nodiscard]] static Result<configuration::GroundConfig> join(
      configuration::GroundConfig& first, const std::filesystem::path& run_folder, bool sealed);

  SecondStation(std::string control_socket, std::optional<Instant> takes_command_at)
      : control_socket_{std::move(control_socket)}, next_{takes_command_at} {}
  /// Has it take the command when it is time; what came of it.
  [[nodiscard]] std::optional<std::string> play(Instant now);

 private:
  std::string control_socket_;
  std::optional<Instant> next_;  ///< when it is told; none: not (any more)
};

}  // namespace skein::hil
