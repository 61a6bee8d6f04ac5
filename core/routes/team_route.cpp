// SPDX-License-Identifier: Apache-2.0
#include "team_route.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "skein/routes/corridors.hpp"
#include "skein/routes/fly_by.hpp"

namespace skein::routes {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Circles are a little larger than asked for, and last legs longer, so that rounding breaks no
/// rule.
constexpr double kRounding_m = 1e-5;
/// Last legs that are tried, over the least one.
constexpr std::array kLastLegs = {1.0, 1.5, 2.25};
/// Corners around a circle, finest first: fine ones are shorter, coarse ones need fewer waypoints.
constexpr std::array kCorners_rad = {0.15, 0.3, 0.45, 0.6, 0.8, 1.05, 1.4};
/// The most waypoints that two detours add.
constexpr std::size_t kDetourWaypoints = 6;
constexpr std::size_t kExposureSamples = 200;
constexpr std::size_t kSpacingSamples = 64;

std::vector<Disc> discs_of(const std::vector<Hazard>& circles) {
  std::vector<Disc> discs;
  discs.reserve(circles.size());
  for (const Hazard& circle : circles) discs.push_back({circle.centre, circle.radius_m});
  return discs;
}

bool is_clear(const Path& path, const std::vector<Hazard>& circles) {
  Pose2 at = path.start;
  for (const Segment& piece : path.segments) {
    for (const Hazard& circle : circles) {
      if (distance_to_piece(circle.centre, at, piece.curvature_per_m, piece.length_m) <
          circle.radius_m - 0.5 * kRounding_m) {
        return false;
      }
    }
    at = advance(at, piece.curvature_per_m, piece.length_m);
  }
  return true;
}

/// The corridor with as fine corners as the number of waypoints allows. Nothing where none is
/// clear: corners are cut outside of their circle, where another may begin.
std::optional<BaseRoute> cornered(const RouteProblem& problem, const RouteVehicle& vehicle,
                                  const Corridor& corridor, const std::vector<Hazard>& circles) {
  for (const double corner_rad : kCorners_rad) {
    if (corner_rad > problem.rules.turn_max_rad) break;
    BaseRoute route{.waypoints = corners_of(corridor, corner_rad), .length_m = 0.0};
    route.waypoints.insert(route.waypoints.begin(), vehicle.start);
    route.waypoints.push_back(problem.site);
    if (route.waypoints.size() + kDetourWaypoints > problem.rules.waypoints_max) continue;
    const auto path = fly_by_path(route.waypoints, vehicle.turn_radius_m);
    if (!path || !is_clear(*path, circles)) continue;
    route.length_m = fly_by_length_m(route.waypoints, vehicle.turn_radius_m);
    return route;
  }
  return std::nullopt;
}

}  // namespace

std::vector<Hazard> closed_circles(const RouteProblem& problem) {
  std::vector<Hazard> circles;
  for (const RouteHazard& hazard : problem.hazards) {
    if (!problem.closed(hazard)) continue;
    circles.push_back(
        {hazard.id, hazard.centre, hazard.radius_m + problem.rules.clearance_m + kRounding_m});
  }
  return circles;
}

double length_bound_m(const RouteProblem& problem, const RouteVehicle& vehicle) {
  std::vector<Hazard> circles = closed_circles(problem);
  for (Hazard& circle : circles) circle.radius_m -= kRounding_m;
  const double last_m = problem.rules.last_leg_m;
  const Vec2 entry = problem.site - last_m * unit_vector(vehicle.approach_heading_rad);
  const CorridorEnds ends{.start = vehicle.start, .goal = entry};
  const std::vector<Corridor> found = shortest_corridors(ends, discs_of(circles), 1);
  if (found.empty()) return kInfinity;
  return std::max(found.front().length_m + last_m, climb_length_m(problem, vehicle));
}

