// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "skein/base/random.hpp"
#include "skein/base/result.hpp"
#include "skein/routes/route_problem.hpp"

namespace skein::routes {

struct RoutePlanProgress {
  double arrival_s = 0.0;         ///< the common time that is tried
  std::size_t vehicles = 0;       ///< that have a route at that time
  std::uint64_t evaluations = 0;  ///< routes that were tried so far
};

struct RoutePlannerParams {
  std::size_t corridors = 32;       ///< of a vehicle, for each length of its last leg
  std::size_t corridors_tried = 6;  ///< of those, at one arrival time; more where none will do
  /// Ways to lengthen a corridor that are tried, at most.
  std::uint64_t evaluations = 1'500;
  /// Routes that are tried altogether, within `evaluations`: then it fails, or gives what it has.
  /// Every common time has an equal share, and what earlier ones left: after that its orders are
  /// not changed any more. What worlds take is in docs/routes.md.
  std::uint64_t evaluations_all = 2'000'000;
  std::size_t population = 24;
  std::size_t reorders = 3;  ///< at one arrival time: who found no route goes first next time
  /// Asked after every vehicle; false ends the planning with an error. May be empty.
  std::function<bool(const RoutePlanProgress&)> go_on;
};

/// Routes of all vehicles that arrive together, or at their offsets, each on its own heading, clear
/// of the closed hazards and of each other.
///
/// The common time is the earliest for which routes are found, from that of the slowest vehicle's
/// shortest flyable route upwards. The vehicles are planned one after another, those with the least
/// time to spare first, each clear of those before it. A route is one of the vehicle's corridors
/// (shortest_corridors), lengthened to exactly what its speed asks for: a straight leg, or a part
/// of one, becomes the two sides of an ellipse's triangle between its ends (Wu 2022, eq. 27-33,
/// here on any leg), with the full saving of the turns (eq. 1). Where, how wide and to which side
/// is found by differential evolution, which weighs turning, exposure and spacing (eq. 26, 35, 36).
///
/// Fails, with the vehicle and the reason, for a problem that is not sound, for a vehicle without a
/// way or with too little range, and where no common time within the ranges and `evaluations_all`
/// was found: then with the vehicle that stood in the way most often, and what of.
[[nodiscard]] Result<CooperativePlan> plan_routes(const RouteProblem& problem,
                                                  const RoutePlannerParams& params, Random random);

}  // namespace skein::routes
