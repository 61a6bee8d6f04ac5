// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "skein/base/random.hpp"
#include "skein/base/result.hpp"
#include "skein/routes/curve.hpp"

namespace skein::routes {

/// How one vehicle's curve is planned, over the shape of its polygon (CurveForm::turns_and_legs).
/// Of flights: seeds are every way round the hazards with several spreads of waypoints, curves of
/// even turning, and curves whose turning changes once; the best of each way past the keep-outs are
/// taken some way to their own least cost by sequential convex programming, and the best of those
/// further; differential evolution with a history of its successes goes on from them. As printed:
/// differential evolution from the ways round the hazards, as was measured for the paper's tables
/// (docs/routes.md).
struct SingleRouteParams {
  std::uint64_t evaluations = 7'500;  ///< in all, those of the seeds included
  /// Of the evolution. 0: by the evaluations, one in 170, but 16 to 120 (as printed one in 115, but
  /// 16 to 300).
  std::size_t population = 0;
  std::size_t corridors = 12;  ///< by each reading of the hazards: all closed, cores, keep-outs
  std::function<bool(const SearchProgress&)> go_on;  ///< as in SearchBudget
};

struct SingleRoute {
  std::vector<Vec2> waypoints{};  ///< the free ones
  std::vector<Vec2> curve{};      ///< sampled, start and site included
  RouteCosts costs{};
  bool clear = false;  ///< of the keep-outs, between samples too; as printed it may be false
  std::uint64_t evaluations = 0;
  bool cancelled = false;
};

/// Fails for a start at the site, fewer than 1 waypoint or 4 samples, hazards without a radius, a
/// start or site within a keep-out, a budget of 0, and, of flights, where no route was found that
/// is clear of the keep-outs.
[[nodiscard]] Result<SingleRoute> plan_route(const CurveProblem& problem,
                                             const SingleRouteParams& params, Random random);

}  // namespace skein::routes
