// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "skein/base/result.hpp"
#include "skein/formation/track.hpp"

namespace skein::configuration {

/// A track that a formation of planes flies along (docs/formation.md).
struct TrackFile {
  std::string title;
  std::string notes;
  formation::Track track{.closed = true, .turn_radius_m = 300.0};
};

/// Fails with one line for every mistake in the file: "file:line: key: what is wrong; what to do".
[[nodiscard]] Result<TrackFile> load_track(const std::filesystem::path& file);
/// As above, from text; `name` stands for the file in messages.
[[nodiscard]] Result<TrackFile> parse_track(std::string_view yaml, const std::string& name);
/// What load_track reads back as the same struct.
[[nodiscard]] std::string to_yaml(const TrackFile& track);

}  // namespace skein::configuration
