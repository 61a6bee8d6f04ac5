// SPDX-License-Identifier: Apache-2.0
#include "skein/routes/fly_by.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace skein::routes {
namespace {

/// Arcs may overlap by so much through rounding.
constexpr double kOverlap_m = 1e-6;

}  // namespace

double turn_at(const Vec2& a, const Vec2& b, const Vec2& c) {
  const Vec2 in = b - a;
  const Vec2 out = c - b;
  return std::atan2(cross(in, out), in.dot(out));
}

double turn_reach_m(double radius_m, double turn_rad) {
  return radius_m == 0.0 ? 0.0 : radius_m * std::tan(0.5 * std::abs(turn_rad));
}

double turn_saving_m(double radius_m, double turn_rad) {
  return 2.0 * turn_reach_m(radius_m, turn_rad) - radius_m * std::abs(turn_rad);
}

double fly_by_length_m(std::span<const Vec2> waypoints, double radius_m) {
  double length = 0.0;
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    length += (waypoints[i] - waypoints[i - 1]).norm();
    if (i + 1 < waypoints.size()) {
      length -= turn_saving_m(radius_m, turn_at(waypoints[i - 1], waypoints[i], waypoints[i + 1]));
    }
  }
  return length;
}

double turns_fit_m(std::span<const Vec2> waypoints, double radius_m) {
  double least = std::numeric_limits<double>::infinity();
  double before = 0.0;
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    const double reach =
        i + 1 < waypoints.size()
            ? turn_reach_m(radius_m, turn_at(waypoints[i - 1], waypoints[i], waypoints[i + 1]))
            : 0.0;
    least = std::min(least, (waypoints[i] - waypoints[i - 1]).norm() - before - reach);
    before = reach;
  }
  return least;
}

Result<Path> fly_by_path(std::span<const Vec2> waypoints, double radius_m) {
  if (waypoints.size() < 2 || waypoints.size() > kWaypointsMax) {
    return Error{"a route has 2 to " + std::to_string(kWaypointsMax) + " waypoints, not " +
                 std::to_string(waypoints.size())};
  }
  const Vec2 first = waypoints[1] - waypoints[0];
  Path path{.start = {waypoints[0].x(), waypoints[0].y(), std::atan2(first.y(), first.x())},
            .segments = {}};
  double before = 0.0;
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    const double leg = (waypoints[i] - waypoints[i - 1]).norm();
    const double turn =
        i + 1 < waypoints.size() ? turn_at(waypoints[i - 1], waypoints[i], waypoints[i + 1]) : 0.0;
    const double reach = turn_reach_m(radius_m, turn);
    const double straight = leg - before - reach;
    if (!(leg > 0.0) || straight < -kOverlap_m) {
      return Error{"the turns at waypoints " + std::to_string(i - 1) + " and " + std::to_string(i) +
                   " do not fit into the leg between them of " + std::to_string(leg) + " m"};
    }
    // Twice the waypoints less one are never too many pieces (kWaypointsMax).
    SKEIN_ASSERT(path.append(Segment{0.0, std::max(straight, 0.0)}));
    if (radius_m > 0.0 && turn != 0.0) {
      SKEIN_ASSERT(
          path.append(Segment{(turn > 0.0 ? 1.0 : -1.0) / radius_m, radius_m * std::abs(turn)}));
    }
    before = reach;
  }
  return path;
}

}  // namespace skein::routes
