// SPDX-License-Identifier: Apache-2.0
#include "track_checks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "skein/base/angles.hpp"
#include "skein/planning/avoidance.hpp"

namespace skein::formation {
namespace {

constexpr Duration kSample = std::chrono::milliseconds{100};

/// The distance of two points that move straight from one pair of positions to the next.
double apart_between(const Vec2& begin, const Vec2& end) {
  return distance_to_segment({0.0, 0.0}, begin, end);
}

}  // namespace

std::string vehicle_name(const TrackPlane& plane) {
  return "vehicle " + std::to_string(plane.spec.id.value);
}

std::string in_tenths(double value) {
  std::array<char, 32> text{};
  static_cast<void>(std::snprintf(text.data(), text.size(), "%.1f", value));
  return text.data();
}

Result<std::vector<TrackPlace>> track_places(const ShapeSpec& shape, std::size_t n) {
  ShapeSpec flat = shape;
  flat.heading_rad = 0.0;
  flat.centre = Vec3::Zero();
  for (Vec3& point : flat.points) point.z() = 0.0;
  const auto all = places(flat, n);
  if (!all) return all.error();
  std::vector<TrackPlace> on_track;
  for (const Vec3& place : *all) on_track.push_back({place.x(), place.y()});
  return on_track;
}

Result<void> check_piece(const TrackPlane& plane, const TrackRules& rules, double curvature_per_m,
                         double speed_mps) {
  const VehicleSpec& spec = plane.spec;
  const double radius_m = spec.planning_radius_m();
  if (std::abs(curvature_per_m) * radius_m > 1.0 + 1e-9) {
    return Error{
        vehicle_name(plane) + " would turn on " + in_tenths(1.0 / std::abs(curvature_per_m)) +
        " m and needs " + in_tenths(radius_m) +
        " m (turn_radius_m * turn_radius_margin); widen the track's turn_radius_m or lower "
        "the spacing"};
  }
  const std::string flies = vehicle_name(plane) + " would fly " + in_tenths(speed_mps) +
                            " m/s over the ground, and wind of " + in_tenths(rules.wind_mps) +
                            " m/s ";
  if (speed_mps + rules.wind_mps > spec.speed_max_mps + 1e-9) {
    return Error{flies + "against it asks for more than its speed_max_mps " +
                 in_tenths(spec.speed_max_mps) + "; lower the speed, or the spacing"};
  }
  if (speed_mps - rules.wind_mps < spec.speed_min_mps - 1e-9) {
    return Error{flies + "from behind for less than its speed_min_mps " +
                 in_tenths(spec.speed_min_mps) +
                 "; raise the speed, widen the track's turns or lower the spacing"};
  }
  return {};
}

Result<void> check_place(const TrackPlane& plane, const TrackRules& rules, const TrackPlace& place,
                         const TimedPath& centre) {
  const auto fits = [&](double curvature) -> Result<void> {
    const double pace = pace_at(place, curvature);
    if (pace <= 0.0) {
      return Error{vehicle_name(plane) + " would be " + in_tenths(std::abs(place.left_m)) +
                   " m inside a turn of " + in_tenths(1.0 / std::abs(curvature)) +
                   " m radius, beyond its centre; widen the track's turn_radius_m or lower the "
                   "spacing"};
    }
    return check_piece(plane, rules, curvature / pace, pace * centre.speed_mps);
  };
  for (const Segment& segment : centre.path.segments) {
    if (auto held = fits(segment.curvature_per_m); !held) return held;
  }
  return fits(centre.tail_curvature_per_m);
}

Result<void> check_way(const TrackPlane& plane, const TrackRules& rules, const TimedPath& timed) {
  const double lap_m = kTwoPi / std::abs(timed.tail_curvature_per_m);
  Path orbit{timed.path.end(), {}};
  static_cast<void>(orbit.append(Segment{timed.tail_curvature_per_m, lap_m}));
  std::vector<Hazard> circles = rules.hazards;
  for (Hazard& circle : circles) circle.radius_m = rules.avoidance.safety_radius_m(circle);
  for (const Path& path : {timed.path, orbit}) {
    if (const Hazard* met = planning::first_entered(path, circles)) {
      return Error{"the way of " + vehicle_name(plane) + " along the track comes too near hazard " +
                   std::to_string(met->id.value) + "; lead the track around it"};
    }
  }
  const double needs_m = timed.path.length_m() + lap_m;
  if (needs_m > plane.range_left_m) {
    return Error{vehicle_name(plane) + " needs " + in_tenths(needs_m / 1000.0) + " km and has " +
                 in_tenths(plane.range_left_m / 1000.0) +
                 " km left; fly fewer laps or a shorter track"};
  }
  return {};
}

Result<void> check_heights(const TrackRequest& request) {
  for (const TrackPlane& plane : request.planes) {
    if (plane.spec.height_m > request.rules.ceiling_m) {
      return Error{vehicle_name(plane) + " flies at " + in_tenths(plane.spec.height_m) +
                   " m, and the ceiling is " + in_tenths(request.rules.ceiling_m) +
                   " m; give it a lower height_m"};
    }
    for (const TrackPlane& silent : request.silent) {
      if (apart_in_height(plane, silent, request.rules)) continue;
      return Error{vehicle_name(silent) + " is silent, and flies at the height of " +
                   vehicle_name(plane) + "; wait until it is heard, or fly without either"};
    }
  }
  return {};
}

bool append_placed(TimedPath& timed, const TimedPath& centre, const TrackPlace& place,
                   double centre_m) {
  const PlacedPath placed = placed_path(centre.path, centre.tail_curvature_per_m, place, centre_m);
  for (std::size_t i = 0; i < placed.path.segments.size(); ++i) {
    if (!timed.append(placed.path.segments[i], placed.paces[i])) return false;
  }
  timed.tail_curvature_per_m = placed.tail_curvature_per_m;
  return timed.paces.try_push_back(placed.tail_pace);
}

Error too_many_pieces() {
  return Error{"the way has more than " + std::to_string(kPathSegmentsMax) +
               " pieces; fly fewer laps or waypoints"};
}

Instant end_of_orbit(const TimedPath& centre) {
  return centre.end_time() +
         from_seconds(kTwoPi / std::abs(centre.tail_curvature_per_m) / centre.speed_mps);
}

void SampledWays::add(const TimedPath& timed) {
  std::vector<Vec2> way;
  way.reserve(static_cast<std::size_t>((to_ - from_) / kSample) + 2);
  for (Instant t = from_; t < to_ + kSample; t += kSample) {
    way.push_back(timed.pose_at(t).position());
  }
  ways_.push_back(std::move(way));
}

SampledWays::Closest SampledWays::closest(std::size_t a, std::size_t b, Instant since) const {
  Closest found{std::numeric_limits<double>::infinity(), since};
  const auto& first = ways_[a];
  const auto& second = ways_[b];
  const auto begin = static_cast<std::size_t>(std::max<std::int64_t>(0, (since - from_) / kSample));
  for (std::size_t i = begin; i + 1 < first.size(); ++i) {
    const double apart = apart_between(first[i] - second[i], first[i + 1] - second[i + 1]);
    if (apart >= found.apart_m) continue;
    found = {apart, from_ + static_cast<std::int64_t>(i) * kSample};
  }
  found.apart_m -= kMissed_m;
  return found;
}

double needed_m(const TrackRules& rules) {
  return rules.separation.horizontal_m + 2.0 * rules.tracking_m;
}

bool apart_in_height(const TrackPlane& a, const TrackPlane& b, const TrackRules& rules) {
  return std::abs(a.spec.height_m - b.spec.height_m) >= rules.separation.vertical_m;
}

Result<double> check_places_apart(const PlannedTrack& planned, const TrackRules& rules,
                                  Instant since) {
  SampledWays ways{since, end_of_orbit(planned.centre)};
  for (const TrackFlightPlan& flight : planned.flights) ways.add(flight.timed);
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < planned.flights.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const double apart_m = ways.closest(k, i, since).apart_m;
      least_m = std::min(least_m, apart_m);
      if (apart_m >= needed_m(rules)) continue;
      return Error{vehicle_name(planned.flights[k].plane) + " and " +
                   vehicle_name(planned.flights[i].plane) + " would come within " +
                   in_tenths(apart_m) + " m of each other in their places, and " +
                   in_tenths(needed_m(rules)) +
                   " m are needed (separation_m and twice tracking_m); raise the spacing, or widen "
                   "the track's turns"};
    }
  }
  return planned.flights.size() < 2 ? 0.0 : least_m;
}

