// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/attitude.hpp"
#include "skein/base/result.hpp"

namespace skein::configuration {

/// A free shape, as formation::ShapeSpec takes it (docs/formation.md): offsets of the places, along
/// track (forward), across it (to the left) and up, metres, in the order of the outline.
struct ShapeFile {
  std::string title;
  std::string notes;
  bool closed = true;  ///< the outline leads back from its last point
  std::vector<Vec3> points;
};

/// Fails with one line for every mistake in the file: "file:line: key: what is wrong; what to do".
[[nodiscard]] Result<ShapeFile> load_shape(const std::filesystem::path& file);
/// As above, from text; `name` stands for the file in messages.
[[nodiscard]] Result<ShapeFile> parse_shape(std::string_view yaml, const std::string& name);
/// What load_shape reads back as the same struct.
[[nodiscard]] std::string to_yaml(const ShapeFile& shape);

}  // namespace skein::configuration
