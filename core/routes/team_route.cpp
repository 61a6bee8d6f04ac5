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

/// No way to the entry is shorter that turns onto the approach heading, and with `with_start` from
/// its start heading's cone, no tighter than the vehicle does; 0 where that is not known.
///
/// What lies outside of both turning circles of a pose is reached from it soonest by an arc and a
/// line (Dubins 1957; Bui, Boissonnat, Soueres, Laumond 1994). So of a way through any point two
/// radii away from the pose, neither part is shorter than the parts of the taut way are: where
/// there are no hazards within these two radii. Those that are there are left out, which makes the
/// bound no larger.
double turning_way_m(const RouteVehicle& vehicle, const Vec2& entry, std::vector<Hazard> circles,
                     bool with_start) {
  const double near_m = 2.0 * vehicle.turn_radius_m;
  if (with_start && vehicle.start_cone_rad >= kPi) return 0.0;
  if ((entry - vehicle.start).norm() <= (with_start ? 2.0 : 1.0) * near_m) return 0.0;
  std::erase_if(circles, [&](const Hazard& circle) {
    const double reach_m = circle.radius_m + near_m;
    return (circle.centre - entry).norm() < reach_m ||
           (with_start && (circle.centre - vehicle.start).norm() < reach_m);
  });
  const std::vector<Corridor> found =
      shortest_corridors({.start = vehicle.start,
                          .start_heading_rad = vehicle.start_heading_rad,
                          .start_cone_rad = with_start ? vehicle.start_cone_rad : kPi,
                          .goal = entry,
                          .goal_heading_rad = vehicle.approach_heading_rad,
                          .turn_radius_m = vehicle.turn_radius_m,
                          .turns_at_ends_only = true},
                         discs_of(circles), 1);
  return found.empty() ? 0.0 : found.front().length_m;
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
  const std::vector<Corridor> found =
      shortest_corridors({.start = vehicle.start, .goal = entry}, discs_of(circles), 1);
  if (found.empty()) return kInfinity;
  double way_m = found.front().length_m;
  for (const bool with_start : {false, true}) {
    way_m = std::max(way_m, turning_way_m(vehicle, entry, circles, with_start));
  }
  return std::max(way_m + last_m, climb_length_m(problem, vehicle));
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

TimedRoute::TimedRoute(const Path& path, const RouteVehicle& vehicle, const RouteRules& rules,
                       double step_s)
    : step_s_{step_s},
      speed_mps_{vehicle.speed_mps},
      start_height_m_{vehicle.start_height_m},
      arrival_height_m_{vehicle.arrival_height_m},
      level_s_{(path.length_m() - rules.last_leg_m) / vehicle.speed_mps},
      climb_mps_{(arrival_height_m_ - start_height_m_) / std::max(level_s_, 1e-9)} {
  Pose2 pose = path.start;
  double flown = 0.0;
  for (const Segment& segment : path.segments) {
    poses_.push_back(pose);
    directions_.push_back(unit_vector(pose.heading_rad));
    curvatures_.push_back(segment.curvature_per_m);
    times_s_.push_back(flown / speed_mps_);
    pose = advance(pose, segment.curvature_per_m, segment.length_m);
    flown += segment.length_m;
  }
  times_s_.push_back(flown / speed_mps_);
  const auto samples = static_cast<std::size_t>(std::ceil(end_s() / step_s));
  track_.reserve(samples);
  std::size_t piece = 0;
  for (std::size_t k = 0; k < samples; ++k) {
    track_.push_back(at(static_cast<double>(k) * step_s, piece));
  }
}

Vec2 TimedRoute::at(double t, std::size_t& piece) const {
  while (piece + 1 < poses_.size() && times_s_[piece + 1] <= t) ++piece;
  const Pose2& pose = poses_[piece];
  const double distance = speed_mps_ * (std::min(t, end_s()) - times_s_[piece]);
  if (curvatures_[piece] == 0.0) return pose.position() + distance * directions_[piece];
  return advance(pose, curvatures_[piece], distance).position();
}

namespace {

/// The least distance between two times, by conservative steps.
double least_distance_m(const TimedRoute& a, const TimedRoute& b, const RouteRules& rules,
                        double from_s, double until_s) {
  // No distance is lost faster than both speeds allow: nothing can happen before the next look.
  const double separation_m = rules.separation_m;
  const double closing = a.speed_mps() + b.speed_mps();
  const double step_min = 1e-3 * separation_m / closing;
  const double rising = std::abs(a.climb_mps()) + std::abs(b.climb_mps());
  double least = kInfinity;
  std::size_t piece_a = 0;
  std::size_t piece_b = 0;
  double t = from_s;
  while (true) {
    const double distance = (a.at(t, piece_a) - b.at(t, piece_b)).norm();
    const double above = std::abs(a.height_m(t) - b.height_m(t)) - rules.separation_height_m;
    if (above < 0.0) least = std::min(least, distance);
    if (t >= until_s) return least;
    const double spare = distance - separation_m;
    // Once too near, how much nearer they come need not be exact.
    double step = (spare > 0.0 ? spare : separation_m) / closing;
    if (above > 0.0) step = rising > 0.0 ? std::max(step, above / rising) : until_s - t;
    t = std::min(until_s, t + std::max(step, step_min));
  }
}

}  // namespace

double separation_deficit_m(const TimedRoute& a, const TimedRoute& b, const RouteRules& rules) {
  if (rules.separation_m <= 0.0) return 0.0;
  double until = std::min(a.end_s(), b.end_s());
  const double faster = std::max(a.speed_mps(), b.speed_mps());
  if (std::abs(a.end_s() - b.end_s()) * faster < rules.separation_m) {
    until = std::min(until, std::max(a.last_leg_s(), b.last_leg_s()));
  }
  // What a shortest step may hide is asked for beside the separation.
  const double asked_m = rules.separation_m + 1e-3 * rules.separation_m;
  const double lost_m = a.step_s() * (a.speed_mps() + b.speed_mps());
  const std::size_t samples = std::min(a.track().size(), b.track().size());
  double least = kInfinity;
  double here = (a.track()[0] - b.track()[0]).norm();
  for (std::size_t k = 0; k < samples; ++k) {
    const double from = static_cast<double>(k) * a.step_s();
    if (from > until) break;
    const bool last = k + 1 == samples;
    const double next = last ? here - lost_m : (a.track()[k + 1] - b.track()[k + 1]).norm();
    // Between two samples they cannot come nearer than this.
    if (0.5 * (here + next - lost_m) < asked_m) {
      const double to = last ? until : std::min(until, from + a.step_s());
      least = std::min(least, least_distance_m(a, b, rules, from, to));
    }
    here = next;
  }
  return std::max(0.0, asked_m - least);
}

double spacing_cost(const TimedRoute& a, const TimedRoute& b, const RouteRules& rules) {
  const double separation_m = rules.separation_m;
  if (separation_m <= 0.0) return 0.0;
  const std::size_t samples = std::min(a.track().size(), b.track().size());
  double sum = 0.0;
  // (1 - tanh x) / 2, which is nothing from there on.
  constexpr double kFar = 20.0;
  const auto below = [](double x) { return x > kFar ? 0.0 : 1.0 / (1.0 + std::exp(2.0 * x)); };
  for (std::size_t k = 0; k < samples; ++k) {
    const double d = (a.track()[k] - b.track()[k]).norm();
    sum += below((d - separation_m) / separation_m);
    if (rules.contact_m < kInfinity) sum += below((rules.contact_m - d) / separation_m);
  }
  return sum / static_cast<double>(samples);
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
  const TimedRoute timed{*path, vehicle_, problem_.rules, step_s_};
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
