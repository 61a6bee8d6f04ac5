// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "skein/base/frames.hpp"
#include "skein/recording/recording.hpp"

namespace skein::recording_export {

/// What is exported: by whose it is, each in the order of time.
struct Flights {
  std::map<VehicleId, recording::Recording> by_node;
  std::optional<MissionOrigin> origin;  ///< none where no process's configuration has one
  std::size_t damaged = 0;              ///< parts that could not be read
  bool complete = true;                 ///< closed by its processes
};
[[nodiscard]] Result<Flights> read_flights(const std::filesystem::path& recording);

/// Both fail with the reason where the origin is not known.
[[nodiscard]] Result<std::string> geojson(const Flights& flights);
[[nodiscard]] Result<std::string> kml(const Flights& flights);

}  // namespace skein::recording_export
