// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "skein/routes/curve.hpp"

namespace skein::routes {

/// A curve's cost where keep-outs are a slope and no cliff: of flights, what enters one costs what
/// it would without them, and more by how far it does. Ranks what is worth being mended.
[[nodiscard]] double cost_with_slopes(const CostWeights& weights, const RouteCosts& costs);

/// The nearest local least of a curve's cost (turns_and_legs, of flights), by sequential convex
/// programming: length and exposure are modelled by their gradient and a curvature that is learnt
/// (BFGS, damped as by Powell 1978), the room to keep-outs by its gradient, and the kinks of the
/// turning cost and of the slopes of keep-outs as what they are (Fletcher 1982; Lewis, Wright
/// 2016). Gradients are differences: each costs as many evaluations as the point has numbers, all
/// of which are counted.
class CurvePolish {
 public:
  CurvePolish(const CurveProblem& problem, CurveEvaluator& evaluator)
      : problem_{problem}, evaluator_{evaluator} {}

  struct Polished {
    std::vector<double> point{};  ///< the best that was seen; empty without evaluations
    double value = std::numeric_limits<double>::infinity();  ///< its cost, keep-outs closed
    std::uint64_t evaluations = 0;                           ///< at most those allowed
  };
  [[nodiscard]] Polished polish(std::span<const double> from, std::uint64_t evaluations);

 private:
  const CurveProblem& problem_;
  CurveEvaluator& evaluator_;
};

}  // namespace skein::routes