double climb_length_m(const RouteProblem& problem, const RouteVehicle& vehicle) {
  const double rise = std::abs(vehicle.arrival_height_m - vehicle.start_height_m);
  return rise > 0.0 ? rise / vehicle.climb_max + problem.rules.last_leg_m : 0.0;
}

std::vector<BaseRoute> base_routes(const RouteProblem& problem, const RouteVehicle& vehicle,
                                   std::size_t corridors) {
  const std::vector<Hazard> circles = closed_circles(problem);
  const std::vector<Disc> discs = discs_of(circles);
  std::vector<BaseRoute> routes;
  for (const double factor : kLastLegs) {
    const double last_m = factor * problem.rules.last_leg_m + kRounding_m;
    const CorridorEnds ends{
        .start = vehicle.start,
        .start_heading_rad = vehicle.start_heading_rad,
        .start_cone_rad = vehicle.start_cone_rad,
        .goal = problem.site - last_m * unit_vector(vehicle.approach_heading_rad),
        .goal_heading_rad = vehicle.approach_heading_rad,
        .turn_radius_m = vehicle.turn_radius_m};
    const bool blocked = std::any_of(discs.begin(), discs.end(), [&](const Disc& disc) {
      return distance_to_piece(disc.centre,
                               {ends.goal.x(), ends.goal.y(), vehicle.approach_heading_rad}, 0.0,
                               last_m) < disc.radius_m;
    });
    if (blocked) break;
    for (const Corridor& corridor :
         shortest_corridors(ends, discs, corridors, vehicle.range_m - last_m)) {
      auto route = cornered(problem, vehicle, corridor, circles);
      if (route && route->length_m <= vehicle.range_m) routes.push_back(std::move(*route));
    }
  }
  std::stable_sort(routes.begin(), routes.end(),
                   [](const BaseRoute& a, const BaseRoute& b) { return a.length_m < b.length_m; });
  return routes;
}

TimedRoute::TimedRoute(const Path& path, const RouteVehicle& vehicle, const RouteRules& rules)
    : speed_mps_{vehicle.speed_mps},
      start_height_m_{vehicle.start_height_m},
      arrival_height_m_{vehicle.arrival_height_m},
      level_s_{(path.length_m() - rules.last_leg_m) / vehicle.speed_mps},
      climb_mps_{(arrival_height_m_ - start_height_m_) / std::max(level_s_, 1e-9)} {
  Pose2 pose = path.start;
  double flown = 0.0;
  for (const Segment& segment : path.segments) {
    poses_.push_back(pose);
    curvatures_.push_back(segment.curvature_per_m);
    times_s_.push_back(flown / speed_mps_);
    pose = advance(pose, segment.curvature_per_m, segment.length_m);
    flown += segment.length_m;
  }
  times_s_.push_back(flown / speed_mps_);
}

Vec2 TimedRoute::at(double t, std::size_t& piece) const {
  while (piece + 1 < poses_.size() && times_s_[piece + 1] <= t) ++piece;
  const Pose2& pose = poses_[piece];
  const double distance = speed_mps_ * (std::min(t, end_s()) - times_s_[piece]);
  if (curvatures_[piece] == 0.0) return pose.position() + distance * unit_vector(pose.heading_rad);
  return advance(pose, curvatures_[piece], distance).position();
}

