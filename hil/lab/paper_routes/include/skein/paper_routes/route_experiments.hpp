// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "skein/paper_routes/paper_world.hpp"
#include "skein/routes/optimiser.hpp"
#include "skein/routes/route_problem.hpp"
#include "skein/routes/single_route.hpp"

/// The experiments of Wu 2022, and ours. Every function is one run: the same arguments give the
/// same result on every machine, and runs may go in parallel. All one-vehicle runs minimise
/// f = f_t + f_line + f_s (eq. 26, plain sum) over n = 200 samples.
namespace skein::routes {

/// Of the results of many runs.
struct Spread {
  std::size_t runs = 0;
  double least = 0.0;
  double median = 0.0;
  double mean = 0.0;
  double most = 0.0;
};
/// All 0 without values.
[[nodiscard]] Spread spread_of(std::vector<double> values);

/// What a method may spend. The chaotic wolf evaluates several routes a wolf and iteration.
enum class Counting : std::uint8_t {
  iterations,   ///< as the paper: population x iterations moves, and what else the method evaluates
  evaluations,  ///< population x iterations evaluations, everything included
  count
};

/// Tables 2 and 3: what a chaotic map is used for.
enum class MapUse : std::uint8_t { start, convergence, count };
/// The chaotic wolf with that map at one place and intermittency at the other: population 30, 200
/// iterations, D = 5, free points, from (0, 0). The best value.
[[nodiscard]] double run_map(MapUse use, ChaoticMap map, Counting counting, std::uint64_t seed);

/// A method of fig. 12: an optimiser over one form of curve, or ours (plan_route).
struct Contender {
  SearchMethod method = SearchMethod::grey_wolf;
  CurveForm form = CurveForm::free_points;
  bool ours = false;  ///< then the rest does not matter
};
[[nodiscard]] std::string name_of(const Contender& contender);
/// Every optimiser on free points, on lateral offsets and on turns and legs; ours last.
[[nodiscard]] std::vector<Contender> contenders();

struct ConvergenceRun {
  std::vector<SearchProgress> progress{};  ///< by generation
  double value = 0.0;
  std::uint64_t evaluations = 0;
};
/// Fig. 12: population 50, 150 iterations, D = 5, from that start of the paper's.
[[nodiscard]] ConvergenceRun run_convergence(const Contender& contender, Counting counting,
                                             std::size_t start, std::uint64_t seed);

/// Fig. 13: a method's curve for other weights; population 30, 150 iterations, D = 11.
struct WeightsRun {
  CostWeights weights{};
  RouteCosts costs{};
  std::vector<Vec2> curve{};
};
/// (0.8, 0.1, 0.1), (0.1, 0.8, 0.1), (0.1, 0.1, 0.8).
[[nodiscard]] std::array<CostWeights, 3> paper_weights();
[[nodiscard]] WeightsRun run_weights(const Contender& contender, const CostWeights& weights,
                                     std::uint64_t seed);

/// Fig. 14 and 15: one random world (`random_curve`), population 30, 80 iterations, D = 5.
struct WorldRun {
  double chaotic = 0.0;
  double wolf = 0.0;
  double swarm = 0.0;
  double ours = 0.0;        ///< 2,400 evaluations
  double best_known = 0.0;  ///< the least of all, and of ours with 100 times the evaluations
};
/// `with_best_known`: costs a hundred times as much; else 0.
[[nodiscard]] WorldRun run_world(Counting counting, std::uint64_t seed, bool with_best_known);

/// How often a method is better than another, and the mean of (its value - the other's) / the
/// other's.
struct Duel {
  double win_rate = 0.0;
  double mean_difference = 0.0;
};
struct WorldSummary {
  std::size_t worlds = 0;
  Duel chaotic_over_wolf{};   ///< the paper: 0.74, -0.0129
  Duel chaotic_over_swarm{};  ///< the paper: 0.548, -0.0466
  Duel ours_over_chaotic{};
  Duel ours_over_wolf{};
  Duel ours_over_swarm{};
  double ours_mean_gap = 0.0;  ///< over the best known; 0 where it was not asked for
};
[[nodiscard]] WorldSummary summarise(std::span<const WorldRun> worlds);

/// Quality: ours from a start of the paper's with so many evaluations. For a best known, ask with
/// 100 times 7,500 and more, and take the least of several seeds.
[[nodiscard]] double run_quality(std::size_t start, std::uint64_t evaluations, std::uint64_t seed);

/// Four of ours with 7,500 evaluations in a random world, by the costs of flights, and the least
/// that they and a search with forty times as many have found. None: refused.
struct FlightRun {
  std::array<std::optional<double>, 4> values{};
  double best_known = 0.0;
};
[[nodiscard]] FlightRun run_flight(std::uint64_t world);

/// Scale: a random team planned and checked.
struct ScaleRun {
  bool planned = false;
  bool checked = false;       ///< planned, and the checker found nothing
  std::string reason{};       ///< why not
  double over_bound = 0.0;    ///< common time over its lower bound, less 1
  double separation_m = 0.0;  ///< the least, as measured by the checker
  std::uint64_t evaluations = 0;
};
/// `slow`: 10 times the evaluations and reorders, 3 times the corridors.
[[nodiscard]] ScaleRun run_scale(std::size_t vehicles, std::size_t hazards, bool slow,
                                 std::uint64_t seed);

}  // namespace skein::routes
