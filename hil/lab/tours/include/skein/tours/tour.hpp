// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "skein/base/geometry.hpp"
#include "skein/base/random.hpp"
#include "skein/base/result.hpp"
#include "skein/planning/budget.hpp"

namespace skein::planning {

/// A place that is seen from anywhere within a circle.
struct TourStop {
  Vec2 centre{0.0, 0.0};
  double radius_m = 0.0;
};

/// The shortest way of one vehicle of a least turn radius that touches every circle: in which
/// order, where, and in which direction. The Dubins travelling salesman problem with
/// neighbourhoods (Vana and Faigl, "On the Dubins Traveling Salesman Problem with Neighborhoods",
/// IROS 2015).
struct TourProblem {
  std::vector<TourStop> stops;  ///< at most kTourStopsMax
  double turn_radius_m = 0.0;
  /// Where the vehicle is: the way begins there, and ends at the last stop. None: a round trip.
  std::optional<Pose2> start;
};
inline constexpr std::size_t kTourStopsMax = 1000;

struct TourVisit {
  std::size_t stop = 0;  ///< of the problem
  Pose2 at;              ///< within its circle; from each to the next the shortest Dubins path
};
struct Tour {
  std::vector<TourVisit> visits;  ///< every stop once, in their order
  double length_m = 0.0;
  std::uint64_t steps = 0;
};

/// Ruin and recreate (Schrimpf 2000): a few stops are taken out and put back where they cost least,
/// poses are moved downhill, worse ways accepted ever less often. Anytime: a step is one such
/// change, and more never give a longer way, but where `expired` ends it. Of about 20 stops 5,000
/// steps take a second. The same generator gives the same way. Fails for no stops, too many, or a
/// figure that is none.
[[nodiscard]] Result<Tour> plan_tour(const TourProblem& problem, Random& random,
                                     const PlanningBudget& budget);

}  // namespace skein::planning
