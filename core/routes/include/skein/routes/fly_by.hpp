// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "skein/base/result.hpp"
#include "skein/domain/path.hpp"

namespace skein::routes {

/// The most waypoints of a route, start and site included: its path must fit into a skein::Path.
inline constexpr std::size_t kWaypointsMax = 32;

/// The turn at b of the way a, b, c: radians, counter-clockwise positive, in (-pi, pi]. 0 where a
/// leg has no length.
[[nodiscard]] double turn_at(const Vec2& a, const Vec2& b, const Vec2& c);

/// What an inscribed arc saves against the corner (Wu 2022, eq. 1): 2 R tan(|turn| / 2) - R |turn|,
/// metres. Infinite for a turn of pi.
[[nodiscard]] double turn_saving_m(double radius_m, double turn_rad);
/// How far from the waypoint its arc begins and ends: R tan(|turn| / 2).
[[nodiscard]] double turn_reach_m(double radius_m, double turn_rad);

/// Length of straight legs joined by inscribed arcs of that radius (eq. 1), metres. Only of meaning
/// where the turns fit (`turns_fit_m` >= 0).
[[nodiscard]] double fly_by_length_m(std::span<const Vec2> waypoints, double radius_m);

/// The least straight line left between two successive arcs, metres; negative where arcs overlap.
/// Infinite with fewer than two waypoints.
[[nodiscard]] double turns_fit_m(std::span<const Vec2> waypoints, double radius_m);

/// The route as lines and arcs. Fails, with the waypoint, where two successive arcs do not fit into
/// their leg, where waypoints coincide, and for fewer than 2 or more than kWaypointsMax waypoints.
[[nodiscard]] Result<Path> fly_by_path(std::span<const Vec2> waypoints, double radius_m);

}  // namespace skein::routes
