// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/configuration/routes_config.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/routes/cooperative.hpp"
#include "skein/routes/route_check.hpp"

/// Cooperative routes of a mission file: planned, judged, written (docs/routes.md).
namespace skein::groundstation {

struct PlannedRoutes {
  routes::RouteProblem problem;
  routes::CooperativePlan plan;
  routes::CheckReport check;
  configuration::RoutePlan file;
};

/// Plans the scenario's routes with its seed, and checks them by code apart from the planner. Fails
/// with a sentence where there are none to plan or none can be found. A plan that breaks a rule is
/// given with its violations.
[[nodiscard]] Result<PlannedRoutes> plan_routes(const configuration::Scenario& scenario,
                                                const routes::RoutePlannerParams& params = {});

/// What a person reads: lengths against their bounds, costs, and what was checked.
[[nodiscard]] std::string routes_text(const PlannedRoutes& planned);

/// The plan as others read it. Heights are the vehicles' layers above the origin.
[[nodiscard]] std::string routes_geojson(const PlannedRoutes& planned,
                                         const configuration::Scenario& scenario,
                                         const MissionOrigin& origin);
[[nodiscard]] std::string routes_kml(const PlannedRoutes& planned,
                                     const configuration::Scenario& scenario,
                                     const MissionOrigin& origin);
/// One vehicle's route for QGroundControl: waypoints with altitudes relative to the origin, and the
/// ground speed. Nothing else: no payload commands.
[[nodiscard]] std::string routes_qgc(const configuration::VehicleRoute& route,
                                     const configuration::Scenario& scenario,
                                     const MissionOrigin& origin);
[[nodiscard]] std::string routes_svg(const PlannedRoutes& planned);

/// Writes plan.yaml, routes.geojson, routes.kml, routes.svg and vehicle-N.plan into the folder,
/// which is made. Gives their names. Fails with the file that cannot be written.
[[nodiscard]] Result<std::vector<std::string>> write_routes(const PlannedRoutes& planned,
                                                            const configuration::Scenario& scenario,
                                                            const std::filesystem::path& folder);

}  // namespace skein::groundstation