std::optional<std::string> conflict_on_ways(const PlannedTrack& planned, const TrackRules& rules,
                                            Instant start, Instant joined) {
  const auto& flights = planned.flights;
  const std::size_t n = flights.size();
  bool near = false;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      near = near || !apart_in_height(flights[i].plane, flights[k].plane, rules);
    }
  }
  if (!near) return std::nullopt;
  SampledWays ways{start, joined};
  for (const TrackFlightPlan& flight : flights) ways.add(flight.timed);
  SampledWays and_now{start, end_of_orbit(planned.centre)};
  for (const TrackFlightPlan& flight : flights) and_now.add(flight.timed);
  for (const TrackFlightPlan& flight : flights) and_now.add(flight.plane.flies);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < n; ++k) {
      if (i == k || apart_in_height(flights[i].plane, flights[k].plane, rules)) continue;
      const auto on_ways = ways.closest(i, k, start);
      const auto to_now = and_now.closest(i, n + k, start);
      const double apart_m = std::min(on_ways.apart_m, to_now.apart_m);
      if (apart_m >= needed_m(rules)) continue;
      return vehicle_name(flights[i].plane) + " and " + vehicle_name(flights[k].plane) +
             " would come within " + in_tenths(std::max(0.0, apart_m)) +
             " m of each other at one height" +
             (on_ways.apart_m < needed_m(rules) ? ""
                                                : ", were one of them not to hear of the order");
    }
  }
  return std::nullopt;
}

}  // namespace skein::formation
