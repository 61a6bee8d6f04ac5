// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "skein/routes/route_problem.hpp"

namespace skein::routes {

/// How exactly a plan must keep to its rules.
struct CheckTolerances {
  double distance_m = 1e-3;  ///< lengths, clearances, separation, position of the ends
  double angle_rad = radians(0.1);
  double arrival_s = 0.01;  ///< of one vehicle against its time, and so of all against each other
};

/// One rule that is broken, as a sentence.
struct Violation {
  VehicleId vehicle{};
  std::string message{};
};

/// What was found of one route.
struct RouteMeasures {
  VehicleId id{};
  double length_m = 0.0;         ///< of the lines and arcs that are flown
  double arrival_error_s = 0.0;  ///< against the common time and the offset
  double bearing_error_rad = 0.0;
  double last_straight_m = 0.0;
  double start_angle_rad = 0.0;   ///< of the first leg to the start heading
  double turn_largest_rad = 0.0;  ///< at one waypoint
  double turn_room_m = 0.0;  ///< least straight line left between two arcs, or before and after
  double climb = 0.0;        ///< height over distance until the last leg
  double clearance_m = 0.0;  ///< least distance to the edge of a closed hazard
};

struct CheckReport {
  std::vector<Violation> violations{};
  std::vector<RouteMeasures> routes{};
  double separation_m = 0.0;  ///< least distance of two vehicles where it counts; infinite for one
  double separation_at_s = 0.0;
  double arrival_spread_s = 0.0;  ///< largest difference of arrival errors

  [[nodiscard]] bool ok() const { return violations.empty(); }
};

/// Checks every rule of the problem by geometry of its own: it shares no code with the planner, and
/// takes nothing from the plan but the waypoints and the common time. Distances to hazards are
/// exact; separation is in continuous time, by bisection with the vehicles' speeds as bounds.
[[nodiscard]] CheckReport check_routes(const RouteProblem& problem, const CooperativePlan& plan,
                                       const CheckTolerances& tolerances = {});

}  // namespace skein::routes
