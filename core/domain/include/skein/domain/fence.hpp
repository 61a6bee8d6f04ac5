// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/geometry.hpp"
#include "skein/domain/path.hpp"

namespace skein {

/// Where vehicles may be: inside a polygon without crossings, and below a height. Mission frame, m.
struct Fence {
  static constexpr std::size_t kCornersMax = 32;

  std::vector<Vec2> corners;    ///< in either sense; none: there is no fence
  double height_max_m = 120.0;  ///< above the mission's origin

  [[nodiscard]] bool exists() const { return !corners.empty(); }
  /// How far a point is from the nearest edge; negative outside. Precondition: exists().
  [[nodiscard]] double inside_m(const Vec2& point) const;
  /// Is no point of the path outside? To kFenceStep_m. True where there is no fence.
  [[nodiscard]] bool holds(const Path& path) const;

  bool operator==(const Fence&) const = default;
};

/// What two fences that are not the same differ in, to a millimetre: of its corners in their order
/// and its height. 0: there is none.
[[nodiscard]] std::uint32_t digest_of(const Fence& fence);

/// Why it is none, for people: too few or too many corners, edges that cross, no height. None where
/// it is one.
[[nodiscard]] std::optional<std::string> why_no_fence(const Fence& fence);

/// Do no two edges of the polygon meet but at their common corner? Precondition: three corners.
[[nodiscard]] bool is_simple_polygon(const std::vector<Vec2>& corners);

}  // namespace skein