double separation_deficit_m(const TimedRoute& a, const TimedRoute& b, const RouteRules& rules) {
  const double separation_m = rules.separation_m;
  if (separation_m <= 0.0) return 0.0;
  double until = std::min(a.end_s(), b.end_s());
  const double faster = std::max(a.speed_mps(), b.speed_mps());
  if (std::abs(a.end_s() - b.end_s()) * faster < separation_m) {
    until = std::min(until, std::max(a.last_leg_s(), b.last_leg_s()));
  }
  // No distance is lost faster than both speeds allow: nothing can happen before the next look.
  const double closing = a.speed_mps() + b.speed_mps();
  const double step_min = 1e-3 * separation_m / closing;
  const double rising = std::abs(a.climb_mps()) + std::abs(b.climb_mps());
  double least = kInfinity;
  std::size_t piece_a = 0;
  std::size_t piece_b = 0;
  double t = 0.0;
  while (true) {
    const double distance = (a.at(t, piece_a) - b.at(t, piece_b)).norm();
    const double above = std::abs(a.height_m(t) - b.height_m(t)) - rules.separation_height_m;
    if (above < 0.0) least = std::min(least, distance);
    if (t >= until) break;
    const double spare = distance - separation_m;
    // Once too near, how much nearer they come need not be exact.
    double step = (spare > 0.0 ? spare : separation_m) / closing;
    if (above > 0.0) step = rising > 0.0 ? std::max(step, above / rising) : until;
    t = std::min(until, t + std::max(step, step_min));
  }
  // What a shortest step may have hidden.
  return std::max(0.0, separation_m + 1e-3 * separation_m - least);
}

double spacing_cost(const TimedRoute& a, const TimedRoute& b, const RouteRules& rules) {
  const double separation_m = rules.separation_m;
  if (separation_m <= 0.0) return 0.0;
  const double until = std::min(a.end_s(), b.end_s());
  double sum = 0.0;
  std::size_t piece_a = 0;
  std::size_t piece_b = 0;
  for (std::size_t k = 0; k < kSpacingSamples; ++k) {
    const double t = until * static_cast<double>(k) / static_cast<double>(kSpacingSamples);
    const double d = (a.at(t, piece_a) - b.at(t, piece_b)).norm();
    sum += 0.5 * (1.0 - std::tanh((d - separation_m) / separation_m));
    if (rules.contact_m < kInfinity) {
      sum += 0.5 * (1.0 + std::tanh((d - rules.contact_m) / separation_m));
    }
  }
  return sum / static_cast<double>(kSpacingSamples);
}

RouteCosts route_costs(const RouteProblem& problem, std::span<const Vec2> waypoints,
                       const Path& path) {
  RouteCosts costs;
  const double length = path.length_m();
  std::vector<const RouteHazard*> open;
  for (const RouteHazard& hazard : problem.hazards) {
    if (!problem.closed(hazard)) open.push_back(&hazard);
  }
  if (!open.empty()) {
    Pose2 at = path.start;
    double passed = 0.0;
    std::size_t next = 0;
    for (const Segment& piece : path.segments) {
      for (; next < kExposureSamples; ++next) {
        const double here =
            length * (static_cast<double>(next) + 0.5) / static_cast<double>(kExposureSamples);
        if (here > passed + piece.length_m) break;
        const Vec2 point = advance(at, piece.curvature_per_m, here - passed).position();
        for (const RouteHazard* hazard : open) costs.exposure += hazard->value_at(point);
      }
      at = advance(at, piece.curvature_per_m, piece.length_m);
      passed += piece.length_m;
    }
    costs.exposure /= static_cast<double>(kExposureSamples);
  }
  const double straight = (waypoints.back() - waypoints.front()).norm();
  costs.length_ratio = straight > 0.0 ? length / straight : 1.0;
  double before = 0.0;
  for (std::size_t i = 1; i + 1 < waypoints.size(); ++i) {
    const double turn = turn_at(waypoints[i - 1], waypoints[i], waypoints[i + 1]);
    if (i > 1) costs.turning += std::abs(turn - before);
    before = turn;
  }
  if (waypoints.size() > 3) costs.turning /= static_cast<double>(waypoints.size() - 3);
  costs.total = problem.weights.exposure * costs.exposure +
                problem.weights.length * costs.length_ratio +
                problem.weights.turning * costs.turning;
  return costs;
}

