// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "skein/configuration/routes_config.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/planning/fence_check.hpp"
#include "skein/routes/fly_by.hpp"
#include "skein/routes/route_check.hpp"

namespace skein::configuration {
namespace {

/// What the way home from the site may be longer than straight.
constexpr double kWayHome = 1.5;
constexpr double kSlack = 1e-9;  // of a radius that was written and read
constexpr double kSameSite_m = 1e-3;
constexpr double kStep_m = 1.0;  // along a route, of what is looked at

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
HazardId free_id(const std::vector<TimedHazard>& hazards) {
  const auto taken = [&hazards](HazardId id) {
    return std::any_of(hazards.begin(), hazards.end(),
                       [id](const TimedHazard& known) { return known.hazard.id == id; });
  };
  HazardId id{1};  // of the 65,535 there are, a mission file takes a few hundred
  while (taken(id)) ++id.value;
  return id;
}

}  // namespace

Result<std::optional<TimedPath>> timed_path(const FlightRoute& route, const VehicleSpec& vehicle) {
  if (route.waypoints.empty()) return std::optional<TimedPath>{};
  if (route.turn_radius_m < vehicle.planning_radius_m() * (1.0 - kSlack)) {
    return Error{"its arcs of " + std::to_string(route.turn_radius_m) +
                 " m are tighter than paths of the vehicle are planned, " +
                 std::to_string(vehicle.planning_radius_m()) + " m; plan it anew"};
  }
  if (route.speed_mps < vehicle.speed_min_mps || route.speed_mps > vehicle.speed_max_mps) {
    return Error{"its speed of " + std::to_string(route.speed_mps) +
                 " m/s is none that the vehicle flies; plan it anew"};
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
  for (const Hazard& known : hazards_known_at(scenario.hazards, Instant{})) {
    problem.hazards.push_back({.id = known.id,
                               .kind = routes::HazardKind::keep_out,
                               .centre = known.centre,
                               .radius_m = known.radius_m});
  }
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

namespace {

/// Beyond the site: the way on, and a lap of the hold.
Result<void> judge_way_on(const TimedPath& timed, const routes::RouteProblem& problem,
                          const std::string& who) {
  const double length_m = timed.path.length_m();
  const double lap_m = kTwoPi / timed.tail_curvature_per_m;
  const auto steps = static_cast<std::size_t>((length_m + lap_m) / kStep_m);
  for (std::size_t k = 0; k <= steps; ++k) {
    const double at_m = kStep_m * static_cast<double>(k);
    const Vec2 point = timed.pose_at_distance(at_m).position();
    for (const routes::RouteHazard& hazard : problem.hazards) {
      if (!problem.closed(hazard)) continue;
      if ((point - hazard.centre).norm() >= hazard.radius_m) continue;
      return Error{"the route of " + who + " enters hazard " + std::to_string(hazard.id.value) +
                   (at_m > length_m ? " where it circles beyond the site" : "") +
                   "; plan it anew, or leave more room"};
    }
  }
  return {};
}

/// By the mission as it is now, whatever it was when the plan was made.
Result<void> judge(const RoutePlan& plan, const routes::RouteProblem& problem,
                   const Scenario& scenario) {
  if ((plan.site - problem.site).norm() > kSameSite_m) {
    return Error{"the plan is for another site; plan it anew"};
  }
  routes::CooperativePlan flown;
  flown.arrival_s = plan.arrival_s;
  for (const VehicleRoute& planned : plan.routes) {
    const auto found = vehicle_of(scenario.vehicles, planned.vehicle);
    if (found == scenario.vehicles.end()) {
      return Error{name_of(planned.vehicle) + " has a route, and is not in the mission"};
    }
    const auto timed = timed_path(planned.route, found->spec);
    if (!timed || !*timed) {
      return Error{"the route of " + name_of(planned.vehicle) + ": " +
                   (timed ? "it has no waypoints" : timed.error().message)};
    }
    if (auto clear = judge_way_on(**timed, problem, name_of(planned.vehicle)); !clear) return clear;
  }
  for (const routes::RouteVehicle& vehicle : problem.vehicles) {
    const auto planned =
        std::find_if(plan.routes.begin(), plan.routes.end(),
                     [&vehicle](const VehicleRoute& r) { return r.vehicle == vehicle.id; });
    if (planned == plan.routes.end()) {
      return Error{"the plan has no route for " + name_of(vehicle.id) + "; plan it anew"};
    }
    if (planned->route.speed_mps != vehicle.speed_mps) {
      return Error{"the route of " + name_of(vehicle.id) +
                   " is not for its cruise speed; plan it anew"};
    }
    routes::PlannedRoute route;
    route.id = vehicle.id;
    route.waypoints = planned->route.waypoints;
    route.length_m = planned->length_m;
    route.arrival_s = planned->arrival_s;
    flown.routes.push_back(std::move(route));
  }
  auto report = routes::check_routes(problem, flown);
  for (auto& out : outside_fence(plan, scenario)) report.violations.push_back(std::move(out));
  if (report.ok()) return {};
  return Error{"the plan breaks a rule of the mission: " + name_of(report.violations[0].vehicle) +
               ": " + report.violations[0].message + "; plan it anew"};
}

}  // namespace

std::vector<routes::Violation> outside_fence(const RoutePlan& plan, const Scenario& scenario) {
  std::vector<routes::Violation> violations;
  for (const VehicleRoute& planned : plan.routes) {
    const auto vehicle = vehicle_of(scenario.vehicles, planned.vehicle);
    if (vehicle == scenario.vehicles.end()) continue;
    const auto timed = timed_path(planned.route, vehicle->spec);
    if (!timed || !*timed) continue;
    if (const auto out = planning::first_outside(scenario.fence, **timed)) {
      violations.push_back(
          {planned.vehicle, "leads out of the fence at " + planning::place_text(*out)});
    }
  }
  return violations;
}

Result<void> give_routes(const RoutePlan& plan, Scenario& scenario) {
  const routes::RouteProblem problem = route_problem(scenario);
  if (auto judged = judge(plan, problem, scenario); !judged) return judged;
  for (const VehicleRoute& planned : plan.routes) {
    const auto found = vehicle_of(scenario.vehicles, planned.vehicle);
    const Vec2 begin = planned.route.waypoints[0];
    const Vec2 leg = planned.route.waypoints[1] - begin;
    found->route = planned.route;
    found->start = {begin.x(), begin.y(), std::atan2(leg.y(), leg.x())};
  }
  for (const routes::RouteHazard& hazard : scenario.routes.hazards) {
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
    ends.push_back({approach.vehicle, approach.heading_rad, at_seconds(length_m / route.speed_mps),
                    from_seconds(approach.offset_s)});
  }
  return ends;
}

}  // namespace skein::configuration
