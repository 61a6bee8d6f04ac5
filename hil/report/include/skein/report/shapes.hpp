// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "skein/base/attitude.hpp"

namespace skein::report {

/// One shape of a sheet. Places: metres, x along the track, y to its left, in the order in which
/// they are filled.
struct ShapePanel {
  std::string title;
  std::vector<Vec3> places;
  std::size_t first = 5;  ///< that are drawn full; those after them as rings
};

/// The shapes beside each other as an SVG file for light and dark pages: seen from above, the track
/// upwards, each to its own scale, which a bar of one spacing shows. Places are numbered.
[[nodiscard]] std::string shapes_svg(const std::vector<ShapePanel>& panels, double spacing_m,
                                     std::size_t columns);

}  // namespace skein::report