double RouteJudge::rules_broken(std::span<const Vec2> waypoints) const {
  const double radius = vehicle_.turn_radius_m;
  const double scale = std::max(radius, 1e-3 * problem_.rules.last_leg_m);
  double broken = std::max(0.0, -turns_fit_m(waypoints, radius) - kRounding_m) / scale;
  double last_turn = 0.0;
  for (std::size_t i = 1; i + 1 < waypoints.size(); ++i) {
    last_turn = turn_at(waypoints[i - 1], waypoints[i], waypoints[i + 1]);
    broken += std::max(0.0, std::abs(last_turn) - problem_.rules.turn_max_rad - 1e-9);
  }
  const std::size_t n = waypoints.size();
  const double last =
      (waypoints[n - 1] - waypoints[n - 2]).norm() - turn_reach_m(radius, last_turn);
  broken += std::max(0.0, problem_.rules.last_leg_m - last) / scale;
  const Vec2 first = waypoints[1] - waypoints[0];
  const double off =
      std::abs(wrap_pi(std::atan2(first.y(), first.x()) - vehicle_.start_heading_rad));
  broken += std::max(0.0, off - vehicle_.start_cone_rad - 1e-9);
  return broken;
}

double RouteJudge::hazards_entered(std::span<const Vec2> waypoints,
                                   std::span<const char> fresh) const {
  const double radius = vehicle_.turn_radius_m;
  double entered = 0.0;
  const auto look = [&](const Pose2& from, double curvature, double length) {
    const Vec2 middle = from.position();
    for (const Hazard& circle : circles_) {
      if ((middle - circle.centre).norm() > circle.radius_m + length) continue;
      const double distance = distance_to_piece(circle.centre, from, curvature, length);
      if (distance < circle.radius_m - 0.5 * kRounding_m) {
        entered += (circle.radius_m - distance) / circle.radius_m;
      }
    }
  };
  double before = 0.0;
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    const bool inner = i + 1 < waypoints.size();
    const Vec2 leg = waypoints[i] - waypoints[i - 1];
    const double length = leg.norm();
    const double turn = inner ? turn_at(waypoints[i - 1], waypoints[i], waypoints[i + 1]) : 0.0;
    const double reach = turn_reach_m(radius, turn);
    const bool new_leg = fresh[i - 1] != 0 || fresh[i] != 0;
    const double heading = std::atan2(leg.y(), leg.x());
    const Vec2 direction = leg / length;
    if (new_leg) {
      const Vec2 from = waypoints[i - 1] + before * direction;
      look({from.x(), from.y(), heading}, 0.0, std::max(0.0, length - before - reach));
    }
    if (inner && turn != 0.0 && radius > 0.0 && (new_leg || fresh[i + 1] != 0)) {
      const Vec2 from = waypoints[i] - reach * direction;
      look({from.x(), from.y(), heading}, std::copysign(1.0 / radius, turn),
           radius * std::abs(turn));
    }
    before = reach;
  }
  return entered;
}

double RouteJudge::judge(std::span<const Vec2> waypoints, std::span<const char> fresh) const {
  const double broken = rules_broken(waypoints) + hazards_entered(waypoints, fresh);
  // Such a route may not even be a path: routes of others come last.
  if (broken > 0.0) return kUnflyable * (1.0 + broken);
  const auto path = fly_by_path(waypoints, vehicle_.turn_radius_m);
  if (!path) return kUnflyable;
  const TimedRoute timed{*path, vehicle_, problem_.rules};
  double deficit = 0.0;
  double spacing = 0.0;
  for (const TimedRoute& other : others_) {
    deficit += separation_deficit_m(timed, other, problem_.rules);
    if (deficit > 0.0) continue;
    spacing += spacing_cost(timed, other, problem_.rules);
  }
  if (deficit > 0.0) return kInfeasible * (1.0 + deficit / (deficit + problem_.rules.separation_m));
  return route_costs(problem_, waypoints, *path).total + problem_.spacing_weight * spacing;
}

}  // namespace skein::routes
