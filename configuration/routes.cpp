// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "skein/configuration/routes_config.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/routes/fly_by.hpp"

namespace skein::configuration {
namespace {

/// What the way home from the site may be longer than straight.
constexpr double kWayHome = 1.5;
constexpr double kSlack = 1e-9;  // of a radius that was written and read

std::string name_of(VehicleId vehicle) { return "vehicle " + std::to_string(vehicle.value); }

template <class Vehicles>
auto vehicle_of(Vehicles& vehicles, VehicleId id) {
  return std::find_if(vehicles.begin(), vehicles.end(),
                      [id](const auto& vehicle) { return vehicle.spec.id == id; });
}

/// What the vehicle may fly to the site, so that it comes home where it has to.
double range_to_the_site(const ScenarioVehicle& vehicle, const Vec2& site) {
  if (vehicle.spec.recovery == Recovery::anywhere) return vehicle.spec.range_m;
  return vehicle.spec.range_m - kWayHome * (site - vehicle.start.position()).norm();
}

/// Hazards of routes have numbers of their own.
HazardId free_id(const std::vector<ScenarioHazard>& hazards) {
  std::uint16_t highest = 0;
  for (const ScenarioHazard& hazard : hazards) highest = std::max(highest, hazard.hazard.id.value);
  return {static_cast<std::uint16_t>(highest + 1)};
}

}  // namespace

Result<std::optional<TimedPath>> timed_path(const FlightRoute& route, const VehicleSpec& vehicle) {
  if (route.waypoints.empty()) return std::optional<TimedPath>{};
  if (route.turn_radius_m < vehicle.turn_radius_m * (1.0 - kSlack)) {
    return Error{"its arcs of " + std::to_string(route.turn_radius_m) +
                 " m are tighter than the vehicle turns"};
  }
  auto path = routes::fly_by_path(route.waypoints, route.turn_radius_m);
  if (!path) return path.error();
  TimedPath timed;
  timed.speed_mps = route.speed_mps;
  timed.tail_curvature_per_m = 1.0 / vehicle.planning_radius_m();
  timed.path = *path;
  // Over the site on its bearing, whatever it is late by.
  if (!timed.path.append(Segment{0.0, 2.0 * vehicle.planning_radius_m()})) {
    return Error{"it has too many waypoints"};
  }
  return std::optional{timed};
}

routes::RouteProblem route_problem(const Scenario& scenario) {
  const RoutesConfig& config = scenario.routes;
  routes::RouteProblem problem;
  problem.site = config.site;
  problem.hazards = config.hazards;
  problem.rules = config.rules;
  problem.weights = config.weights;
  for (const RouteApproach& approach : config.approaches) {
    const auto found = vehicle_of(scenario.vehicles, approach.vehicle);
    if (found == scenario.vehicles.end()) continue;  // check() says so
    problem.vehicles.push_back({.id = approach.vehicle,
                                .start = found->start.position(),
                                .start_heading_rad = found->start.heading_rad,
                                .start_cone_rad = approach.start_cone_rad,
                                .speed_mps = found->spec.cruise_speed_mps,
                                .turn_radius_m = found->spec.planning_radius_m(),
                                .range_m = range_to_the_site(*found, config.site),
                                .approach_heading_rad = approach.heading_rad,
                                .arrival_offset_s = approach.offset_s});
  }
  return problem;
}

Result<void> give_routes(const RoutePlan& plan, Scenario& scenario) {
  for (const VehicleRoute& planned : plan.routes) {
    const auto found = vehicle_of(scenario.vehicles, planned.vehicle);
    if (found == scenario.vehicles.end()) {
      return Error{name_of(planned.vehicle) + " has a route, and is not in the mission"};
    }
    if (const auto path = timed_path(planned.route, found->spec); !path) {
      return Error{"the route of " + name_of(planned.vehicle) + ": " + path.error().message};
    }
    if (planned.route.waypoints.size() < 2) {
      return Error{"the route of " + name_of(planned.vehicle) + " has no waypoints"};
    }
    const Vec2 begin = planned.route.waypoints[0];
    const Vec2 leg = planned.route.waypoints[1] - begin;
    found->route = planned.route;
    found->start = {begin.x(), begin.y(), std::atan2(leg.y(), leg.x())};
  }
  const routes::RouteProblem problem = route_problem(scenario);
  for (const routes::RouteHazard& hazard : problem.hazards) {
    if (!problem.closed(hazard)) continue;
    scenario.hazards.push_back(
        {{free_id(scenario.hazards), hazard.centre, hazard.radius_m}, Instant{}});
  }
  return {};
}

std::vector<RouteEnd> route_ends(const Scenario& scenario) {
  std::vector<RouteEnd> ends;
  for (const RouteApproach& approach : scenario.routes.approaches) {
    const auto found = vehicle_of(scenario.vehicles, approach.vehicle);
    if (found == scenario.vehicles.end() || found->route.waypoints.empty()) continue;
    const FlightRoute& route = found->route;
    const double length_m = routes::fly_by_length_m(route.waypoints, route.turn_radius_m);
    ends.push_back(
        {approach.vehicle, approach.heading_rad, at_seconds(length_m / route.speed_mps)});
  }
  return ends;
}

}  // namespace skein::configuration
