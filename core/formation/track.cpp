// SPDX-License-Identifier: Apache-2.0
#include "skein/formation/track.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"

namespace skein::formation {
namespace {

/// Two waypoints nearer than this are one.
constexpr double kLegLeast_m = 1.0;
/// Sharper, a corner has no arc that a leg has room for.
constexpr double kTurnMost_rad = 0.97 * kPi;

std::string rounded(double value) { return std::to_string(std::lround(value)); }

/// The arc at a waypoint: how far before and after it lies, and how much it turns to the left.
struct Corner {
  double room_m = 0.0;
  double turn_rad = 0.0;
};

Result<std::vector<Corner>> corners_of(const Track& track) {
  const auto& points = track.waypoints;
  const std::size_t n = points.size();
  std::vector<Corner> corners(n);
  for (std::size_t i = 0; i < n; ++i) {
    if (!track.closed && (i == 0 || i + 1 == n)) continue;
    const Vec2 in = points[i] - points[(i + n - 1) % n];
    const Vec2 out = points[(i + 1) % n] - points[i];
    const double turn = wrap_pi(std::atan2(out.y(), out.x()) - std::atan2(in.y(), in.x()));
    if (std::abs(turn) > kTurnMost_rad) {
      return Error{"the track turns back at waypoint " + std::to_string(i + 1) +
                   "; put another waypoint beside it"};
    }
    corners[i] = {track.turn_radius_m * std::tan(std::abs(turn) / 2.0), turn};
  }
  return corners;
}

Result<void> check_legs(const Track& track, const std::vector<Corner>& corners) {
  const std::size_t n = track.waypoints.size();
  for (std::size_t i = 0; i < (track.closed ? n : n - 1); ++i) {
    const std::size_t next = (i + 1) % n;
    const double length = (track.waypoints[next] - track.waypoints[i]).norm();
    const std::string leg =
        "the leg from waypoint " + std::to_string(i + 1) + " to " + std::to_string(next + 1);
    if (length < kLegLeast_m) return Error{leg + " has no length; take one of them away"};
    const double need = corners[i].room_m + corners[next].room_m;
    if (length < need) {
      return Error{leg + " is " + rounded(length) + " m long, and its turns of " +
                   rounded(track.turn_radius_m) + " m radius need " + rounded(std::ceil(need)) +
                   " m; move the waypoints apart or turn tighter"};
    }
  }
  return {};
}

/// Straight pieces that follow each other become one.
bool append_line(Path& path, double length_m) {
  if (!path.segments.empty() && path.segments.back().curvature_per_m == 0.0) {
    path.segments.back().length_m += length_m;
    return true;
  }
  return path.append(Segment{0.0, length_m});
}

bool append_arc(Path& path, double radius_m, double turn_rad) {
  return path.append(
      Segment{std::copysign(1.0 / radius_m, turn_rad), radius_m * std::abs(turn_rad)});
}

}  // namespace

Result<Path> track_path(const Track& track, int laps) {
  const auto& points = track.waypoints;
  const std::size_t n = points.size();
  if (n < (track.closed ? 3U : 2U)) {
    return Error{track.closed ? "a closed track needs three waypoints; add some"
                              : "a track needs two waypoints; add some"};
  }
  if (!(track.turn_radius_m > 0.0)) return Error{"a track needs a turn radius above 0"};
  const auto corners = corners_of(track);
  if (!corners) return corners.error();
  if (const auto room = check_legs(track, *corners); !room) return room.error();

  const auto leg = [&](std::size_t i) { return Vec2{points[(i + 1) % n] - points[i % n]}; };
  const Vec2 first = leg(0);
  // Of a closed one in the middle of what is straight of the first leg.
  const double begin_m =
      track.closed ? (first.norm() + (*corners)[0].room_m - (*corners)[1].room_m) / 2.0 : 0.0;
  const Vec2 start = points[0] + begin_m * first.normalized();
  Path path{{start.x(), start.y(), std::atan2(first.y(), first.x())}, {}};
  const std::size_t legs = track.closed ? n * static_cast<std::size_t>(std::max(1, laps)) : n - 1;
  bool fits = true;
  for (std::size_t i = 0; i < legs && fits; ++i) {
    const Corner& here = (*corners)[i % n];
    const Corner& next = (*corners)[(i + 1) % n];
    const double length_m = leg(i % n).norm();
    // The first leg of a lap is flown from its middle on, and up to there at the lap's end.
    const double from_m = track.closed && i % n == 0 ? begin_m : here.room_m;
    const bool turns = track.closed || i + 1 < legs;
    fits = append_line(path, length_m - next.room_m - from_m) &&
           (!turns || next.room_m == 0.0 || append_arc(path, track.turn_radius_m, next.turn_rad));
    if (fits && track.closed && (i + 1) % n == 0) {
      fits = append_line(path, begin_m - next.room_m);
    }
  }
  if (!fits) {
    return Error{"the track has more than " + std::to_string(kPathSegmentsMax) +
                 " pieces; fly fewer laps or waypoints"};
  }
  return path;
}

PlacedPath placed_path(const Path& centre, double tail_curvature_per_m, const TrackPlace& place,
                       double centre_m) {
  PlacedPath placed;
  const double length_m = centre.length_m();
  double begin_m = centre_m + place.ahead_m;
  SKEIN_ASSERT(begin_m >= 0.0 && begin_m <= length_m);
  Pose2 start = centre.pose_at(begin_m);
  const Vec2 at = start.position() + place.left_m * left_of(unit_vector(start.heading_rad));
  placed.path.start = {at.x(), at.y(), start.heading_rad};
  double passed_m = 0.0;
  for (const Segment& segment : centre.segments) {
    const double end_m = passed_m + segment.length_m;
    const double part_m = end_m - std::max(passed_m, begin_m);
    passed_m = end_m;
    if (part_m <= 0.0) continue;
    const double pace = pace_at(place, segment.curvature_per_m);
    SKEIN_ASSERT(pace > 0.0);
    SKEIN_ASSERT(placed.path.append(Segment{segment.curvature_per_m / pace, part_m * pace}));
    placed.paces.push_back(pace);
  }
  placed.tail_pace = pace_at(place, tail_curvature_per_m);
  SKEIN_ASSERT(placed.tail_pace > 0.0);
  placed.tail_curvature_per_m = tail_curvature_per_m / placed.tail_pace;
  return placed;
}

}  // namespace skein::formation
