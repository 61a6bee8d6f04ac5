// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/domain/hazard.hpp"
#include "skein/domain/path.hpp"
#include "skein/planning/avoidance.hpp"

namespace skein::planning {

/// The shortest clear path in its parts.
struct ClearPath {
  Path way_out;  ///< out of the hazards around the start; without pieces where there are none
  Path path;     ///< from the end of the way out to the goal
  /// What the path keeps out of: the safety circles, smaller where the start, the goal or the room
  /// between hazards does not allow them. By hazard.
  std::vector<Hazard> circles;
};

/// The ways out of the hazards around a start, to either side, the shorter first; none where it
/// lies in none.
using WaysOut = std::optional<std::array<Path, 2>>;
[[nodiscard]] WaysOut ways_out(const Pose2& from, double radius_m, std::span<const Hazard> hazards);

/// `ways` are those out of `from`: who asks for many goals works them out once.
[[nodiscard]] Result<ClearPath> find_clear_path(const AvoidanceParams& params, const Pose2& from,
                                                const Pose2& to, double radius_m,
                                                std::span<const Hazard> hazards,
                                                const WaysOut& ways);
[[nodiscard]] Result<ClearPath> find_clear_path(const AvoidanceParams& params, const Pose2& from,
                                                const Pose2& to, double radius_m,
                                                std::span<const Hazard> hazards);

}  // namespace skein::planning
