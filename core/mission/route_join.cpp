// SPDX-License-Identifier: Apache-2.0
#include "route_join.hpp"

#include <cmath>

#include "skein/planning/arrival.hpp"

namespace skein::mission {
namespace {

constexpr double kNear_s = 10.0;  ///< of flight, from where the route has the vehicle
/// Points of the route that are tried lie so far ahead, and each half as far again as the one
/// before: who is late catches up by little.
constexpr Duration kFirstPoint = std::chrono::seconds{5};
constexpr Duration kLastPoint = std::chrono::seconds{120};
/// Of what lies between cruise speed and its limits: the rest is for wind.
constexpr double kSpeedShare = 0.7;

struct Approach {
  Path path;
  double speed_mps = 0.0;
};

/// From there to that pose in that time.
std::optional<Approach> approach(const RouteJoin& join, const Pose2& from, const Pose2& to,
                                 double seconds) {
  const VehicleSpec& vehicle = join.vehicle;
  const planning::Transit transit{from, to, vehicle.planning_radius_m(), join.range_m,
                                  join.hazards};
  const double even_m = join.route.speed_mps * seconds;
  if (const auto path = planning::path_of_length(join.avoidance, transit, even_m)) {
    return Approach{*path, join.route.speed_mps};
  }
  const double cruise = vehicle.cruise_speed_mps;
  const double slowest = cruise - kSpeedShare * (cruise - vehicle.speed_min_mps);
  const double fastest = cruise + kSpeedShare * (vehicle.speed_max_mps - cruise);
  const auto least =
      planning::least_length_from(join.avoidance, transit, std::max(slowest, 0.1) * seconds);
  if (!least || *least > fastest * seconds) return std::nullopt;
  const auto path = planning::path_of_length(join.avoidance, transit, *least);
  if (!path) return std::nullopt;
  return Approach{*path, path->length_m() / seconds};
}

std::optional<TimedPath> way_to(const RouteJoin& join, Instant at, Instant then, Instant now) {
  const TimedPath& flown = join.flown;
  const TimedPath& route = join.route;
  const double begin_m = route.distance_at(then);
  const auto before = flown.piece(flown.distance_at(now), flown.distance_at(at));
  const auto rest = route.piece(begin_m, route.path.length_m());
  if (!before || !rest) return std::nullopt;
  const auto way = approach(join, flown.pose_at(at), rest->start, to_seconds(then - at));
  if (!way) return std::nullopt;
  if (before->length_m() + way->path.length_m() + rest->length_m() > join.range_m) {
    return std::nullopt;
  }
  TimedPath timed;
  timed.start_time = now;
  timed.speed_mps = route.speed_mps;
  timed.tail_curvature_per_m = route.tail_curvature_per_m;
  timed.path.start = before->start;
  const double even_m = route.speed_mps * to_seconds(at - now);
  if (!timed.append(*before, before->length_m() / even_m) ||
      !timed.append(way->path, way->speed_mps / route.speed_mps) || !timed.append(*rest, 1.0)) {
    return std::nullopt;
  }
  timed.paces.push_back(1.0);
  return timed;
}

}  // namespace

std::optional<TimedPath> way_onto_route(const RouteJoin& join, Instant at, Instant now) {
  const TimedPath& route = join.route;
  if (route.start_time > at) return way_to(join, at, route.start_time, now);
  const Vec2 off = join.flown.pose_at(at).position() - route.pose_at(at).position();
  if (off.norm() > kNear_s * route.speed_mps) return std::nullopt;
  for (Duration ahead = kFirstPoint; ahead <= kLastPoint; ahead += ahead / 2) {
    if (at + ahead >= route.end_time()) break;
    if (auto way = way_to(join, at, at + ahead, now)) return way;
  }
  return std::nullopt;
}

}  // namespace skein::mission
