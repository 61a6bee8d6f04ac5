// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "skein/base/random.hpp"
#include "skein/routes/chaos.hpp"

namespace skein::routes {

/// What is minimised: any finite number for any point of the box.
using Objective = std::function<double(std::span<const double>)>;

/// The points that are looked at. Same size; low < high.
struct Box {
  std::vector<double> low{};
  std::vector<double> high{};

  [[nodiscard]] std::size_t dimension() const { return low.size(); }
  /// The nearest point of the box.
  void clamp(std::span<double> point) const;
};

struct SearchProgress {
  std::uint64_t evaluations = 0;
  double best = 0.0;  ///< the least value so far
};

/// Nothing here reads a clock: a budget counts evaluations of the objective, every one of them.
struct SearchBudget {
  std::uint64_t evaluations = 0;
  /// Asked after every generation; false ends the search. May be empty.
  std::function<bool(const SearchProgress&)> go_on;
};

struct SearchResult {
  std::vector<double> best{};
  double value = 0.0;
  std::uint64_t evaluations =
      0;  ///< exactly the budget's, unless it was cancelled or has converged
  bool cancelled = false;
};

/// The box, and points of it that are known to be good: they are part of the first population.
struct SearchSpace {
  Box box;
  std::vector<std::vector<double>> seeds;
};

struct GreyWolfParams {
  std::size_t population = 30;
};
/// Grey wolf optimiser (Mirjalili, Mirjalili and Lewis 2014; Wu 2022, eq. 12-16): all wolves move
/// to the mean of three pulls towards the best three so far, over-shooting by up to `a`, which
/// falls from 2 to 0 over the budget.
[[nodiscard]] SearchResult grey_wolf(const Objective& objective, const SearchSpace& space,
                                     const GreyWolfParams& params, const SearchBudget& budget,
                                     Random random);

struct ChaoticGreyWolfParams {
  std::size_t population = 30;
  ChaoticMap start = ChaoticMap::intermittency;
  ChaoticMap convergence = ChaoticMap::intermittency;
  ChaoticMap local = ChaoticMap::logistic;
  /// C_max of the chaotic local search, by wolf and iteration; 0 leaves it out.
  std::size_t local_steps = 3;
  /// Span of the local search over that of the box (the paper gives none).
  double local_span = 0.02;
  bool chaotic_start = true;
  bool chaotic_convergence = true;  ///< else `a` falls linearly
  bool own_best_pull = true;        ///< eq. 17 and the weights of eq. 18
};
/// The paper's method as printed (Wu 2022, eq. 17-22): start with twice the wolves from a chaotic
/// map, sorted, of which the odd ranks are kept; `a` = 2 x of a chaotic map; a fourth pull towards
/// the wolf's own best; the pulls weighted (1 - f_i / sum f) / 3; chaotic local search. Eq. 22's
/// probability of greedy acceptance is not known in full: here it is the share of the budget used
/// up, so that early moves are all made and late ones only where they are better.
[[nodiscard]] SearchResult chaotic_grey_wolf(const Objective& objective, const SearchSpace& space,
                                             const ChaoticGreyWolfParams& params,
                                             const SearchBudget& budget, Random random);

struct ParticleSwarmParams {
  std::size_t population = 30;
  double inertia_start = 0.9;  ///< falls linearly to inertia_end (Shi and Eberhart 1998)
  double inertia_end = 0.4;
  double own_pull = 2.0;
  double swarm_pull = 2.0;
  double speed_max = 0.2;  ///< over the span of the box
};
/// Particle swarm (Kennedy and Eberhart 1995).
[[nodiscard]] SearchResult particle_swarm(const Objective& objective, const SearchSpace& space,
                                          const ParticleSwarmParams& params,
                                          const SearchBudget& budget, Random random);

struct DifferentialEvolutionParams {
  std::size_t population = 30;
  double crossover = 0.9;
  double scale_min = 0.4;  ///< F, drawn for every trial
  double scale_max = 0.9;
  bool from_best = false;  ///< trial vectors from the best (best/1) instead of any (rand/1)
};
/// Differential evolution (Storn and Price 1997), binomial crossover, greedy selection.
[[nodiscard]] SearchResult differential_evolution(const Objective& objective,
                                                  const SearchSpace& space,
                                                  const DifferentialEvolutionParams& params,
                                                  const SearchBudget& budget, Random random);

struct SuccessHistoryParams {
  std::size_t population = 90;  ///< at first; falls evenly to 4 over the budget
  std::size_t memory = 6;       ///< generations of successes that scales are drawn by
  double best_share = 0.11;     ///< of the population that trial vectors are drawn towards
};
/// Differential evolution that learns its scales and crossovers from what succeeded, and ends with
/// a small population (L-SHADE, Tanabe and Fukunaga 2014).
[[nodiscard]] SearchResult success_history_evolution(const Objective& objective,
                                                     const SearchSpace& space,
                                                     const SuccessHistoryParams& params,
                                                     const SearchBudget& budget, Random random);

struct CmaEsParams {
  std::size_t population = 0;  ///< 0: 4 + 3 ln n
  double sigma = 0.3;          ///< first step size over the span of the box
  /// Begin again with twice the population when converged (IPOP, Auger and Hansen 2005); else end.
  bool restarts = true;
  double tolerance = 1e-10;  ///< converged when the values of a population differ by less
};
/// CMA-ES (Hansen 2016, "The CMA evolution strategy: a tutorial"). Starts from the first seed, or
/// anywhere; points outside the box are evaluated at its border and punished by their distance.
[[nodiscard]] SearchResult cma_es(const Objective& objective, const SearchSpace& space,
                                  const CmaEsParams& params, const SearchBudget& budget,
                                  Random random);

/// The optimisers by name, with their own defaults.
enum class SearchMethod : std::uint8_t {
  grey_wolf,
  chaotic_grey_wolf,
  particle_swarm,
  differential_evolution,
  cma_es,
  count
};
[[nodiscard]] std::string_view to_string(SearchMethod method);
/// `population` 0: the method's default.
[[nodiscard]] SearchResult search(SearchMethod method, const Objective& objective,
                                  const SearchSpace& space, std::size_t population,
                                  const SearchBudget& budget, Random random);

}  // namespace skein::routes
