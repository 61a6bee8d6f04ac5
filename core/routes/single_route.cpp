// SPDX-License-Identifier: Apache-2.0
#include "skein/routes/single_route.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "curve_polish.hpp"
#include "skein/routes/corridors.hpp"
#include "skein/routes/fly_by.hpp"
#include "skein/routes/optimiser.hpp"

namespace skein::routes {
namespace {

/// Corners of corridors: fine enough to look like the arc.
constexpr double kCorner_rad = 0.5;

/// How waypoints are spread along a way: the share of the way at each share of their number.
/// Samples are as many between any two waypoints, so that where waypoints lie is a choice of what
/// is sampled densely.
enum class Spread : std::uint8_t { even, start, site, far_start, far_site, ends, middle };
constexpr std::array kSpreads = {Spread::even,     Spread::start, Spread::site,  Spread::far_start,
                                 Spread::far_site, Spread::ends,  Spread::middle};

double spread(Spread law, double share) {
  const double left = 1.0 - share;
  switch (law) {
    case Spread::start:
      return share * share;
    case Spread::site:
      return 1.0 - left * left;
    case Spread::far_start:
      return share * share * share * share;
    case Spread::far_site:
      return 1.0 - left * left * left * left;
    case Spread::ends:
      return share * share * (3.0 - 2.0 * share);
    case Spread::middle:
      return share + 2.0 * share * left * (0.5 - share);
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
  const std::uint64_t generations = printed ? 115 : 170;
  return static_cast<std::size_t>(
      std::clamp<std::uint64_t>(params.evaluations / generations, 16, printed ? 300 : 120));
}

/// Curves of even turning, which costs nothing: from far to one side to far to the other, with even
/// legs, or with one that is the longest by much or by very much: the turning is then elsewhere.
/// Points of turns_and_legs.
std::vector<std::vector<double>> arcs(std::size_t waypoints) {
  constexpr int kEachSide = 10;
  constexpr double kTurn_rad = 0.05;
  std::vector<std::vector<double>> all;
  for (const double fall : {1.0, 0.5, 0.2}) {
    for (std::size_t longest = 0; longest <= (fall < 1.0 ? waypoints : 0); ++longest) {
      for (int k = -kEachSide; k <= kEachSide; ++k) {
        std::vector<double> point(2 * waypoints + 1, 0.0);
        point[0] = k * kTurn_rad;
        for (std::size_t leg = 0; leg <= waypoints; ++leg) {
          const std::size_t away = leg > longest ? leg - longest : longest - leg;
          point[waypoints + leg] = std::max(2.0 * std::pow(fall, away), 0.1);
        }
        all.push_back(std::move(point));
      }
    }
  }
  return all;
}

/// A curve whose turning changes once, anywhere, with any legs.
std::vector<double> random_bend(std::size_t waypoints, Random& random) {
  constexpr double kTurnMax_rad = 0.35;
  constexpr double kLegs = 0.8;
  std::vector<double> point(2 * waypoints + 1, 0.0);
  point[0] = random.uniform(-kTurnMax_rad, kTurnMax_rad);
  const double then = random.uniform(-kTurnMax_rad, kTurnMax_rad);
  if (waypoints > 1) point[1 + random.index(waypoints - 1)] = with_turn_step(then - point[0]);
  for (std::size_t leg = 0; leg <= waypoints; ++leg) {
    point[waypoints + leg] = std::exp(random.normal(-0.7, kLegs));
  }
  return point;
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

/// A curve to begin from.
struct Seed {
  double value = 0.0;  ///< what it is ranked by
  double cost = 0.0;   ///< keep-outs closed
  std::vector<double> point{};
};

void rank(std::vector<Seed>& seeds) {
  std::stable_sort(seeds.begin(), seeds.end(),
                   [](const Seed& a, const Seed& b) { return a.value < b.value; });
}

/// Seeds, best first: the straight line, every corridor with several spreads of waypoints, and, of
/// flights, curves of even turning, and of turning that changes once. As many as may be evaluated.
std::vector<Seed> seeds_of(const CurveProblem& problem, const SingleRouteParams& params,
                           CurveEvaluator& evaluator, Random& random) {
  constexpr std::uint64_t kRandomShare = 8;  // one in so many evaluations
  const bool printed = problem.reading == CostReading::as_printed;
  std::vector<Seed> seeds;
  const auto add_point = [&](std::vector<double> point) {
    if (seeds.size() >= params.evaluations) return;
    const RouteCosts costs = evaluator.costs(point);
    const double value = printed ? costs.total : cost_with_slopes(problem.weights, costs);
    seeds.push_back({value, costs.total, std::move(point)});
  };
  const auto add_way = [&](const std::vector<Vec2>& way) {
    for (const Spread law : std::span{kSpreads}.first(printed ? 3 : kSpreads.size())) {
      add_point(evaluator.point_of(spread_along(way, problem.waypoints, law)));
    }
  };
  add_way({problem.start, problem.site});
  const CorridorEnds ends{.start = problem.start, .goal = problem.site};
  for (const std::vector<Disc>& discs : readings(problem)) {
    for (const Corridor& corridor : shortest_corridors(ends, discs, params.corridors)) {
      std::vector<Vec2> way = corners_of(corridor, kCorner_rad);
      way.insert(way.begin(), problem.start);
      way.push_back(problem.site);
      add_way(way);
    }
  }
  if (!printed) {
    for (std::vector<double>& point : arcs(problem.waypoints)) add_point(std::move(point));
    for (std::uint64_t k = 0; k < params.evaluations / kRandomShare; ++k) {
      std::vector<double> point = random_bend(problem.waypoints, random);
      evaluator.box().clamp(point);
      add_point(std::move(point));
    }
  }
  rank(seeds);
  return seeds;
}

/// The best seeds of different ways: a few on each way past the keep-outs, none near another.
std::vector<const Seed*> different_ways(const CurveProblem& problem, const std::vector<Seed>& seeds,
                                        CurveEvaluator& evaluator) {
  constexpr std::size_t kWays = 64;
  constexpr std::size_t kOfAWay = 10;
  constexpr double kApart = 0.01;  ///< of the straight distance
  constexpr std::size_t kEvery = 8;
  struct Chosen {
    std::vector<char> sides;
    std::vector<Vec2> curve;
  };
  const double apart_m = kApart * (problem.site - problem.start).norm();
  std::vector<Chosen> chosen;
  std::vector<const Seed*> ways;
  for (const Seed& seed : seeds) {
    if (ways.size() == kWays) break;
    const std::vector<Vec2> all = evaluator.curve(seed.point);
    Chosen one;
    for (std::size_t k = 0; k < all.size(); k += kEvery) one.curve.push_back(all[k]);
    one.curve.push_back(all.back());
    for (const RouteHazard& hazard : problem.hazards) {
      if (hazard.kind != HazardKind::keep_out) continue;
      double swept_rad = 0.0;
      for (std::size_t k = 1; k < one.curve.size(); ++k) {
        swept_rad += turn_at(one.curve[k - 1], hazard.centre, 2.0 * hazard.centre - one.curve[k]);
      }
      one.sides.push_back(swept_rad > 0.0 ? 1 : 0);
    }
    std::size_t of_way = 0;
    const bool near = std::any_of(chosen.begin(), chosen.end(), [&](const Chosen& other) {
      of_way += other.sides == one.sides ? 1 : 0;
      return std::equal(one.curve.begin(), one.curve.end(), other.curve.begin(),
                        [&](const Vec2& a, const Vec2& b) { return (a - b).norm() < apart_m; });
    });
    if (near || of_way >= kOfAWay) continue;
    chosen.push_back(std::move(one));
    ways.push_back(&seed);
  }
  return ways;
}

/// Of flights: many different curves are taken some way towards their own least cost, so that they
/// are compared as what they can become; the best of them further, and again from beside the best.
/// Evolution goes on from these, and its best is polished.
class FlightSearch {
 public:
  FlightSearch(const CurveProblem& problem, const SingleRouteParams& params,
               CurveEvaluator& evaluator, Random random)
      : problem_{problem}, params_{params}, evaluator_{evaluator}, random_{random} {}

  SearchResult run(const std::vector<Seed>& seeds) {
    for (const Seed& seed : seeds) take(seed.point, seed.cost);
    found_.evaluations = seeds.size();
    const std::uint64_t screened = params_.evaluations * kScreenShare / 100;
    for (const Seed* way : different_ways(problem_, seeds, evaluator_)) {
      if (found_.evaluations >= screened || !go_on()) break;
      polish(way->point, std::min(kScreen, screened - found_.evaluations));
    }
    rank(polished_);
    const std::vector<Seed> best{
        polished_.begin(),
        polished_.begin() + std::min<std::ptrdiff_t>(kBest, std::ssize(polished_))};
    for (const Seed& one : best) {
      if (left() < 3 * kPolish || !go_on()) break;
      polish(one.point, kPolish);
    }
    const std::uint64_t evolved = params_.evaluations * kEvolveShare / 100;
    while (left() > evolved && !polished_.empty() && go_on()) {
      rank(polished_);
      const std::size_t of_best = std::min<std::size_t>(kAgain, polished_.size());
      polish(beside(polished_[random_.index(of_best)].point), std::min(kPolish, left() - evolved));
    }
    rank(polished_);
    if (left() > 2 * kPolish && !found_.cancelled) evolve(left() - kPolish);
    if (left() > 0 && go_on()) polish(found_.best, left());
    if (left() > 0 && !found_.cancelled) evolve(left());
    return found_;
  }

 private:
  static constexpr std::uint64_t kScreen = 85;       ///< evaluations for one: seven gradients
  static constexpr std::uint64_t kScreenShare = 50;  ///< of all, in per cent, until when
  static constexpr std::ptrdiff_t kBest = 6;
  static constexpr std::uint64_t kPolish = 200;
  static constexpr std::size_t kAgain = 3;           ///< others beside that many of the best
  static constexpr std::uint64_t kEvolveShare = 20;  ///< of all, in per cent: what is left for it
  static constexpr double kBeside = 0.04;            ///< of the box

  [[nodiscard]] std::uint64_t left() const { return params_.evaluations - found_.evaluations; }
  bool go_on() {
    if (params_.go_on && !params_.go_on({found_.evaluations, found_.value}))
      found_.cancelled = true;
    return !found_.cancelled;
  }
  void take(const std::vector<double>& point, double value) {
    if (!found_.best.empty() && !(value < found_.value)) return;
    found_.best = point;
    found_.value = value;
  }
  void polish(const std::vector<double>& from, std::uint64_t most) {
    auto polished = CurvePolish{problem_, evaluator_}.polish(from, most);
    found_.evaluations += polished.evaluations;
    if (polished.point.empty()) return;
    take(polished.point, polished.value);
    polished_.push_back({polished.value, polished.value, std::move(polished.point)});
  }
  [[nodiscard]] std::vector<double> beside(std::vector<double> point) {
    const Box& box = evaluator_.box();
    for (std::size_t j = 0; j < point.size(); ++j) {
      point[j] += random_.normal(0.0, kBeside * (box.high[j] - box.low[j]));
    }
    box.clamp(point);
    return point;
  }
  /// The polished ones, and others beside the best.
  void evolve(std::uint64_t evaluations) {
    const std::size_t population = population_for(problem_, params_);
    SearchSpace space{evaluator_.box(), {}};
    for (const Seed& one : polished_) {
      if (space.seeds.size() < population / 2) space.seeds.push_back(one.point);
    }
    if (space.seeds.empty()) space.seeds.push_back(found_.best);
    while (space.seeds.size() < population) space.seeds.push_back(beside(found_.best));
    const std::uint64_t before = found_.evaluations;
    const SearchBudget budget{evaluations, [&](const SearchProgress& progress) {
                                return !params_.go_on ||
                                       params_.go_on({before + progress.evaluations,
                                                      std::min(progress.best, found_.value)});
                              }};
    const Objective objective = [&](std::span<const double> point) { return evaluator_(point); };
    const SearchResult evolved = success_history_evolution(
        objective, space, {.population = population}, budget, random_.fork());
    found_.evaluations += evolved.evaluations;
    found_.cancelled = evolved.cancelled;
    take(evolved.best, evolved.value);
  }

  const CurveProblem& problem_;
  const SingleRouteParams& params_;
  CurveEvaluator& evaluator_;
  Random random_;
  SearchResult found_;
  std::vector<Seed> polished_;
};

/// As printed: differential evolution from the best seeds, half of the population; the other half
/// is anywhere.
SearchResult search_as_printed(const CurveProblem& problem, const SingleRouteParams& params,
                               CurveEvaluator& evaluator, const std::vector<Seed>& seeds,
                               Random random) {
  SearchResult best{seeds.front().point, seeds.front().value, seeds.size(), false};
  if (seeds.size() >= params.evaluations) return best;
  const std::size_t population = population_for(problem, params);
  SearchSpace space{evaluator.box(), {}};
  for (std::size_t i = 0; i < std::min(seeds.size(), population / 2); ++i) {
    space.seeds.push_back(seeds[i].point);
  }
  const Objective objective = [&](std::span<const double> point) { return evaluator(point); };
  SearchResult found =
      differential_evolution(objective, space, {.population = population},
                             {params.evaluations - seeds.size(), params.go_on}, random);
  found.evaluations += seeds.size();
  if (best.value <= found.value) {
    found.best = std::move(best.best);
    found.value = best.value;
  }
  return found;
}

}  // namespace

Result<SingleRoute> plan_route(const CurveProblem& problem, const SingleRouteParams& params,
                               Random random) {
  if (const auto valid = validate(problem, params); !valid) return valid.error();
  CurveEvaluator evaluator{problem, CurveForm::turns_and_legs};
  const std::vector<Seed> seeds = seeds_of(problem, params, evaluator, random);
  const SearchResult found = problem.reading == CostReading::as_printed
                                 ? search_as_printed(problem, params, evaluator, seeds, random)
                                 : FlightSearch{problem, params, evaluator, random}.run(seeds);
  SingleRoute route;
  route.evaluations = found.evaluations;
  route.cancelled = found.cancelled;
  route.costs = evaluator.costs(found.best);
  route.waypoints = evaluator.waypoints(found.best);
  route.curve = evaluator.curve(found.best);
  const RouteHazard* const entered = entered_keep_out(problem, found.best);
  route.clear = entered == nullptr;
  if (entered != nullptr && problem.reading == CostReading::of_flights) {
    return Error{"no route was found that is clear of keep-out hazard " +
                 std::to_string(entered->id.value) + " (" + std::to_string(route.evaluations) +
                 " tried); more waypoints or evaluations may find one"};
  }
  return route;
}

}  // namespace skein::routes
