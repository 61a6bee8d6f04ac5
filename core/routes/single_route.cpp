// SPDX-License-Identifier: Apache-2.0
#include "skein/routes/single_route.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "skein/routes/corridors.hpp"

namespace skein::routes {
namespace {

/// Corners of corridors: fine enough to look like the arc.
constexpr double kCorner_rad = 0.5;

/// How waypoints are spread along a way: the share of the way at each share of their number.
/// Samples are as many between any two waypoints, so that where waypoints lie is a choice of what
/// is sampled densely.
enum class Spread : std::uint8_t { even, towards_start, towards_site };
constexpr std::array kSpreads = {Spread::even, Spread::towards_start, Spread::towards_site};

double spread(Spread law, double share) {
  switch (law) {
    case Spread::towards_start:
      return share * share;
    case Spread::towards_site:
      return 1.0 - (1.0 - share) * (1.0 - share);
    default:
      return share;
  }
}

/// `count` points along the way, ends excluded.
std::vector<Vec2> spread_along(const std::vector<Vec2>& way, std::size_t count, Spread law) {
  double length = 0.0;
  for (std::size_t i = 1; i < way.size(); ++i) length += (way[i] - way[i - 1]).norm();
  std::vector<Vec2> points;
  std::size_t leg = 1;
  double passed = 0.0;
  for (std::size_t k = 1; k <= count; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(count + 1);
    const double at = length * spread(law, share);
    while (leg + 1 < way.size() && passed + (way[leg] - way[leg - 1]).norm() < at) {
      passed += (way[leg] - way[leg - 1]).norm();
      ++leg;
    }
    const Vec2 d = way[leg] - way[leg - 1];
    points.emplace_back(way[leg - 1] + (at - passed) / std::max(d.norm(), 1e-9) * d);
  }
  return points;
}

/// Measured: fewer generations do not converge, smaller populations miss the best way round.
std::size_t population_for(const CurveProblem& problem, const SingleRouteParams& params) {
  if (params.population != 0) return params.population;
  const bool printed = problem.reading == CostReading::as_printed;
  const std::uint64_t generations = printed ? 115 : 80;
  return static_cast<std::size_t>(
      std::clamp<std::uint64_t>(params.evaluations / generations, 16, printed ? 300 : 120));
}

/// Curves of even turning, which costs nothing: from far to one side to far to the other, with legs
/// that are even, or grow or shrink along the way. Points of turns_and_legs.
std::vector<std::vector<double>> arcs(std::size_t waypoints) {
  constexpr int kEachSide = 20;
  constexpr double kTurn_rad = 0.03;
  std::vector<std::vector<double>> all;
  for (int k = -kEachSide; k <= kEachSide; ++k) {
    for (const double growth : {0.0, 1.0, -1.0}) {
      std::vector<double> point(2 * waypoints + 1, 0.0);
      point[0] = k * kTurn_rad;
      for (std::size_t leg = 0; leg <= waypoints; ++leg) {
        const double share = static_cast<double>(leg) / static_cast<double>(waypoints);
        point[waypoints + leg] = 1.0 + growth * (share - 0.5);
      }
      all.push_back(std::move(point));
    }
  }
  return all;
}

/// All hazards closed; only their cores; only keep-outs.
std::vector<std::vector<Disc>> readings(const CurveProblem& problem) {
  std::vector<std::vector<Disc>> sets(3);
  for (const RouteHazard& h : problem.hazards) {
    sets[0].push_back({h.centre, h.radius_m});
    const bool keep_out = h.kind == HazardKind::keep_out;
    const double core = keep_out ? h.radius_m : h.inner_radius_m;
    if (core > 0.0) sets[1].push_back({h.centre, core});
    if (keep_out) sets[2].push_back({h.centre, h.radius_m});
  }
  return sets;
}

Result<void> validate(const CurveProblem& problem, const SingleRouteParams& params) {
  if ((problem.site - problem.start).norm() <= 0.0) return Error{"the start is at the site"};
  if (problem.waypoints < 1) return Error{"a curve needs at least 1 waypoint"};
  if (problem.samples < 4) return Error{"a curve needs at least 4 samples"};
  if (params.evaluations < 1) return Error{"a budget of 0 evaluations finds no route"};
  if (params.population != 0 && params.population < 4) {
    return Error{"a population needs at least 4"};
  }
  for (const RouteHazard& h : problem.hazards) {
    const std::string name = "hazard " + std::to_string(h.id.value);
    if (!(h.radius_m > 0.0) || !(h.inner_radius_m >= 0.0) || h.inner_radius_m >= h.radius_m) {
      return Error{name + " needs a radius > 0 and an inner radius from 0 to below it"};
    }
    if (h.kind != HazardKind::keep_out) continue;
    if (h.value_at(problem.start) > 0.0) return Error{"the start lies within keep-out " + name};
    if (h.value_at(problem.site) > 0.0) return Error{"the site lies within keep-out " + name};
  }
  return {};
}

/// A keep-out that the curve enters; none, or nullptr. Looks at sixteen times as many samples, by
/// geometry of its own.
const RouteHazard* entered_keep_out(const CurveProblem& problem, std::span<const double> point) {
  constexpr std::size_t kFiner = 16;
  CurveProblem finer = problem;
  finer.samples = kFiner * (problem.samples - 1) + 1;
  const std::vector<Vec2> curve = CurveEvaluator{finer, CurveForm::turns_and_legs}.curve(point);
  const auto nearest_m = [](const Vec2& a, const Vec2& b, const Vec2& centre) {
    const Vec2 leg = b - a;
    const double share = leg.squaredNorm() > 0.0 ? (centre - a).dot(leg) / leg.squaredNorm() : 0.0;
    return (a + std::clamp(share, 0.0, 1.0) * leg - centre).norm();
  };
  for (const RouteHazard& hazard : problem.hazards) {
    if (hazard.kind != HazardKind::keep_out) continue;
    for (std::size_t k = 1; k < curve.size(); ++k) {
      if (nearest_m(curve[k - 1], curve[k], hazard.centre) < hazard.radius_m) return &hazard;
    }
  }
  return nullptr;
}

}  // namespace

Result<SingleRoute> plan_route(const CurveProblem& problem, const SingleRouteParams& params,
                               Random random) {
  if (const auto valid = validate(problem, params); !valid) return valid.error();
  const bool printed = problem.reading == CostReading::as_printed;
  CurveEvaluator evaluator{problem, CurveForm::turns_and_legs};
  const Objective objective = [&](std::span<const double> point) { return evaluator(point); };
  SingleRoute route;

  std::vector<std::pair<double, std::vector<double>>> seeds;
  const auto add_point = [&](std::vector<double> point) {
    if (seeds.size() >= params.evaluations) return;
    const double value = objective(point);
    seeds.emplace_back(value, std::move(point));
  };
  const auto add_seed = [&](const std::vector<Vec2>& way) {
    for (const Spread law : kSpreads) {
      add_point(evaluator.point_of(spread_along(way, problem.waypoints, law)));
    }
  };
  add_seed({problem.start, problem.site});
  const CorridorEnds ends{.start = problem.start, .goal = problem.site};
  for (const std::vector<Disc>& discs : readings(problem)) {
    for (const Corridor& corridor : shortest_corridors(ends, discs, params.corridors)) {
      std::vector<Vec2> way = corners_of(corridor, kCorner_rad);
      way.insert(way.begin(), problem.start);
      way.push_back(problem.site);
      add_seed(way);
    }
  }
  if (!printed) {
    for (std::vector<double>& point : arcs(problem.waypoints)) add_point(std::move(point));
  }
  route.evaluations = seeds.size();
  std::stable_sort(seeds.begin(), seeds.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<double> best = seeds.front().second;
  const double value = seeds.front().first;

  // The other half of the population is anywhere.
  const std::size_t population = population_for(problem, params);
  SearchSpace space{evaluator.box(), {}};
  for (std::size_t i = 0; i < std::min(seeds.size(), population / 2); ++i) {
    space.seeds.push_back(seeds[i].second);
  }
  if (route.evaluations < params.evaluations) {
    const SearchBudget left{params.evaluations - route.evaluations, params.go_on};
    SearchResult found =
        printed
            ? differential_evolution(objective, space, {.population = population}, left, random)
            : success_history_evolution(objective, space, {.population = population}, left, random);
    route.evaluations += found.evaluations;
    route.cancelled = found.cancelled;
    if (found.value < value) best = std::move(found.best);
  }
  route.costs = evaluator.costs(best);
  route.waypoints = evaluator.waypoints(best);
  route.curve = evaluator.curve(best);
  const RouteHazard* const entered = entered_keep_out(problem, best);
  route.clear = entered == nullptr;
  if (entered != nullptr && problem.reading == CostReading::of_flights) {
    return Error{"no route was found that is clear of keep-out hazard " +
                 std::to_string(entered->id.value) + " (" + std::to_string(route.evaluations) +
                 " tried); more waypoints or evaluations may find one"};
  }
  return route;
}

}  // namespace skein::routes
