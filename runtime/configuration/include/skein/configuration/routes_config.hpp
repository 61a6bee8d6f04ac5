// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/base/geometry.hpp"
#include "skein/base/ids.hpp"
#include "skein/base/result.hpp"
#include "skein/domain/path.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/routes/route_check.hpp"
#include "skein/routes/route_problem.hpp"

namespace skein::configuration {

struct Scenario;

/// A route that a vehicle is given before the mission: straight legs with fly-by arcs of the turn
/// radius, from mission time 0 on at one ground speed. Without waypoints there is none.
struct FlightRoute {
  std::vector<Vec2> waypoints;  ///< start and site included
  double turn_radius_m = 0.0;
  double speed_mps = 0.0;  ///< over the ground
};

/// As a path from mission time 0 on, which goes straight on beyond the site and then circles; none
/// without waypoints. Fails where the arcs do not fit into the legs, or are tighter than the
/// vehicle's turn radius.
[[nodiscard]] Result<std::optional<TimedPath>> timed_path(const FlightRoute& route,
                                                          const VehicleSpec& vehicle);

/// How one vehicle passes over the site of planned routes.
struct RouteApproach {
  VehicleId vehicle;
  double heading_rad = 0.0;     ///< direction of travel over the site
  double offset_s = 0.0;        ///< so much after the common time
  double start_cone_rad = kPi;  ///< of the first leg, to either side of the start's heading
};

/// Cooperative routes, to be planned before the mission (docs/routes.md).
struct RoutesConfig {
  Vec2 site{0.0, 0.0};
  std::vector<RouteApproach> approaches;  ///< none: no routes are planned
  std::vector<routes::RouteHazard> hazards;
  routes::RouteRules rules{.last_leg_m = 100.0, .separation_m = 30.0};
  routes::CostWeights weights;
};

/// One vehicle's part of a plan.
struct VehicleRoute {
  VehicleId vehicle;
  FlightRoute route;
  double heading_rad = 0.0;  ///< direction of travel over the site
  double arrival_s = 0.0;    ///< mission time over the site
  double length_m = 0.0;
  double bound_m = 0.0;  ///< no route is shorter that keeps to the rules
};

/// A plan of cooperative routes, as a file.
struct RoutePlan {
  std::string title;
  std::uint64_t seed = 1;
  Vec2 site{0.0, 0.0};
  double arrival_s = 0.0;  ///< the common time
  double bound_s = 0.0;    ///< no plan has an earlier one
  std::vector<VehicleRoute> routes;
};

/// What plan_routes is asked, of the scenario's vehicles and their approaches.
[[nodiscard]] routes::RouteProblem route_problem(const Scenario& scenario);
/// Gives the vehicles their routes and where these begin their starts' headings; and what no route
/// may enter to all as hazards. Fails for a plan that breaks a rule of the scenario as it is now,
/// or leads into a hazard beyond the site, and for vehicles that have no route or cannot fly it.
[[nodiscard]] Result<void> give_routes(const RoutePlan& plan, Scenario& scenario);

/// What of the plan leads out of the scenario's fence, the way on beyond the site and a lap of the
/// hold included: of each vehicle the first.
[[nodiscard]] std::vector<routes::Violation> outside_fence(const RoutePlan& plan,
                                                           const Scenario& scenario);

/// When and how the vehicles that were given routes are to pass over the site.
struct RouteEnd {
  VehicleId vehicle;
  double heading_rad = 0.0;
  Instant planned{};
  Duration offset{};  ///< of it from the common time
};
[[nodiscard]] std::vector<RouteEnd> route_ends(const Scenario& scenario);

/// Fails with one line for every mistake in the file: "file:line: key: what is wrong; what to do".
[[nodiscard]] Result<RoutePlan> load_route_plan(const std::filesystem::path& file);
/// As above, from text; `name` stands for the file in messages.
[[nodiscard]] Result<RoutePlan> parse_route_plan(std::string_view yaml, const std::string& name);
/// What load_route_plan reads back as the same struct.
[[nodiscard]] std::string to_yaml(const RoutePlan& plan);

}  // namespace skein::configuration
