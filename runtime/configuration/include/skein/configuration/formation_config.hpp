// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "skein/formation/execution.hpp"
#include "skein/formation/limits.hpp"
#include "skein/formation/place_assignment.hpp"
#include "skein/formation/shapes.hpp"

namespace skein::configuration {

/// A free shape, by the name that orders use.
struct NamedShape {
  std::string name;
  std::string file;  ///< shape_file.hpp; in a scenario relative to it
};

/// A track that planes fly along, by the name that orders use.
struct NamedTrack {
  std::string name;
  std::string file;  ///< track_file.hpp; in a scenario relative to it
};

/// How a team flies in formation; the same for the whole team (docs/formation.md).
struct FormationConfig {
  bool planes = false;  ///< along tracks; otherwise multirotors, from place to place
  formation::ShapeSpec rally = {formation::ShapeKind::line_abreast, 5.0, 0.0, {0.0, 0.0, 20.0}, {}};
  formation::MotionLimits limits{.speed_mps = 3.0};
  formation::Separation separation{.horizontal_m = 2.0, .vertical_m = 2.0};  ///< of the vehicles
  double tracking_m = 0.5;  ///< how far a vehicle may be from its reference
  double reserve_m = 1.0;   ///< planned beyond both, for vehicles that are late
  double ceiling_m = 120.0;
  double place_tolerance_m = 0.3;  ///< to be in place
  formation::PlaceMethod assignment = formation::PlaceMethod::least_squares;
  formation::Avoidance avoidance = formation::Avoidance::passage;
  double wind_mps = 0.0;  ///< that the airspeeds of planes leave room for
  std::vector<NamedShape> shapes;
  std::vector<NamedTrack> tracks;
  /// Orders as the operator would type them, each given when the one before is done.
  std::vector<std::string> script;
};

}  // namespace skein::configuration
