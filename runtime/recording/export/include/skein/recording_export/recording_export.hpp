// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "skein/base/result.hpp"

namespace skein::recording_export {

enum class Format : std::uint8_t { csv, geojson, kml };

/// Writes the tracks, events, plans and places of a recording (a file, a node's folder, or that of
/// a run) into files in `folder`, which is made:
///   csv      a folder a node with track.csv, events.csv, plans.csv, places.csv; numbers are exact
///   geojson  flight.geojson: tracks as lines, events as points where their vehicle was (RFC 7946:
///            heights above the ellipsoid)
///   kml      flight.kml: the same, heights above the mission's origin
/// Gives the files' names. Fails where there is nothing to be read, or a file cannot be written.
[[nodiscard]] Result<std::vector<std::string>> write(const std::filesystem::path& recording,
                                                     Format format,
                                                     const std::filesystem::path& folder);

/// What is in a recording: whose, from when to when, how many records of each topic, what is
/// damaged. Reads all of it.
[[nodiscard]] Result<std::string> summary(const std::filesystem::path& recording);

}  // namespace skein::recording_export
