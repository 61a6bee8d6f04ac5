// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "skein/base/geometry.hpp"
#include "skein/base/result.hpp"
#include "skein/domain/path.hpp"

namespace skein::formation {

/// Where the centre of a formation of planes flies: straight from waypoint to waypoint, with an arc
/// at each between.
struct Track {
  std::vector<Vec2> waypoints{};  ///< mission frame; two or more, three or more of a closed one
  bool closed = false;            ///< the last leads back to the first
  double turn_radius_m = 0.0;     ///< of the arcs, and of the orbit at the end; > 0
};

/// The centre's path. A closed one begins and ends in the middle of the leg from the first waypoint
/// to the second, and is flown `laps` times. Fails, with what to change, where a leg has no room
/// for its arcs, or there are too many pieces.
[[nodiscard]] Result<Path> track_path(const Track& track, int laps = 1);

/// A place relative to a track: the point of the curve that lies `ahead_m` further along it, offset
/// by `left_m`. On straight legs a formation of such places is rigid; in an arc of curvature k,
/// flown at speed v, a place moves at v (1 - k left) with curvature k / (1 - k left).
struct TrackPlace {
  double ahead_m = 0.0;
  double left_m = 0.0;
};

/// 1 - k left: how fast a place moves as a share of the centre's speed. It can be flown where > 0.
[[nodiscard]] inline double pace_at(const TrackPlace& place, double curvature_per_m) {
  return 1.0 - curvature_per_m * place.left_m;
}

/// A piece of a track as one place of it flies it: lines and arcs too.
struct PlacedPath {
  Path path;
  std::vector<double> paces;  ///< of each of its segments
  double tail_curvature_per_m = 0.0;
  double tail_pace = 1.0;
};

/// From where the centre has flown `centre_m` on, to the end of the track and its orbit.
/// Precondition: pace_at() > 0 on all of it, and no more pieces than a path has room for.
[[nodiscard]] PlacedPath placed_path(const Path& centre, double tail_curvature_per_m,
                                     const TrackPlace& place, double centre_m);

}  // namespace skein::formation
