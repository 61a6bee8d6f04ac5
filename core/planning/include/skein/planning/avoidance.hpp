// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <span>

#include "skein/base/result.hpp"
#include "skein/domain/hazard.hpp"
#include "skein/domain/path.hpp"

namespace skein::planning {

struct AvoidanceParams {
  double kappa = 1.1;  ///< safety circle over hazard radius, > 1 (Wang 2022, fig. 5)
  /// A safety circle is larger than its hazard by this at least: what a path is flown off in wind
  /// does not shrink with the hazard. >= 0.
  double margin_m = 0.0;

  [[nodiscard]] double safety_radius_m(const Hazard& hazard) const {
    return std::max(kappa * hazard.radius_m, hazard.radius_m + margin_m);
  }
};

/// Does the path stay outside every hazard? Exact for lines and arcs; touching counts as outside.
[[nodiscard]] bool is_clear(const Path& path, std::span<const Hazard> hazards);
/// The hazard of those that the path enters first, for a message; null where it is clear.
[[nodiscard]] const Hazard* first_entered(const Path& path, std::span<const Hazard> hazards);

/// No path of at most that length between the two poses meets a safety circle: all of them lie
/// outside the ellipse with the poses as its foci. Two distances a hazard.
[[nodiscard]] bool out_of_reach(const AvoidanceParams& params, const Pose2& from, const Pose2& to,
                                double length_m, std::span<const Hazard> hazards);

/// The shortest path between two poses outside the safety circle of every hazard that turns no
/// tighter than `radius_m` (Wang 2022, fig. 5): a Dubins path, or arcs and lines over the tangents
/// of the circles, on either side and in any order. Where an end lies within a safety circle, or is
/// headed so that it must enter it, the path keeps the largest distance that this end allows; where
/// hazards leave no room for all margins, it keeps a part of them; it never enters a hazard.
/// A fine search without tangents finds a shorter one in fewer than 1 of 100 random worlds, and
/// none where this fails (avoidance_search_test).
/// A start inside a hazard that has just become known is left by the shortest way first.
/// Fails, with the reason, for a goal inside a hazard or too close behind one to be approached, a
/// start that no turn keeps from a hazard, and where nothing is found.
[[nodiscard]] Result<Path> shortest_clear_path(const AvoidanceParams& params, const Pose2& from,
                                               const Pose2& to, double radius_m,
                                               std::span<const Hazard> hazards);
/// Its length (within 1e-6 m), for little more than shortest_dubins_length costs where no hazard is
/// in reach.
[[nodiscard]] Result<double> shortest_clear_length(const AvoidanceParams& params, const Pose2& from,
                                                   const Pose2& to, double radius_m,
                                                   std::span<const Hazard> hazards);

}  // namespace skein::planning
