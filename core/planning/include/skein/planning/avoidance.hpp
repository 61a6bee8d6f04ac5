// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "skein/base/result.hpp"
#include "skein/domain/hazard.hpp"
#include "skein/domain/path.hpp"

namespace skein::planning {

struct AvoidanceParams {
  double kappa = 1.1;  ///< safety circle over hazard radius, > 1 (Wang 2022, fig. 5)
};

/// Does the path stay outside every hazard? Exact for lines and arcs; touching counts as outside.
[[nodiscard]] bool is_clear(const Path& path, std::span<const Hazard> hazards);

/// No path of at most that length between the two poses meets a safety circle: all of them lie
/// outside the ellipse with the poses as its foci. Two distances a hazard.
[[nodiscard]] bool out_of_reach(const AvoidanceParams& params, const Pose2& from, const Pose2& to,
                                double length_m, std::span<const Hazard> hazards);

/// A short path between two poses that enters no hazard and turns no tighter than `radius_m`
/// (Wang 2022, fig. 5): the shortest Dubins path, or two Dubins pieces by a tangent point on the
/// safety circle of the hazard that it meets. Fails, with the reason, where that finds nothing.
[[nodiscard]] Result<Path> shortest_clear_path(const AvoidanceParams& params, const Pose2& from,
                                               const Pose2& to, double radius_m,
                                               std::span<const Hazard> hazards);
/// Its length (within 1e-6 m), for little more than shortest_dubins_length costs where no hazard is
/// in reach.
[[nodiscard]] Result<double> shortest_clear_length(const AvoidanceParams& params, const Pose2& from,
                                                   const Pose2& to, double radius_m,
                                                   std::span<const Hazard> hazards);

}  // namespace skein::planning
