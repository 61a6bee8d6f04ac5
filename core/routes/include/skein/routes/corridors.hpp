// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/base/geometry.hpp"

namespace skein::routes {

/// A circle that corridors lead around.
struct Disc {
  Vec2 centre{0.0, 0.0};
  double radius_m = 0.0;
};

/// Between which poses, and how tightly.
struct CorridorEnds {
  Vec2 start{0.0, 0.0};
  double start_heading_rad = 0.0;
  double start_cone_rad = kPi;  ///< pi: leaves in any direction
  Vec2 goal{0.0, 0.0};
  std::optional<double> goal_heading_rad{};  ///< none: arrives in any direction
  double turn_radius_m = 0.0;                ///< >= 0
  /// Turns at the ends only: around a smaller disc it turns as tightly as that.
  bool turns_at_ends_only = false;
};

/// An arc of a corridor.
struct Bend {
  Vec2 centre{0.0, 0.0};
  double radius_m = 0.0;
  double sense = 1.0;        ///< +1 turns left, -1 right
  double heading_rad = 0.0;  ///< where it begins
  double turn_rad = 0.0;     ///< > 0, by which it turns
};

/// A taut route: straight lines that touch circles, and arcs along them. Of all routes that pass
/// every disc on the same side it is the shortest.
struct Corridor {
  double length_m = 0.0;
  std::vector<Bend> bends{};
};

/// The shortest corridors between the ends, shortest first: every one passes the discs in another
/// way. Best first over bitangents; a disc smaller than the turn radius is passed on a circle of
/// that radius about its centre. No circle is used twice in one corridor. Discs that hold an end
/// are left out. With turn radius 0 and no goal heading the first is the shortest way of all,
/// whatever turns. At most `count`, none longer than `length_max_m`. Empty where there is none.
[[nodiscard]] std::vector<Corridor> shortest_corridors(
    const CorridorEnds& ends, std::span<const Disc> discs, std::size_t count,
    double length_max_m = std::numeric_limits<double>::infinity());

/// The corridor as waypoints between its ends: bends become corners of at most `corner_max_rad`
/// around their circles, so fly-by arcs of at most their radius stay outside of them.
[[nodiscard]] std::vector<Vec2> corners_of(const Corridor& corridor, double corner_max_rad);

}  // namespace skein::routes
