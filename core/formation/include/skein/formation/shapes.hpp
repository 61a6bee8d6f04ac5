// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "skein/base/attitude.hpp"
#include "skein/base/result.hpp"

namespace skein::formation {

/// The shapes of Zheng (2020), and any other as a list of points. How each grows with the number of
/// vehicles: docs/formation.md.
enum class ShapeKind : std::uint8_t { line_abreast, column, echelon, wedge, pentagon, free, count };
[[nodiscard]] std::string_view to_string(ShapeKind kind);

/// A shape as offsets (dx along track, forward; dy across it, to the left; dz up), metres.
struct ShapeSpec {
  ShapeKind kind = ShapeKind::wedge;
  double spacing_m = 5.0;      ///< no two places are nearer; in (0, 1000]
  double heading_rad = 0.0;    ///< of the track: from east, counter-clockwise
  Vec3 centre = Vec3::Zero();  ///< mean of the places, mission frame (east, north, up)
  /// Of a free shape, in the order of its outline; it is enlarged where its places would come
  /// nearer than spacing_m, and never made smaller. Other shapes: not read.
  std::vector<Vec3> points;
  bool closed = true;  ///< whether a free shape's outline leads back from its last point
};

inline constexpr std::size_t kPlacesMax = 1000;

/// `n` places (1 to kPlacesMax) in the mission frame, in the order in which they are to be filled:
/// the first is the leader's, and the others' distance from it grows row by row, ring by ring, or
/// along the outline to both sides. Two places are spacing_m apart at least (to rounding). Fails
/// where a number is out of range, and for a free shape that would have to reach over more than
/// 10 km. O(n), a free shape O(n^2).
[[nodiscard]] Result<std::vector<Vec3>> places(const ShapeSpec& shape, std::size_t n);

}  // namespace skein::formation
