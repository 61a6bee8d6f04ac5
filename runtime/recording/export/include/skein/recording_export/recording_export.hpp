// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "skein/base/result.hpp"

namespace skein::recording_export {

enum class Format : std::uint8_t { csv, geojson, kml };

struct Written {
  std::vector<std::string> files;
  std::size_t damaged = 0;  ///< parts of the recording that could not be read and are left out
  bool complete = true;     ///< its processes closed it; otherwise the last second may be missing
};

/// Writes the tracks, events, plans and places of a recording (a file, a node's folder, or that of
/// a run) into files in `folder`, which is made:
///   csv      a folder a node with track.csv, events.csv, plans.csv, places.csv; numbers are exact
///   geojson  flight.geojson: tracks as lines, events as points where their vehicle was (RFC 7946:
///            heights above the ellipsoid)
///   kml      flight.kml: the same, heights above the mission's origin
/// Fails where there is nothing to be read, or a file cannot be written.
[[nodiscard]] Result<Written> write(const std::filesystem::path& recording, Format format,
                                    const std::filesystem::path& folder);

/// What is in a recording: whose, from when to when, how many records of each topic, what is
/// damaged. Reads all of it.
[[nodiscard]] Result<std::string> summary(const std::filesystem::path& recording);

}  // namespace skein::recording_export
