// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/base/geometry.hpp"
#include "skein/base/ids.hpp"
#include "skein/routes/curve.hpp"
#include "skein/routes/hazards.hpp"

namespace skein::routes {

/// One vehicle of a mission whose routes are planned together. All depart at time 0.
struct RouteVehicle {
  VehicleId id{};
  Vec2 start{0.0, 0.0};
  double start_heading_rad = 0.0;
  /// The first leg lies within this angle to either side of the start heading (Wu 2022, eq. 6);
  /// pi: any direction.
  double start_cone_rad = kPi;
  double speed_mps = 0.0;      ///< constant, over the ground; > 0
  double turn_radius_m = 0.0;  ///< of every fly-by turn; > 0, small for one that turns on the spot
  double range_m = std::numeric_limits<double>::infinity();
  /// Direction of travel over the site, mathematical. The paper's approach angle is that of the
  /// point of entry as seen from the site: pi more.
  double approach_heading_rad = 0.0;
  double arrival_offset_s = 0.0;  ///< arrives so much after the common time (sequential arrival)
  /// Heights above the mission's origin. It climbs or descends evenly from the start until the last
  /// leg (RouteRules::last_leg_m) is left, which it flies level.
  double start_height_m = 0.0;
  double arrival_height_m = 0.0;
  /// The steepest climb or descent, metres of height over metres flown over the ground.
  double climb_max = std::numeric_limits<double>::infinity();
};

/// What every route must keep to.
struct RouteRules {
  /// Straight run into the site on the approach heading (eq. 7): all that is left after the last
  /// turn's arc. > 0.
  double last_leg_m = 0.0;
  double turn_max_rad = radians(120.0);  ///< at one waypoint; < pi
  std::size_t waypoints_max = 24;        ///< start and site included; at most kWaypointsMax
  /// d_s, between vehicles at every time while both are under way (eq. 10); 0: not asked for.
  /// Vehicles that reach the site less than d_s apart cannot keep it there: between two such, it
  /// ends as soon as both are on their last straight legs.
  double separation_m = 0.0;
  /// Vehicles that are so far apart in height need no separation.
  double separation_height_m = std::numeric_limits<double>::infinity();
  double contact_m = std::numeric_limits<double>::infinity();  ///< d_c, wished for (eq. 35)
  double clearance_m = 0.0;       ///< beyond the radius of a hazard that is closed
  bool detections_closed = true;  ///< else they only cost; keep-outs are always closed
  bool ramps_closed = true;
};

/// Cooperative routes over one site.
struct RouteProblem {
  std::vector<RouteVehicle> vehicles{};
  Vec2 site{0.0, 0.0};
  std::vector<RouteHazard> hazards{};
  RouteRules rules{};
  CostWeights weights{};
  double spacing_weight = 1.0;  ///< of the spacing cost (eq. 35, 36) against eq. 26

  [[nodiscard]] bool closed(const RouteHazard& hazard) const {
    switch (hazard.kind) {
      case HazardKind::detection:
        return rules.detections_closed;
      case HazardKind::ramp:
        return rules.ramps_closed;
      default:
        return true;
    }
  }
};

/// The route of one vehicle: straight legs, and fly-by arcs of its turn radius at the waypoints
/// between.
struct PlannedRoute {
  VehicleId id{};
  std::vector<Vec2> waypoints{};  ///< start and site included
  double length_m = 0.0;          ///< eq. 1
  double arrival_s = 0.0;         ///< length over speed
  /// No route that keeps clear of the closed hazards, with the last leg, the approach heading, the
  /// start cone and the climb, is shorter. Turns count at its ends, where no hazard is within two
  /// turn radii; between, it may turn as tightly as the hazards allow.
  double bound_m = 0.0;
  double climb = 0.0;  ///< height over distance until the last leg; negative: descends
  RouteCosts costs{};  ///< exposure over equal distances flown
};

/// Routes of all vehicles, in the order of the problem.
struct CooperativePlan {
  std::vector<PlannedRoute> routes{};
  double arrival_s = 0.0;  ///< the common time, to which offsets are added
  double bound_s = 0.0;    ///< no plan has an earlier one
  double latest_s = 0.0;   ///< nor, by the ranges, a later one
  double spacing_cost = 0.0;
  double total_cost = 0.0;        ///< sum of the routes' costs and the weighted spacing (eq. 36)
  std::uint64_t evaluations = 0;  ///< routes that were tried
};

}  // namespace skein::routes
