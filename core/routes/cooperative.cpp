// SPDX-License-Identifier: Apache-2.0
#include "skein/routes/cooperative.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "skein/routes/fly_by.hpp"
#include "skein/routes/optimiser.hpp"
#include "team_route.hpp"

namespace skein::routes {
namespace {

/// Common times that are tried, over the earliest by which every vehicle alone could arrive.
constexpr std::array kDelays = {0.0, 0.0005, 0.001, 0.002, 0.005, 0.01, 0.02, 0.035, 0.05, 0.075,
                                0.1, 0.15,   0.2,   0.3,   0.4,   0.5,  0.7,  1.0,   1.5,  2.0};
constexpr int kRefinements = 2;
constexpr std::size_t kTrackSamples = 64;
/// A base route so near to its length needs no detour.
constexpr double kExact_m = 1e-6;
/// Corridors that gave a route, after which no other is tried.
constexpr std::size_t kEnough = 2;
/// Where none gave a route, so many times as many are tried.
constexpr std::size_t kStubborn = 4;
/// Once a route keeps to the rules, this share of the evaluations is enough to smooth it.
constexpr double kSmoothShare = 0.4;

std::string name(const RouteVehicle& vehicle) {
  return "vehicle " + std::to_string(vehicle.id.value);
}

Result<void> validate_vehicle(const RouteProblem& problem, const RouteVehicle& v) {
  const bool finite = v.start.allFinite() && std::isfinite(v.start_heading_rad) &&
                      std::isfinite(v.approach_heading_rad) && std::isfinite(v.arrival_offset_s) &&
                      std::isfinite(v.start_height_m) && std::isfinite(v.arrival_height_m);
  if (!finite) return Error{name(v) + ": start, headings, heights and offset must be finite"};
  if (!(v.climb_max > 0.0)) return Error{name(v) + ": the steepest climb must be above 0"};
  if (!(v.speed_mps > 0.0)) return Error{name(v) + ": the speed must be above 0"};
  if (!(v.turn_radius_m > 0.0)) return Error{name(v) + ": the turn radius must be above 0"};
  if (!(v.range_m > 0.0))
    return Error{name(v) +
                 ": its range leaves nothing for a way to the site; give it a greater range_m"};
  if (!(v.start_cone_rad >= 0.0)) return Error{name(v) + ": the start cone must not be negative"};
  for (const RouteHazard& h : problem.hazards) {
    if (problem.closed(h) && (h.centre - v.start).norm() < h.radius_m + problem.rules.clearance_m) {
      return Error{name(v) + " starts within hazard " + std::to_string(h.id.value)};
    }
  }
  return {};
}

Result<void> validate(const RouteProblem& problem) {
  const RouteRules& rules = problem.rules;
  if (problem.vehicles.empty()) return Error{"there is no vehicle to plan for"};
  if (!(rules.last_leg_m > 0.0)) return Error{"the last leg must be longer than 0"};
  if (!(rules.turn_max_rad > 0.0) || rules.turn_max_rad >= kPi) {
    return Error{"the largest turn must be above 0 and below half a turn"};
  }
  if (rules.waypoints_max < 10 || rules.waypoints_max > kWaypointsMax) {
    return Error{"a route may have 10 to " + std::to_string(kWaypointsMax) + " waypoints"};
  }
  for (const RouteHazard& h : problem.hazards) {
    if (!(h.radius_m > 0.0))
      return Error{"hazard " + std::to_string(h.id.value) + " has no radius"};
    if (problem.closed(h) && (h.centre - problem.site).norm() < h.radius_m + rules.clearance_m) {
      return Error{"the site lies within hazard " + std::to_string(h.id.value)};
    }
  }
  for (std::size_t i = 0; i < problem.vehicles.size(); ++i) {
    const RouteVehicle& v = problem.vehicles[i];
    if (auto valid = validate_vehicle(problem, v); !valid) return valid;
    for (std::size_t j = 0; j < i; ++j) {
      const RouteVehicle& w = problem.vehicles[j];
      if (v.id == w.id) return Error{"two vehicles are called " + std::to_string(v.id.value)};
      if ((v.start - w.start).norm() < rules.separation_m) {
        return Error{name(v) + " and " + name(w) + " start nearer than the separation"};
      }
    }
  }
  return {};
}

class Planner {
 public:
  Planner(const RouteProblem& problem, const RoutePlannerParams& params, Random random)
      : problem_{problem}, params_{params}, random_{random}, circles_{closed_circles(problem)} {}

