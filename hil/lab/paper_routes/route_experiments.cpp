// SPDX-License-Identifier: Apache-2.0
#include "skein/paper_routes/route_experiments.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "skein/base/assert.hpp"
#include "skein/routes/cooperative.hpp"
#include "skein/routes/route_check.hpp"

namespace skein::routes {
namespace {

constexpr std::size_t kMapPopulation = 30;
constexpr std::uint64_t kMapIterations = 200;
constexpr std::size_t kConvergencePopulation = 50;
constexpr std::uint64_t kConvergenceIterations = 150;
constexpr std::size_t kWeightsPopulation = 30;
constexpr std::uint64_t kWeightsIterations = 150;
constexpr std::size_t kWeightsWaypoints = 11;
constexpr std::size_t kWorldPopulation = 30;
constexpr std::uint64_t kWorldIterations = 80;
constexpr std::uint64_t kBestKnownTimes = 100;

std::uint64_t budget_of(SearchMethod method, Counting counting, std::size_t population,
                        std::uint64_t iterations) {
  const std::uint64_t moves = population * iterations;
  if (counting == Counting::evaluations) return moves;
  if (method == SearchMethod::chaotic_grey_wolf) {
    return 2 * population + moves * (1 + ChaoticGreyWolfParams{}.local_steps);
  }
  return population + moves;
}

/// The optimiser's own default population counts for CMA-ES alone: a large one only slows it.
std::size_t population_of(SearchMethod method, std::size_t population) {
  return method == SearchMethod::cma_es ? 0 : population;
}

struct Solved {
  double value = 0.0;
  std::uint64_t evaluations = 0;
  RouteCosts costs{};
  std::vector<Vec2> curve{};
};

Solved solve(const Contender& contender, const CurveProblem& problem, std::size_t population,
             const SearchBudget& budget, std::uint64_t seed) {
  if (contender.ours) {
    SingleRouteParams params;
    params.evaluations = budget.evaluations;
    params.go_on = budget.go_on;
    auto route = plan_route(problem, params, Random{seed});
    SKEIN_ASSERT(route.ok());
    return {route->costs.total, route->evaluations, route->costs, std::move(route->curve)};
  }
  CurveEvaluator evaluator{problem, contender.form};
  const Objective objective = [&](std::span<const double> point) { return evaluator(point); };
  const SearchResult found =
      search(contender.method, objective, {evaluator.box(), {}},
             population_of(contender.method, population), budget, Random{seed});
  return {found.value, found.evaluations, evaluator.costs(found.best), evaluator.curve(found.best)};
}

Duel duel(std::span<const WorldRun> worlds, double WorldRun::*one, double WorldRun::*other) {
  Duel result;
  for (const WorldRun& world : worlds) {
    result.win_rate += world.*one < world.*other ? 1.0 : 0.0;
    result.mean_difference += (world.*one - world.*other) / world.*other;
  }
  const auto n = static_cast<double>(worlds.size());
  return {result.win_rate / n, result.mean_difference / n};
}

}  // namespace

Spread spread_of(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return {.runs = n,
          .least = values.front(),
          .median = 0.5 * (values[(n - 1) / 2] + values[n / 2]),
          .mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(n),
          .most = values.back()};
}

double run_map(MapUse use, ChaoticMap map, Counting counting, std::uint64_t seed) {
  ChaoticGreyWolfParams params;
  params.population = kMapPopulation;
  (use == MapUse::start ? params.start : params.convergence) = map;
  const CurveProblem problem = paper_curve(paper_starts().front());
  CurveEvaluator evaluator{problem, CurveForm::free_points};
  const std::uint64_t budget =
      budget_of(SearchMethod::chaotic_grey_wolf, counting, kMapPopulation, kMapIterations);
  return chaotic_grey_wolf([&](std::span<const double> point) { return evaluator(point); },
                           {evaluator.box(), {}}, params, {budget, {}}, Random{seed})
      .value;
}

std::string name_of(const Contender& contender) {
  if (contender.ours) return "ours";
  const std::string method{to_string(contender.method)};
  switch (contender.form) {
    case CurveForm::free_points:
      return method + ", free points";
    case CurveForm::lateral_offsets:
      return method + ", lateral offsets";
    default:
      return method + ", turns and legs";
  }
}

std::vector<Contender> contenders() {
  std::vector<Contender> all;
  for (int form = 0; form < static_cast<int>(CurveForm::count); ++form) {
    for (int method = 0; method < static_cast<int>(SearchMethod::count); ++method) {
      all.push_back({static_cast<SearchMethod>(method), static_cast<CurveForm>(form), false});
    }
  }
  all.push_back({.ours = true});
  return all;
}

ConvergenceRun run_convergence(const Contender& contender, Counting counting, std::size_t start,
                               std::uint64_t seed) {
  SKEIN_ASSERT(start < paper_starts().size());
  ConvergenceRun run;
  const SearchBudget budget{
      budget_of(contender.method, counting, kConvergencePopulation, kConvergenceIterations),
      [&](const SearchProgress& progress) {
        run.progress.push_back(progress);
        return true;
      }};
  const Solved solved =
      solve(contender, paper_curve(paper_starts()[start]), kConvergencePopulation, budget, seed);
  run.value = solved.value;
  run.evaluations = solved.evaluations;
  return run;
}

std::array<CostWeights, 3> paper_weights() {
  return {{{0.8, 0.1, 0.1}, {0.1, 0.8, 0.1}, {0.1, 0.1, 0.8}}};
}

WeightsRun run_weights(const Contender& contender, const CostWeights& weights, std::uint64_t seed) {
  CurveProblem problem = paper_curve(paper_starts().front());
  problem.weights = weights;
  problem.waypoints = kWeightsWaypoints;
  const std::uint64_t budget = kWeightsPopulation * kWeightsIterations;
  Solved solved = solve(contender, problem, kWeightsPopulation, {budget, {}}, seed);
  return {weights, solved.costs, std::move(solved.curve)};
}

WorldRun run_world(Counting counting, std::uint64_t seed, bool with_best_known) {
  const CurveProblem problem = random_curve(Random{seed});
  const auto run = [&](SearchMethod method) {
    const std::uint64_t budget = budget_of(method, counting, kWorldPopulation, kWorldIterations);
    return solve({.method = method}, problem, kWorldPopulation, {budget, {}}, seed).value;
  };
  WorldRun world{.chaotic = run(SearchMethod::chaotic_grey_wolf),
                 .wolf = run(SearchMethod::grey_wolf),
                 .swarm = run(SearchMethod::particle_swarm)};
  const std::uint64_t equal = kWorldPopulation * kWorldIterations;
  world.ours = solve({.ours = true}, problem, 0, {equal, {}}, seed).value;
  if (with_best_known) {
    const SearchBudget large{kBestKnownTimes * equal, {}};
    world.best_known = std::min({world.chaotic, world.wolf, world.swarm, world.ours,
                                 solve({.ours = true}, problem, 0, large, seed).value});
  }
  return world;
}

WorldSummary summarise(std::span<const WorldRun> worlds) {
  WorldSummary summary;
  summary.worlds = worlds.size();
  if (worlds.empty()) return summary;
  summary.chaotic_over_wolf = duel(worlds, &WorldRun::chaotic, &WorldRun::wolf);
  summary.chaotic_over_swarm = duel(worlds, &WorldRun::chaotic, &WorldRun::swarm);
  summary.ours_over_chaotic = duel(worlds, &WorldRun::ours, &WorldRun::chaotic);
  summary.ours_over_wolf = duel(worlds, &WorldRun::ours, &WorldRun::wolf);
  summary.ours_over_swarm = duel(worlds, &WorldRun::ours, &WorldRun::swarm);
  const bool known = std::all_of(worlds.begin(), worlds.end(),
                                 [](const WorldRun& world) { return world.best_known > 0.0; });
  if (known) {
    summary.ours_mean_gap = duel(worlds, &WorldRun::ours, &WorldRun::best_known).mean_difference;
  }
  return summary;
}

double run_quality(std::size_t start, std::uint64_t evaluations, std::uint64_t seed) {
  SKEIN_ASSERT(start < paper_starts().size() && evaluations > 0);
  return solve({.ours = true}, paper_curve(paper_starts()[start]), 0, {evaluations, {}}, seed)
      .value;
}

FlightRun run_flight(std::uint64_t world) {
  constexpr std::uint64_t kLong = 300'000;
  CurveProblem problem = random_curve(Random{world});
  problem.reading = CostReading::of_flights;
  FlightRun run;
  run.best_known = std::numeric_limits<double>::infinity();
  const auto plan = [&](std::uint64_t evaluations, std::uint64_t seed) {
    SingleRouteParams params;
    params.evaluations = evaluations;
    const auto route = plan_route(problem, params, Random{seed});
    if (!route) return std::optional<double>{};
    run.best_known = std::min(run.best_known, route->costs.total);
    return std::optional{route->costs.total};
  };
  for (std::size_t k = 0; k < run.values.size(); ++k) {
    run.values[k] = plan(SingleRouteParams{}.evaluations, k);
  }
  plan(kLong, run.values.size());
  return run;
}

ScaleRun run_scale(std::size_t vehicles, std::size_t hazards, bool slow, std::uint64_t seed) {
  const RouteProblem problem = random_team(vehicles, hazards, Random{seed});
  RoutePlannerParams params;
  if (slow) {
    params.evaluations *= 10;
    params.evaluations_all *= 10;
    params.reorders *= 10;
    params.corridors *= 3;
    params.corridors_tried *= 3;
  }
  ScaleRun run;
  const auto plan = plan_routes(problem, params, Random{seed});
  if (!plan) {
    run.reason = plan.error().message;
    return run;
  }
  run.planned = true;
  const CheckReport report = check_routes(problem, *plan);
  run.checked = report.ok();
  if (!report.ok()) run.reason = report.violations.front().message;
  run.over_bound = plan->arrival_s / plan->bound_s - 1.0;
  run.separation_m = report.separation_m;
  run.evaluations = plan->evaluations;
  return run;
}

}  // namespace skein::routes
