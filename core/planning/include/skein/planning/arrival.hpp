// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "skein/base/result.hpp"
#include "skein/domain/hazard.hpp"
#include "skein/domain/path.hpp"
#include "skein/planning/avoidance.hpp"

namespace skein::planning {

/// From a pose to a pose, at constant speed.
struct Transit {
  Pose2 from;
  Pose2 to;
  double radius_m = 0.0;      ///< least turn radius
  double length_max_m = 0.0;  ///< the range that may be used
  std::span<const Hazard> hazards;
};

/// A clear path from pose to pose of exactly `length_m` (within 1e-6 m): larger turn radii first
/// (ref. 28 of Wang 2022), then detours, then whole extra loops. Fails with the reason, and the
/// next longer length that it can fly, where the length lies below the shortest or in a gap (Chen
/// et al., arXiv 2109.02125), or above length_max_m.
[[nodiscard]] Result<Path> path_of_length(const AvoidanceParams& params, const Transit& transit,
                                          double length_m);

/// The lengths that no path without hazards has: those between these two, which both can be flown.
struct LengthGap {
  double low_m = 0.0;
  double high_m = 0.0;
};

/// The one gap above the shortest length, where there is one (Chen et al., arXiv 2109.02125). Only
/// where the shortest is a CSC word and both CCC words with the middle arc below a half turn exist:
/// they are the longest waves within the turning circles. The gap ends with the next longer word,
/// or a loop. About a microsecond. In arrival_proof_test no path was found in any of the gaps.
[[nodiscard]] std::optional<LengthGap> length_gap(const Pose2& from, const Pose2& to,
                                                  double radius_m);

/// Can path_of_length surely fly this length: it lies in no gap, and no hazard is in reach of such
/// a path? A few products for each hazard, and a microsecond where the poses are near. Without
/// hazards it is exact; with hazards in reach it says no, and only path_of_length knows.
/// Precondition: shortest_m is shortest_dubins_length(from, to, radius_m).
[[nodiscard]] bool surely_flyable(const AvoidanceParams& params, const Transit& transit,
                                  double shortest_m, double length_m);

/// The least length >= `length_m` for which path_of_length succeeds.
[[nodiscard]] Result<double> least_length_from(const AvoidanceParams& params,
                                               const Transit& transit, double length_m);

}  // namespace skein::planning
