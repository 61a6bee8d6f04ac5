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

/// The plan as others read it. A vehicle flies at its layer's height above the mission's origin,
/// which the files say each in its own frame.

/// WGS84, as RFC 7946 has it: routes with heights above the ellipsoid, and as a property above the
/// origin; hazards and site without.
[[nodiscard]] std::string routes_geojson(const PlannedRoutes& planned,
                                         const configuration::Scenario& scenario,
                                         const MissionOrigin& origin);
/// Heights above sea level (altitudeMode absolute): of a geoid that lies above the ellipsoid by
/// what the vehicle's flight controller is configured for (geoid_height_m; 0 where that is not, and
/// heights are above the ellipsoid).
[[nodiscard]] std::string routes_kml(const PlannedRoutes& planned,
                                     const configuration::Scenario& scenario,
                                     const MissionOrigin& origin);
/// One vehicle's route for QGroundControl: waypoints and the ground speed. Nothing else: no payload
/// commands. Altitudes are above home (MAV_FRAME_GLOBAL_RELATIVE_ALT), which needs no geoid; the
/// planned home is the mission's origin, its altitude above sea level as in routes_kml(). An
/// autopilot counts from where it was armed: at another height than the origin's, the route is
/// flown too high or too low by the difference.
[[nodiscard]] std::string routes_qgc(const configuration::VehicleRoute& route,
                                     const configuration::Scenario& scenario,
                                     const MissionOrigin& origin);
[[nodiscard]] std::string routes_svg(const PlannedRoutes& planned);

/// Writes plan.yaml, routes.geojson, routes.kml, routes.svg and vehicle-N.plan into the folder,
/// which is made; a vehicle-N.plan of a vehicle that has no route now is deleted. Gives their
/// names. Fails with the file that cannot be written.
[[nodiscard]] Result<std::vector<std::string>> write_routes(const PlannedRoutes& planned,
                                                            const configuration::Scenario& scenario,
                                                            const std::filesystem::path& folder);

}  // namespace skein::groundstation