  Result<CooperativePlan> run() {
    if (const auto valid = validate(problem_); !valid) return valid.error();
    if (const auto ready = prepare(); !ready) return ready.error();
    order_.resize(count());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
      return spare_s(a, earliest_s_) < spare_s(b, earliest_s_);
    });
    failures_.resize(count());
    double late = earliest_s_;
    for (std::size_t k = 0; k < kDelays.size(); ++k) {
      const double tried = earliest_s_ * (1.0 + kDelays[k]);
      if (tried > plan_.latest_s || spent()) break;
      allotted_ = params_.evaluations_all / kDelays.size() * (k + 1);
      if (plan_at(tried)) {
        allotted_ = params_.evaluations_all;
        if (k > 0) refine(late, tried);
        return finish();
      }
      if (cancelled_) return Error{"the planning was cancelled"};
      late = tried;
    }
    return obstacle(late);
  }

 private:
  [[nodiscard]] const RouteVehicle& vehicle(std::size_t i) const { return problem_.vehicles[i]; }
  [[nodiscard]] std::size_t count() const { return problem_.vehicles.size(); }

  Result<void> prepare() {
    plan_.latest_s = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < count(); ++i) {
      const RouteVehicle& v = vehicle(i);
      bounds_.push_back(length_bound_m(problem_, v));
      if (std::isinf(bounds_.back())) {
        return Error{name(v) + " has no way to the site past the closed hazards"};
      }
      if (bounds_.back() > v.range_m) {
        return Error{name(v) + " needs at least " + std::to_string(bounds_.back()) +
                     " m, beyond its range"};
      }
      bases_.push_back(base_routes(problem_, v, params_.corridors));
      if (bases_.back().empty()) {
        return Error{
            name(v) +
            " has no route to the site that its turns, waypoints, range and the hazards allow"};
      }
      const double offset = v.arrival_offset_s;
      latest_offset_s_ = std::max(latest_offset_s_, offset);
      plan_.bound_s = std::max(plan_.bound_s, bounds_.back() / v.speed_mps - offset);
      plan_.latest_s = std::min(plan_.latest_s, v.range_m / v.speed_mps - offset);
      shortest_.push_back(std::max(bases_.back().front().length_m, climb_length_m(problem_, v)));
      earliest_s_ = std::max(earliest_s_, shortest_.back() / v.speed_mps - offset);
    }
    if (earliest_s_ > plan_.latest_s) {
      return Error{"the slowest vehicle arrives after " + std::to_string(earliest_s_) +
                   " s, when another's range is used up (" + std::to_string(plan_.latest_s) +
                   " s)"};
    }
    return {};
  }

  /// Of the routes' tracks: the last to arrive has kTrackSamples.
  [[nodiscard]] double step_s(double arrival_s) const {
    return (arrival_s + latest_offset_s_) / static_cast<double>(kTrackSamples);
  }
  [[nodiscard]] bool spent() const { return plan_.evaluations >= params_.evaluations_all; }

  /// Who stood in the way most often, and what of.
  [[nodiscard]] Error obstacle(double latest_tried_s) const {
    const auto times = [](const Failures& f) { return f.near_others + f.unflyable; };
    const auto worst =
        std::max_element(failures_.begin(), failures_.end(),
                         [&](const Failures& a, const Failures& b) { return times(a) < times(b); });
    const auto seconds = [](double s) {
      std::string text = std::to_string(s);
      text.resize(text.size() - 4);  // to 0.01 s
      return text;
    };
    std::string text = "no routes that keep to all rules were found for a common time of " +
                       seconds(earliest_s_) + " to " + seconds(latest_tried_s) + " s";
    if (spent()) text += ", within " + std::to_string(params_.evaluations_all) + " tries";
    if (times(*worst) == 0) return Error{text};
    text += ": " + name(vehicle(static_cast<std::size_t>(worst - failures_.begin())));
    return Error{text + (worst->near_others >= worst->unflyable
                             ? " came too near to others whatever was tried; give it another start "
                               "or bearing, an offset, less separation or more range"
                             : " has no way of that length past the hazards; give it more range, "
                               "more waypoints, tighter turns or less clearance")};
  }

  [[nodiscard]] double spare_s(std::size_t i, double arrival_s) const {
    return arrival_s + vehicle(i).arrival_offset_s - shortest_[i] / vehicle(i).speed_mps;
  }

  /// Routes of everybody at that common time, in `found_`. Who finds none goes first from then on,
  /// also at later times; of the others, whose route is in nobody's way keeps it.
  bool plan_at(double arrival_s) {
    kept_.assign(count(), {});
    const std::size_t attempts = 1 + std::min(params_.reorders, count() - 1);
    for (std::size_t attempt = 0; attempt < attempts; ++attempt) {
      if (attempt > 0 && plan_.evaluations >= allotted_) return false;
      const std::size_t failed = plan_in_order(order_, arrival_s);
      if (failed == count()) return true;
      if (failed == 0 || cancelled_ || spent()) return false;
      std::rotate(order_.begin(), order_.begin() + static_cast<std::ptrdiff_t>(failed),
                  order_.begin() + static_cast<std::ptrdiff_t>(failed) + 1);
    }
    return false;
  }

  /// How many of the order found a route.
  std::size_t plan_in_order(const std::vector<std::size_t>& order, double arrival_s) {
    std::vector<TimedRoute> others;
    std::vector<std::vector<Vec2>> routes(count());
    for (std::size_t k = 0; k < order.size(); ++k) {
      const std::size_t i = order[k];
      auto waypoints = still_clear(i, arrival_s, others) ? std::optional{kept_[i]}
                                                         : plan_vehicle(i, arrival_s, others);
      if (params_.go_on && !params_.go_on({arrival_s, k, plan_.evaluations})) cancelled_ = true;
      if (!waypoints || cancelled_) return k;
      const auto path = fly_by_path(*waypoints, vehicle(i).turn_radius_m);
      SKEIN_ASSERT(path.ok());
      others.emplace_back(*path, vehicle(i), problem_.rules, step_s(arrival_s));
      kept_[i] = routes[i] = std::move(*waypoints);
    }
    found_ = std::move(routes);
    found_s_ = arrival_s;
    return order.size();
  }

  /// It has a route from another order at that time, which is in the way of nobody in this one.
  [[nodiscard]] bool still_clear(std::size_t i, double arrival_s,
                                 const std::vector<TimedRoute>& others) const {
    if (kept_[i].empty()) return false;
    const std::vector<char> none_fresh(kept_[i].size(), 0);
    return RouteJudge{problem_, vehicle(i), circles_, others, step_s(arrival_s)}.judge(
               kept_[i], none_fresh) < RouteJudge::kInfeasible;
  }

  std::optional<std::vector<Vec2>> plan_vehicle(std::size_t i, double arrival_s,
                                                const std::vector<TimedRoute>& others) {
    const RouteVehicle& v = vehicle(i);
    const double target = v.speed_mps * (arrival_s + v.arrival_offset_s);
    const RouteJudge judge{problem_, v, circles_, others, step_s(arrival_s)};
    std::vector<Vec2> best;
    double value = RouteJudge::kInfeasible;
    nearest_ = std::numeric_limits<double>::infinity();
    for (const bool stubborn : {false, true}) {
      // Those that need to be lengthened least, and in turn those that leave most room to choose
      // where.
      std::size_t good = 0;
      std::size_t low = 0;
      std::size_t high = bases_[i].size();
      while (high > 0 && bases_[i][high - 1].length_m > target + kExact_m) --high;
      for (std::size_t k = 0; low < high && good < kEnough; ++k) {
        const bool more = stubborn && good == 0;
        if (k >= params_.corridors_tried * (more ? kStubborn : 1) || spent()) break;
        const BaseRoute& base = k % 2 == 0 ? bases_[i][--high] : bases_[i][low++];
        if (lengthen(base, v, target, judge, stubborn, value, best)) ++good;
      }
      if (good > 0) break;
    }
    if (!best.empty()) return best;
    if (std::isinf(nearest_) && spent()) return std::nullopt;  // it was never its turn
    ++(nearest_ < RouteJudge::kUnflyable ? failures_[i].near_others : failures_[i].unflyable);
    return std::nullopt;
  }

  /// True where the base route could be lengthened within all rules; a better one than `value` is
  /// kept. Most that can be so are soon: only the stubborn go on while others are in the way.
  bool lengthen(const BaseRoute& base, const RouteVehicle& v, double target,
                const RouteJudge& judge, bool stubborn, double& value, std::vector<Vec2>& best) {
    const bool exact = target - base.length_m <= kExact_m;
    const Extension extension{base, v.turn_radius_m, exact ? base.length_m : target};
    std::vector<Vec2> waypoints;
    std::vector<char> fresh;
    const Objective objective = [&](std::span<const double> point) {
      if (!extension.apply(point, waypoints, fresh)) return 10.0 * RouteJudge::kInfeasible;
      return judge.judge(waypoints, fresh);
    };
    const SearchSpace space{Extension::box(), {}};
    DifferentialEvolutionParams evolution;
    evolution.population = params_.population;
    const auto smooth =
        static_cast<std::uint64_t>(kSmoothShare * static_cast<double>(params_.evaluations));
    const std::uint64_t evaluations = exact ? 1 : stubborn ? params_.evaluations : smooth;
    const SearchBudget budget{evaluations, [&](const SearchProgress& progress) {
                                // Good enough, or hopeless.
                                return progress.evaluations < smooth ||
                                       (progress.best >= RouteJudge::kInfeasible &&
                                        progress.best < RouteJudge::kUnflyable);
                              }};
    const SearchResult found =
        differential_evolution(objective, space, evolution, budget, random_.fork());
    plan_.evaluations += found.evaluations;
    nearest_ = std::min(nearest_, found.value);
    if (found.value >= RouteJudge::kInfeasible) return false;
    if (found.value < value) {
      value = found.value;
      SKEIN_ASSERT(extension.apply(found.best, waypoints, fresh));
      best = waypoints;
    }
    return true;
  }

  /// An earlier time between one that failed and one that did not.
  void refine(double late_s, double found_s) {
    for (int k = 0; k < kRefinements && !cancelled_ && !spent(); ++k) {
      const double middle = 0.5 * (late_s + found_s);
      (plan_at(middle) ? found_s : late_s) = middle;
    }
    cancelled_ = false;  // there is a plan already
  }

  [[nodiscard]] double climb_of(const RouteVehicle& v, double length_m) const {
    return (v.arrival_height_m - v.start_height_m) / (length_m - problem_.rules.last_leg_m);
  }

  CooperativePlan finish() {
    plan_.arrival_s = found_s_;
    std::vector<TimedRoute> timed;
    for (std::size_t i = 0; i < count(); ++i) {
      const RouteVehicle& v = vehicle(i);
      const auto path = fly_by_path(found_[i], v.turn_radius_m);
      SKEIN_ASSERT(path.ok());
      PlannedRoute route;
      route.id = v.id;
      route.waypoints = found_[i];
      route.length_m = fly_by_length_m(found_[i], v.turn_radius_m);
      route.arrival_s = route.length_m / v.speed_mps;
      route.bound_m = bounds_[i];
      route.climb = climb_of(v, route.length_m);
      route.costs = route_costs(problem_, found_[i], *path);
      plan_.total_cost += route.costs.total;
      const TimedRoute now{*path, v, problem_.rules, step_s(found_s_)};
      for (const TimedRoute& other : timed) {
        plan_.spacing_cost += spacing_cost(other, now, problem_.rules);
      }
      timed.push_back(now);
      plan_.routes.push_back(std::move(route));
    }
    plan_.total_cost += problem_.spacing_weight * plan_.spacing_cost;
    return plan_;
  }

  const RouteProblem& problem_;
  const RoutePlannerParams& params_;
  Random random_;
  std::vector<Hazard> circles_;
  std::vector<std::vector<BaseRoute>> bases_;
  std::vector<double> bounds_;
  std::vector<double> shortest_;  ///< flyable, by vehicle
  double earliest_s_ = 0.0;
  double latest_offset_s_ = -std::numeric_limits<double>::infinity();
  std::vector<std::vector<Vec2>> kept_;  ///< by vehicle: the last one at the time that is tried
  std::vector<std::vector<Vec2>> found_;
  double found_s_ = 0.0;
  std::vector<std::size_t> order_;  ///< in which vehicles are planned
  /// How often it found no route, by what the best that was tried did wrong.
  struct Failures {
    std::size_t near_others = 0;
    std::size_t unflyable = 0;
  };
  std::vector<Failures> failures_;  ///< by vehicle
  std::uint64_t allotted_ = 0;      ///< to the times so far; later ones have their chance, too
  double nearest_ = 0.0;            ///< to a route of the vehicle that was planned last
  bool cancelled_ = false;
  CooperativePlan plan_;
};

}  // namespace

Result<CooperativePlan> plan_routes(const RouteProblem& problem, const RoutePlannerParams& params,
                                    Random random) {
  return Planner{problem, params, random}.run();
}

}  // namespace skein::routes
