// SPDX-License-Identifier: Apache-2.0
#include "flight.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"
#include "skein/planning/avoidance.hpp"
#include "skein/planning/dubins.hpp"

namespace skein::mission {
namespace {
/// An orbit in wind is flown some metres off its circle.
constexpr double kHoldClearanceM = 20.0;
/// Where no orbit begun here keeps its distance: directions that are tried, and how far away.
constexpr int kWaysOut = 8;
constexpr double kWayOutRadii = 6.0;
/// Turns that are tried to each side where none may miss a hazard that has just become known, and
/// how far straight on after them.
constexpr int kTurns = 72;
constexpr double kStraightMaxM = 400.0;
constexpr double kStepM = 1.0;
/// A turn that keeps less than this from a hazard counts as none that misses it.
constexpr double kEdgeM = 5.0;
constexpr double kRoundingM = 1e-6;
constexpr Duration kTriesHomeAgain = std::chrono::seconds{10};

/// Is the vehicle outside all hazards, and headed so that it need not enter one? A hazard that is
/// two radii away is missed by a turn.
bool is_free(const Pose2& pose, double radius_m, std::span<const Hazard> hazards) {
  return std::all_of(hazards.begin(), hazards.end(), [&](const Hazard& h) {
    const Vec2 offset = h.centre - pose.position();
    const double room_m = offset.norm() - h.radius_m - kEdgeM;
    const bool away = offset.dot(unit_vector(pose.heading_rad)) <= 0.0;
    return room_m > 0.0 && (away || room_m >= 2.0 * radius_m);
  });
}

bool is_inside(const Vec2& point, std::span<const Hazard> hazards) {
  return std::any_of(hazards.begin(), hazards.end(), [&](const Hazard& h) {
    return (point - h.centre).norm() < h.radius_m + kEdgeM;
  });
}

/// A turn, then straight on until the vehicle is free.
struct WayOut {
  double turn_m = 0.0;
  double straight_m = 0.0;
  double inside_m = std::numeric_limits<double>::infinity();  ///< of hazards
  [[nodiscard]] double length_m() const { return turn_m + straight_m; }
};

/// The one to that side that is inside hazards for the shortest.
WayOut least_inside(const Pose2& from, double curvature_per_m, std::span<const Hazard> hazards) {
  const double radius_m = 1.0 / std::abs(curvature_per_m);
  WayOut best;
  double turned_inside_m = 0.0;
  const double turn_step_m = kTwoPi * radius_m / kTurns;
  const int steps = static_cast<int>(std::ceil(turn_step_m / kStepM));
  for (int i = 0; i < kTurns; ++i) {
    const Pose2 begin = advance(from, curvature_per_m, i * turn_step_m);
    const Vec2 forward = unit_vector(begin.heading_rad);
    WayOut way{i * turn_step_m, 0.0, turned_inside_m};
    Pose2 pose = begin;
    while (way.straight_m < kStraightMaxM && !is_free(pose, radius_m, hazards)) {
      if (is_inside(pose.position(), hazards)) way.inside_m += kStepM;
      way.straight_m += kStepM;
      const Vec2 point = begin.position() + way.straight_m * forward;
      pose.x_m = point.x();
      pose.y_m = point.y();
    }
    const bool shorter = way.inside_m == best.inside_m && way.length_m() < best.length_m();
    if (way.straight_m < kStraightMaxM && (way.inside_m < best.inside_m || shorter)) best = way;
    for (int step = 0; step < steps; ++step) {
      const Pose2 along = advance(begin, curvature_per_m, step * kStepM);
      if (is_inside(along.position(), hazards)) turned_inside_m += kStepM;
    }
  }
  return best;
}

/// False, and nothing added, when `path` would have more pieces than that.
bool append_within(std::size_t pieces_max, Path& path, const Path& next) {
  return path.segments.size() + next.segments.size() <= pieces_max && path.append(next);
}

bool is_clear_orbit(const Pose2& from, double curvature_per_m, const std::vector<Hazard>& hazards) {
  Path orbit{from, {}};
  return orbit.append(Segment{curvature_per_m, kTwoPi / std::abs(curvature_per_m)}) &&
         planning::is_clear(orbit, hazards);
}

}  // namespace

Flight::Flight(const VehicleSpec& vehicle, planning::AvoidanceParams avoidance,
               std::vector<Vec2> search)
    : vehicle_{vehicle}, avoidance_{avoidance}, search_{std::move(search)} {}

void Flight::set_planning_radius(double radius_m) {
  vehicle_.turn_radius_margin = radius_m / vehicle_.turn_radius_m;
}

void Flight::start(const Pose2& pose, const std::vector<Hazard>& hazards, double range_m,
                   Instant now) {
  first_pose_ = pose;
  begin_at(pose, now);  // until the first path begins
  search_from(now + std::max(lead_in_, handover_), hazards, range_m, now);
}

void Flight::begin_at(const Pose2& pose, Instant now) {
  TimedPath here = begun(now, vehicle_.cruise_speed_mps, 0.0);
  here.path.start = pose;
  take_up(here, now);
}

void Flight::start_route(const TimedPath& route) {
  first_pose_ = route.path.start;
  replace(route);
  en_route_ = true;
}

void Flight::fly(const TimedPath& timed) {
  searching_ = homing_ = en_route_ = at_will_ = false;
  search_goes_on_at_ = Instant::max();
  stands_by_.reset();
  search_marks_.clear();
  replace(timed);
}

void Flight::fly_route(const TimedPath& timed, Instant now) {
  if (searching_) pass_waypoints(now);
  fly(timed);
  en_route_ = true;
}

void Flight::land(const Landing& landing) {
  replace(plan_.timed);
  plan_.lands = true;
  plan_.landing = landing;
}

void Flight::replace(const TimedPath& timed) {
  plan_.timed = timed;
  plan_.lands = false;
  orbit_barred_ = false;
  ++plan_.number;
  fresh_ = true;
}

void Flight::climb_from(double offset_m) {
  plan_.height_from_m = plan_.height_to_m = offset_m;
  ++plan_.number;
  fresh_ = true;
}

void Flight::change_height(double offset_m, Instant now) {
  if (offset_m == plan_.height_to_m) return;
  plan_.height_from_m = height_offset_m(plan_, now);
  plan_.height_to_m = offset_m;
  plan_.height_since = now;
  ++plan_.number;
  fresh_ = true;
}

namespace {

/// What a pace may be changed by so that a plan is on time both where it begins and at its gate.
constexpr double kPaceShare = 0.1;
constexpr int kPacesTried = 8;
/// What a plan may be off by where it begins: some metres.
constexpr Duration kBeginsOff = std::chrono::milliseconds{300};

/// Where it begins, and at on_time_m when it is to be there: by its pace. What that cannot make up
/// for, the plan is off by where it begins, and for the rest at on_time_m.
void be_on_time(TimedPath& timed, Instant on_time_at) {
  const double mean_mps = timed.speed_mps;
  const double wanted_s = to_seconds(on_time_at - timed.start_time);
  for (int i = 0; wanted_s > 0.0 && i < kPacesTried; ++i) {
    const double takes_s = to_seconds(timed.time_at(timed.on_time_m) - timed.start_time);
    timed.speed_mps = std::clamp(timed.speed_mps * takes_s / wanted_s,
                                 (1.0 - kPaceShare) * mean_mps, (1.0 + kPaceShare) * mean_mps);
  }
  const Duration off = on_time_at - timed.time_at(timed.on_time_m);
  timed.start_time += std::clamp(off, -kBeginsOff, kBeginsOff);
}

}  // namespace

bool Flight::continue_with(Instant at, const Path& next, double tail_curvature_per_m, Instant now,
                           const std::optional<Pace>& pace) {
  SKEIN_ASSERT(started() && at >= now);
  const TimedPath& old = plan_.timed;
  const auto before = old.piece(old.distance_at(now), old.distance_at(at));
  if (!before) return false;
  TimedPath timed =
      begun(now, pace ? pace->speed_mps : vehicle_.cruise_speed_mps, tail_curvature_per_m);
  timed.path = *before;
  if (!timed.path.append(next)) return false;
  const double before_m = before->length_m();
  if (pace && pace->on_time_m > 0.0) timed.on_time_m = before_m + pace->on_time_m;
  if (timed.has_wind() && pace && pace->on_time_at) {
    be_on_time(timed, *pace->on_time_at);
  } else if (timed.speed_mps != old.speed_mps || timed.has_wind() || old.has_wind()) {
    timed.start_time = at - (timed.time_at(before_m) - now);  // where `next` begins it is on time
  }
  take_up(timed, now);
  return true;
}

bool Flight::continue_as_told(const TimedPath& way, Instant now) {
  const TimedPath& old = plan_.timed;
  const auto before = old.piece(old.distance_at(now), old.distance_at(way.start_time));
  if (!before) return false;
  TimedPath timed = begun(now, way.speed_mps, way.tail_curvature_per_m);
  if (way.has_wind()) {
    timed.set_wind(way.wind_mps());
    timed.path = *before;
    if (!timed.path.append(way.path)) return false;
    timed.start_time = way.start_time - (timed.time_at(before->length_m()) - now);
    take_up(timed, now);
    return true;
  }
  timed.path.start = before->start;
  const double even_m = way.speed_mps * to_seconds(way.start_time - now);
  if (!timed.append(*before, before->length_m() / even_m) || !timed.append(way.path, 1.0)) {
    return false;
  }
  timed.paces.push_back(1.0);
  take_up(timed, now);
  return true;
}

TimedPath Flight::begun(Instant start, double speed_mps, double tail_curvature_per_m) const {
  TimedPath timed;
  timed.start_time = start;
  timed.speed_mps = speed_mps;
  timed.tail_curvature_per_m = tail_curvature_per_m;
  timed.set_wind(wind_mps_);
  return timed;
}

void Flight::take_up(const TimedPath& timed, Instant now) {
  if (searching_) pass_waypoints(now);
  searching_ = homing_ = en_route_ = at_will_ = false;
  search_goes_on_at_ = Instant::max();
  stands_by_.reset();
  replace(timed);
}

double Flight::hold_curvature(const Pose2& at, const std::vector<Hazard>& hazards) const {
  return best_orbit(at, hazards).curvature_per_m;
}

namespace {

/// `radius_m` is positive to the left.
Vec2 orbit_centre(const Pose2& from, double radius_m) {
  return from.position() + radius_m * left_of(unit_vector(from.heading_rad));
}

}  // namespace

/// The first orbit that keeps its distance; where none does, the one that keeps most.
Flight::Orbit Flight::best_orbit(const Pose2& at, const std::vector<Hazard>& hazards) const {
  Orbit best{1.0 / vehicle_.planning_radius_m(), -std::numeric_limits<double>::infinity()};
  for (const double factor : {1.0, 1.5, 2.5, 4.0}) {
    for (const double side : {1.0, -1.0}) {
      const double radius = factor * vehicle_.planning_radius_m();
      const Vec2 centre = orbit_centre(at, side * radius);
      double clearance = std::min(kHoldClearanceM, fence_room_m(fence_, centre, radius));
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

bool Flight::misses(const Pose2& from, const std::vector<Hazard>& hazards) const {
  const double radius_m = vehicle_.planning_radius_m();
  return is_free(from, radius_m, hazards) ||
         least_inside(from, 1.0 / radius_m, hazards).inside_m == 0.0 ||
         least_inside(from, -1.0 / radius_m, hazards).inside_m == 0.0;
}

Path Flight::forced_way(const Pose2& from, const std::vector<Hazard>& hazards) const {
  Path path{from, {}};
  // What need not be entered is the planner's to find its way around.
  if (misses(from, hazards)) return path;
  const double tightest = 1.0 / vehicle_.turn_radius_m;
  const WayOut left = least_inside(from, tightest, hazards);
  const WayOut right = least_inside(from, -tightest, hazards);
  const bool to_left = left.inside_m < right.inside_m ||
                       (left.inside_m == right.inside_m && left.length_m() <= right.length_m());
  const WayOut& way = to_left ? left : right;
  if (std::isinf(way.inside_m)) return path;
  SKEIN_ASSERT(path.append(Segment{to_left ? tightest : -tightest, way.turn_m}) &&
               path.append(Segment{0.0, way.straight_m}));
  return path;
}

double Flight::append_hold(Path& path, const std::vector<Hazard>& hazards,
                           std::size_t pieces_max) const {
  const Pose2 from = path.end();
  const Orbit here = best_orbit(from, hazards);
  if (here.clearance_m >= kHoldClearanceM) return here.curvature_per_m;
  Path way{from, {}};
  double curvature = here.curvature_per_m;
  double shortest_m = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kWaysOut; ++i) {
    const double heading = wrap_pi(from.heading_rad + i * kTwoPi / kWaysOut);
    const Vec2 there =
        from.position() + kWayOutRadii * vehicle_.planning_radius_m() * unit_vector(heading);
    const Pose2 to{there.x(), there.y(), heading};
    const Orbit room = best_orbit(to, hazards);
    if (room.clearance_m < kHoldClearanceM) continue;
    const auto leg =
        planning::shortest_clear_path(avoidance_, from, to, vehicle_.planning_radius_m(), hazards);
    if (!leg || leg->length_m() >= shortest_m) continue;
    if (fence_room_m(fence_, *leg) < std::min(0.0, here.clearance_m)) continue;
    shortest_m = leg->length_m();
    way = *leg;
    curvature = room.curvature_per_m;
  }
  return append_within(pieces_max, path, way) ? curvature : here.curvature_per_m;
}

void Flight::hold(const std::vector<Hazard>& hazards, Instant now) {
  hold_from(now + handover_, hazards, now);
}

void Flight::orbit_anew(const std::vector<Hazard>& hazards, Instant now) {
  const Instant at = now + handover_;
  const TimedPath& timed = plan_.timed;
  const double from_m = timed.distance_at(at);
  const auto rest = timed.piece(from_m, std::max(from_m, timed.path.length_m()));
  if (!rest) return;
  Path way = *rest;
  const double tail = append_hold(way, hazards);
  const bool homing = homing_;
  if (!continue_with(at, way, tail, now)) return;
  homing_ = homing;
  at_will_ = true;
}

void Flight::hold_from(Instant at, const std::vector<Hazard>& hazards, Instant now) {
  Path way = forced_way(pose_at(at), hazards);
  const double tail = append_hold(way, hazards);
  if (continue_with(at, way, tail, now)) at_will_ = true;
}

std::optional<double> Flight::orbit_after(Path& path, double arc_curvature_per_m,
                                          const std::vector<Hazard>& hazards) const {
  const double radius_m = 1.0 / arc_curvature_per_m;
  const Vec2 centre = orbit_centre(path.end(), radius_m);
  const bool stays_in = fence_room_m(fence_, centre, std::abs(radius_m)) >= kFlownOff_m;
  if (stays_in && orbit_keeps_clear(path.end(), arc_curvature_per_m, hazards)) {
    return arc_curvature_per_m;
  }
  if (!misses(path.end(), hazards)) return std::nullopt;
  const double curvature = append_hold(path, hazards);
  if (!orbit_keeps_clear(path.end(), curvature, hazards)) return std::nullopt;
  return curvature;
}

bool Flight::orbit_keeps_clear(const Pose2& from, double curvature_per_m,
                               const std::vector<Hazard>& hazards) const {
  const double radius = 1.0 / std::abs(curvature_per_m);
  const double side = curvature_per_m > 0.0 ? 1.0 : -1.0;
  const Vec2 centre = orbit_centre(from, side * radius);
  return std::ranges::all_of(hazards, [&](const Hazard& hazard) {
    const double distance = (hazard.centre - centre).norm();
    return std::abs(distance - radius) >= avoidance_.safety_radius_m(hazard);
  });
}

bool Flight::keeps_off(const Path& way, const std::vector<Hazard>& hazards) const {
  std::vector<Hazard> circles = hazards;
  for (Hazard& circle : circles) {
    const double begins_m = (circle.centre - way.start.position()).norm() - kRoundingM;
    circle.radius_m =
        std::max(circle.radius_m, std::min(begins_m, avoidance_.safety_radius_m(circle)));
  }
  return planning::is_clear(way, circles);
}

bool Flight::keeps_clear(const std::vector<Hazard>& hazards, Instant now) const {
  std::vector<Hazard> circles = hazards;
  for (Hazard& circle : circles) circle.radius_m = avoidance_.safety_radius_m(circle);
  const TimedPath& timed = plan_.timed;
  const double ahead = timed.distance_at(now);
  const double tail = std::abs(timed.tail_curvature_per_m);
  const double lap = tail > 0.0 ? kTwoPi / tail : 0.0;
  const auto rest = timed.piece(ahead, std::max(ahead, timed.path.length_m()) + lap);
  return rest && planning::is_clear(*rest, circles);
}

void Flight::pass_waypoints(Instant now) {
  const double flown = plan_.timed.distance_at(now);
  while (!search_marks_.empty() && search_marks_.front() <= flown) {
    search_marks_.erase(search_marks_.begin());
    if (search_.size() > 1) search_.erase(search_.begin());
  }
  search_marks_.clear();
}

void Flight::search(const std::vector<Hazard>& hazards, double range_m, Instant now) {
  search_from(now + handover_, hazards, range_m, now);
}

void Flight::search_from(Instant at, const std::vector<Hazard>& hazards, double range_m,
                         Instant now) {
  if (searching_) pass_waypoints(now);
  bool goes_on = false;
  if (search_.empty()) {
    hold_from(at, hazards, now);
  } else {
    goes_on = follow(at, search_, hazards, range_m, now).full;
  }
  searching_ = at_will_ = true;
  search_goes_on_at_ = goes_on ? plan_.timed.end_time() - 2 * handover_ : Instant::max();
}

void Flight::fly_home(const std::vector<Hazard>& hazards, Instant now) {
  const bool reaches =
      follow(now + handover_, {home()}, hazards, std::numeric_limits<double>::infinity(), now)
          .reaches_last;
  searching_ = false;
  homing_ = at_will_ = true;
  tries_home_at_ = reaches ? Instant::max() : now + kTriesHomeAgain;
  search_marks_.clear();
}

bool Flight::return_along(const TimedPath& way, Instant now) {
  const bool follows = way.has_wind() || wind_mps_ != Vec2{0.0, 0.0}
                           ? continue_as_told(way, now)
                           : continue_with(way.start_time, way.path, way.tail_curvature_per_m, now,
                                           Pace{way.speed_mps});
  if (!follows) return false;
  homing_ = true;
  tries_home_at_ = Instant::max();
  search_marks_.clear();
  return true;
}

void Flight::stand_by(SiteId site, const std::optional<Vec2>& place,
                      const std::vector<Hazard>& hazards, double range_m, Instant now) {
  if (place) {
    follow(now + handover_, {*place}, hazards, range_m, now);
    search_marks_.clear();
  } else {
    hold(hazards, now);
  }
  stands_by_ = site;
  at_will_ = true;
}

double Flight::way_home_m(const Pose2& from, const std::vector<Hazard>& hazards) const {
  if (vehicle_.recovery == Recovery::anywhere) return 0.0;
  if (fence_.exists()) {
    const auto way = way_to(from, home(), std::nullopt, hazards);
    if (way) return way->path.length_m();
  }
  const Vec2 way = home() - from.position();
  const double heading = way.norm() > 1.0 ? std::atan2(way.y(), way.x()) : from.heading_rad;
  const Pose2 to{first_pose_.x_m, first_pose_.y_m, heading};
  const double radius = vehicle_.planning_radius_m();
  const auto clear = planning::shortest_clear_length(avoidance_, from, to, radius, hazards);
  return clear ? *clear : planning::shortest_dubins_length(from, to, radius);
}

std::optional<FenceWay> Flight::way_to(const Pose2& from, const Vec2& point,
                                       const std::optional<Vec2>& next,
                                       const std::vector<Hazard>& hazards) const {
  std::vector<Vec2> points = corners_between(fence_, from.position(), point);
  points.push_back(point);
  auto way = way_over(points, from, next, hazards);
  // A hazard may lie where a corner would be passed.
  if (!way && points.size() > 1) way = way_over({point}, from, next, hazards);
  return way;
}

std::optional<FenceWay> Flight::way_over(const std::vector<Vec2>& points, const Pose2& from,
                                         const std::optional<Vec2>& next,
                                         const std::vector<Hazard>& hazards) const {
  FenceWay all{{from, {}}, from, kFenceRoom_m};
  for (std::size_t i = 0; i < points.size(); ++i) {
    // Each point is passed in the direction between those of arriving and leaving.
    const Vec2 in = points[i] - all.end.position();
    Vec2 along = in.norm() > 1.0 ? Vec2{in.normalized()} : unit_vector(all.end.heading_rad);
    if (const auto on = i + 1 < points.size() ? points[i + 1] : next) {
      const Vec2 out = *on - points[i];
      if (out.norm() > 1.0) along += out.normalized();
    }
    const double heading =
        along.norm() > 0.01 ? std::atan2(along.y(), along.x()) : all.end.heading_rad;
    const Pose2 to{points[i].x(), points[i].y(), heading};
    const auto leg =
        way_within(fence_, {avoidance_, vehicle_.planning_radius_m()}, all.end, to, hazards);
    if (!leg || !all.path.append(leg->path)) return std::nullopt;
    all.end = leg->end;
    all.room_m = std::min(all.room_m, leg->room_m);
  }
  return all;
}

/// From where every turn leads out, or outside, any way is better than none.
bool Flight::stays_in(const FenceWay& way) const {
  return way.room_m >= -kRoundingM ||
         fence_room_m(fence_, way.path.start, vehicle_.planning_radius_m()) < 0.0;
}

std::size_t Flight::pieces_after(Instant at, Instant now) const {
  const TimedPath& old = plan_.timed;
  const auto before = old.piece(old.distance_at(now), old.distance_at(at));
  return before ? kPathSegmentsMax - before->segments.size() : 0;
}

Flight::Followed Flight::follow(Instant at, const std::vector<Vec2>& waypoints,
                                const std::vector<Hazard>& hazards, double range_m, Instant now) {
  Path route = forced_way(pose_at(at), hazards);
  const std::size_t pieces_max = pieces_after(at, now);
  const bool homeward = std::isinf(range_m);
  Followed followed;
  std::vector<double> marks;
  std::vector<Path> before;  // each mark
  Pose2 from = route.end();
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    const auto next = i + 1 < waypoints.size() ? std::optional{waypoints[i + 1]} : std::nullopt;
    const auto leg = way_to(from, waypoints[i], next, hazards);
    // A point that cannot be reached clear of hazards and within the fence is left out; what has no
    // room on a path is planned before that ends.
    before.push_back(route);
    if (!leg || (!homeward && !stays_in(*leg))) {
      marks.push_back(route.length_m());
      continue;
    }
    const double length_m = route.length_m() + leg->path.length_m();
    if (!homeward && length_m + way_home_m(leg->end, hazards) > range_m) break;
    if (!append_within(pieces_max, route, leg->path)) {
      followed.full = !marks.empty();
      break;
    }
    marks.push_back(route.length_m());
    from = leg->end;
    followed.reaches_last = i + 1 == waypoints.size();
  }
  double tail = append_hold(route, hazards, pieces_max);
  // It may end where one cannot orbit, and have no room for the way to where one can, or there may
  // be none: it ends before, and goes on from there.
  while (!marks.empty() && !is_clear_orbit(route.end(), tail, hazards)) {
    marks.pop_back();
    route = before[marks.size()];
    followed.full = !marks.empty() || waypoints.size() > 1;
    followed.reaches_last = false;
    tail = append_hold(route, hazards, pieces_max);
    if (marks.empty()) {  // even the first: it is left out
      marks.push_back(route.length_m());
      break;
    }
  }
  if (!continue_with(at, route, tail, now)) return {};
  const double lead = plan_.timed.path.length_m() - route.length_m();
  search_marks_.clear();
  for (const double mark : marks) search_marks_.push_back(lead + mark);
  return followed;
}

std::optional<FlightPlan> Flight::poll_plan() {
  if (!std::exchange(fresh_, false)) return std::nullopt;
  return plan_;
}

}  // namespace skein::mission
