// SPDX-License-Identifier: Apache-2.0
#include "flight.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"
#include "skein/planning/avoidance.hpp"

namespace skein::mission {
namespace {
/// A new path starts this far ahead: time for control to take it over before it turns.
constexpr Duration kHandover = std::chrono::milliseconds{200};
/// An orbit in wind is flown some metres off its circle.
constexpr double kHoldClearanceM = 20.0;
/// Where no orbit begun here keeps its distance: directions that are tried, and how far away.
constexpr int kWaysOut = 8;
constexpr double kWayOutRadii = 6.0;
}  // namespace

Flight::Flight(const VehicleSpec& vehicle, planning::AvoidanceParams avoidance,
               std::vector<Vec2> search)
    : vehicle_{vehicle}, avoidance_{avoidance}, search_{std::move(search)} {}

void Flight::start(const Pose2& pose, const std::vector<Hazard>& hazards, Instant now) {
  home_ = pose.position();
  TimedPath here;
  here.start_time = now;
  here.speed_mps = vehicle_.cruise_speed_mps;
  here.path.start = pose;
  here.tail_curvature_per_m = 0.0;  // straight on until the first path begins
  replace(here);
  search(hazards, now);
}

void Flight::replace(const TimedPath& timed) {
  plan_.timed = timed;
  ++plan_.number;
  fresh_ = true;
}

bool Flight::continue_with(Instant at, const Path& next, double tail_curvature_per_m, Instant now) {
  SKEIN_ASSERT(started() && at >= now);
  const TimedPath& old = plan_.timed;
  const auto before = old.piece(old.distance_at(now), old.distance_at(at));
  if (!before) return false;
  TimedPath timed;
  timed.start_time = now;
  timed.speed_mps = old.speed_mps;
  timed.tail_curvature_per_m = tail_curvature_per_m;
  timed.path = *before;
  if (!timed.path.append(next)) return false;
  if (searching_) pass_waypoints(now);
  searching_ = false;
  replace(timed);
  return true;
}

double Flight::hold_curvature(const Pose2& at, const std::vector<Hazard>& hazards) const {
  return best_orbit(at, hazards).curvature_per_m;
}

/// The first orbit that keeps its distance; where none does, the one that keeps most.
Flight::Orbit Flight::best_orbit(const Pose2& at, const std::vector<Hazard>& hazards) const {
  Orbit best{1.0 / vehicle_.planning_radius_m(), -std::numeric_limits<double>::infinity()};
  for (const double factor : {1.0, 1.5, 2.5, 4.0}) {
    for (const double side : {1.0, -1.0}) {
      const double radius = factor * vehicle_.planning_radius_m();
      const Vec2 centre = at.position() + side * radius * left_of(unit_vector(at.heading_rad));
      double clearance = kHoldClearanceM;
      for (const Hazard& h : hazards) {
        const double d = (h.centre - centre).norm();
        const double outside = d - radius - h.radius_m;
        const double around = radius - d - h.radius_m;  // the hazard lies wholly inside the orbit
        clearance = std::min(clearance, std::max(outside, around));
      }
      if (clearance > best.clearance_m) best = {side / radius, clearance};
    }
  }
  return best;
}

void Flight::hold(const std::vector<Hazard>& hazards, Instant now) {
  const Instant at = now + kHandover;
  const Pose2 here = pose_at(at);
  Path way{here, {}};
  Orbit orbit = best_orbit(here, hazards);
  if (orbit.clearance_m < kHoldClearanceM) {  // to where there is room, by the shortest way
    double shortest_m = std::numeric_limits<double>::infinity();
    for (int i = 0; i < kWaysOut; ++i) {
      const double heading = wrap_pi(here.heading_rad + i * kTwoPi / kWaysOut);
      const Vec2 there =
          here.position() + kWayOutRadii * vehicle_.planning_radius_m() * unit_vector(heading);
      const Pose2 to{there.x(), there.y(), heading};
      const Orbit room = best_orbit(to, hazards);
      if (room.clearance_m < kHoldClearanceM) continue;
      const auto leg = planning::shortest_clear_path(avoidance_, here, to,
                                                     vehicle_.planning_radius_m(), hazards);
      if (!leg || leg->length_m() >= shortest_m) continue;
      shortest_m = leg->length_m();
      way = *leg;
      orbit = room;
    }
  }
  continue_with(at, way, orbit.curvature_per_m, now);
}

void Flight::pass_waypoints(Instant now) {
  const double flown = plan_.timed.distance_at(now);
  while (!search_marks_.empty() && search_marks_.front() <= flown) {
    search_marks_.erase(search_marks_.begin());
    if (search_.size() > 1) search_.erase(search_.begin());
  }
  search_marks_.clear();
}

void Flight::search(const std::vector<Hazard>& hazards, Instant now) {
  if (searching_) pass_waypoints(now);
  if (search_.empty()) {
    hold(hazards, now);
  } else {
    follow(search_, hazards, now);
  }
  searching_ = true;
}

void Flight::fly_home(const std::vector<Hazard>& hazards, Instant now) {
  follow({home_}, hazards, now);
  searching_ = false;
  search_marks_.clear();
}

void Flight::follow(const std::vector<Vec2>& waypoints, const std::vector<Hazard>& hazards,
                    Instant now) {
  const Instant at = now + kHandover;
  Path route;
  route.start = pose_at(at);
  std::vector<double> marks;
  Pose2 from = route.start;
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    // Each point is passed in the direction between those of arriving and leaving.
    const Vec2 in = waypoints[i] - from.position();
    Vec2 along = in.norm() > 1.0 ? Vec2{in.normalized()} : unit_vector(from.heading_rad);
    if (i + 1 < waypoints.size()) {
      const Vec2 out = waypoints[i + 1] - waypoints[i];
      if (out.norm() > 1.0) along += out.normalized();
    }
    const double heading =
        along.norm() > 0.01 ? std::atan2(along.y(), along.x()) : from.heading_rad;
    const Pose2 to{waypoints[i].x(), waypoints[i].y(), heading};
    const auto leg =
        planning::shortest_clear_path(avoidance_, from, to, vehicle_.planning_radius_m(), hazards);
    // A point that cannot be reached clear of hazards is left out; a full path ends in an orbit,
    // and the rest of the route is planned when that is resumed.
    if (!leg) {
      marks.push_back(route.length_m());
      continue;
    }
    if (!route.append(*leg)) break;
    marks.push_back(route.length_m());
    from = to;
  }
  const Pose2 end = route.end();
  if (!continue_with(at, route, hold_curvature(end, hazards), now)) return;
  const double lead = plan_.timed.path.length_m() - route.length_m();
  search_marks_.clear();
  for (const double mark : marks) search_marks_.push_back(lead + mark);
}

std::optional<FlightPlan> Flight::poll_plan() {
  if (!std::exchange(fresh_, false)) return std::nullopt;
  return plan_;
}

}  // namespace skein::mission
