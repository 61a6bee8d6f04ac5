// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "skein/domain/hazard.hpp"
#include "skein/domain/path.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/planning/avoidance.hpp"

namespace skein::mission {

/// A vehicle that follows a plan is to fly a route: where, and what it may use for it.
struct RouteJoin {
  const TimedPath& flown;  ///< what it follows now
  const TimedPath& route;
  const VehicleSpec& vehicle;
  planning::AvoidanceParams avoidance;
  std::span<const Hazard> hazards;
  double range_m = 0.0;  ///< to the end of the route
};

/// The plan until `at`, then a way clear of hazards onto the route, then the route, always on time:
/// to its beginning where that is later than `at`; else, where the vehicle is within ten seconds'
/// flight of where the route has it, to as early a point of it as can be reached. The way is flown
/// at the route's speed where it can be of that length, else at another that the vehicle flies.
/// None where there is no such way, or it has too many pieces. Some milliseconds among hazards.
[[nodiscard]] std::optional<TimedPath> way_onto_route(const RouteJoin& join, Instant at,
                                                      Instant now);

}  // namespace skein::mission
