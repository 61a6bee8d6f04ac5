// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "skein/base/geometry.hpp"
#include "skein/domain/hazard.hpp"
#include "skein/domain/path.hpp"

namespace skein::planning {

/// A path that touches a circle is outside; so much may be lost to rounding.
inline constexpr double kTouch_m = 1e-7;

[[nodiscard]] bool piece_is_clear(const Pose2& from, const Segment& piece, const Hazard& circle);

/// The shortest chain of arcs and lines from pose to pose outside all circles: over the tangents
/// between the turning circles at both ends and the circles to be flown around, on either side and
/// in any order (Dijkstra's algorithm with the straight distance as a bound). Circles smaller than
/// the turn radius are passed on an arc of that radius which touches them.
/// Nothing where there is none, or where it would meet too many circles.
[[nodiscard]] std::optional<Path> shortest_by_tangents(const Pose2& from, const Pose2& to,
                                                       double radius_m,
                                                       std::span<const Hazard> circles);

}  // namespace skein::planning
