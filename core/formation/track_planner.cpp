// SPDX-License-Identifier: Apache-2.0
#include "skein/formation/track_planner.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "skein/formation/place_assignment.hpp"
#include "skein/planning/arrival.hpp"
#include "track_checks.hpp"

namespace skein::formation {
namespace {

/// Times of joining that are tried, and the step between them.
constexpr int kTries = 12;
constexpr double kTryStep_s = 5.0;

class Planner {
 public:
  explicit Planner(const TrackRequest& request) : request_{request}, rules_{request.rules} {}

  Result<PlannedTrack> plan() {
    if (request_.planes.empty()) {
      return Error{"no plane is heard; is the team switched on and in range?"};
    }
    if (auto held = check_heights(request_); !held) return held.error();
    if (auto laid = lay_out(); !laid) return laid.error();
    if (auto placed = give_places(); !placed) return placed.error();
    for (std::size_t i = 0; i < planes().size(); ++i) {
      if (auto held = check_place(planes()[i], rules_, places_[i], planned_.centre); !held) {
        return held.error();
      }
    }
    if (auto apart = check_rigid(); !apart) return apart.error();
    return join();
  }

 private:
  [[nodiscard]] const std::vector<TrackPlane>& planes() const { return request_.planes; }

  /// The track, and how far its centre has come when the last place is on it.
  Result<void> lay_out() {
    const auto path = track_path(request_.track, request_.laps);
    if (!path) return path.error();
    TimedPath& centre = planned_.centre;
    centre.start_time = request_.start;
    centre.speed_mps = request_.speed_mps;
    centre.path = *path;
    centre.tail_curvature_per_m = 1.0 / request_.track.turn_radius_m;
    auto places = track_places(request_.shape, planes().size());
    if (!places) return places.error();
    places_ = *std::move(places);
    for (const TrackPlace& place : places_) entry_m_ = std::max(entry_m_, -place.ahead_m);
    const double length_m = path->length_m();
    for (const TrackPlace& place : places_) {
      if (entry_m_ + place.ahead_m <= length_m) continue;
      return Error{"the formation is longer than the track; fly closer together or a longer one"};
    }
    // To the other side, where hazards are in the way of the orbit.
    if (!orbit_is_clear()) centre.tail_curvature_per_m *= -1.0;
    return {};
  }

  [[nodiscard]] bool orbit_is_clear() const {
    const TimedPath& centre = planned_.centre;
    return std::all_of(places_.begin(), places_.end(), [&](const TrackPlace& place) {
      const double pace = pace_at(place, centre.tail_curvature_per_m);
      const Pose2 end = centre.path.end();
      const Vec2 at = end.position() + place.left_m * left_of(unit_vector(end.heading_rad));
      Path orbit{{at.x(), at.y(), end.heading_rad}, {}};
      const double curvature = centre.tail_curvature_per_m / pace;
      static_cast<void>(orbit.append(Segment{curvature, 6.3 / std::abs(curvature)}));
      std::vector<Hazard> circles = rules_.hazards;
      for (Hazard& circle : circles) circle.radius_m = rules_.avoidance.safety_radius_m(circle);
      return pace > 0.0 && planning::is_clear(orbit, circles);
    });
  }

  /// Where a place is when the centre has come so far.
  [[nodiscard]] Pose2 entry_of(const TrackPlace& place) const {
    const Pose2 on_track = planned_.centre.path.pose_at(entry_m_ + place.ahead_m);
    const Vec2 at = on_track.position() + place.left_m * left_of(unit_vector(on_track.heading_rad));
    return {at.x(), at.y(), on_track.heading_rad};
  }

  /// By least squared ways.
  Result<void> give_places() {
    std::vector<Vec3> from;
    std::vector<Vec3> to;
    for (std::size_t i = 0; i < planes().size(); ++i) {
      const Pose2 here = planes()[i].flies.pose_at(request_.start);
      const Pose2 there = entry_of(places_[i]);
      from.emplace_back(here.x_m, here.y_m, 0.0);
      to.emplace_back(there.x_m, there.y_m, 0.0);
    }
    const auto assigned = assign_places({}, from, to, Random{1});
    if (!assigned) return assigned.error();
    std::vector<TrackPlace> given;
    for (const int place : assigned->place_of) {
      given.push_back(places_[static_cast<std::size_t>(place)]);
    }
    places_ = std::move(given);
    return {};
  }

  /// How the places move among each other does not depend on when they are joined.
  Result<void> check_rigid() {
    PlannedTrack rigid;
    rigid.centre = planned_.centre;
    rigid.centre.start_time = request_.start - from_seconds(entry_m_ / planned_.centre.speed_mps);
    for (std::size_t i = 0; i < planes().size(); ++i) {
      TimedPath timed;
      timed.start_time = request_.start;
      timed.speed_mps = request_.speed_mps;
      const Pose2 entry = entry_of(places_[i]);
      timed.path.start = entry;
      if (!append_placed(timed, rigid.centre, places_[i], entry_m_)) return too_many_pieces();
      rigid.flights.push_back({planes()[i], places_[i], timed});
    }
    const auto least = check_places_apart(rigid, rules_, request_.start);
    if (!least) return least.error();
    planned_.least_separation_m = *least;
    return {};
  }

  // --- joining ---

  struct Speeds {
    double low_mps = 0.0;
    double high_mps = 0.0;
    double liked_mps = 0.0;
  };
  /// Over the ground, on the way to its place.
  [[nodiscard]] Speeds speeds_of(const VehicleSpec& spec) const {
    const double low = spec.speed_min_mps + rules_.wind_mps;
    const double high = std::max(low, spec.speed_max_mps - rules_.wind_mps);
    return {low, high, std::clamp(spec.cruise_speed_mps, low, high)};
  }

  [[nodiscard]] planning::Transit transit_of(std::size_t i) const {
    const TrackPlane& plane = planes()[i];
    return {plane.flies.pose_at(request_.start), entry_of(places_[i]),
            plane.spec.planning_radius_m(), plane.range_left_m, rules_.hazards};
  }

  /// A way of some length that takes exactly so long.
  [[nodiscard]] Result<Path> way_in(std::size_t i, double seconds) const {
    const Speeds speeds = speeds_of(planes()[i].spec);
    const planning::Transit transit = transit_of(i);
    auto length =
        planning::least_length_from(rules_.avoidance, transit, speeds.liked_mps * seconds);
    if (!length || *length > speeds.high_mps * seconds) {
      length = planning::least_length_from(rules_.avoidance, transit, speeds.low_mps * seconds);
    }
    if (!length) return length.error();
    if (*length > speeds.high_mps * seconds) return Error{"it cannot be there in time"};
    return planning::path_of_length(rules_.avoidance, transit, *length);
  }

  Result<PlannedTrack> join() {
    double seconds = 0.0;
    for (std::size_t i = 0; i < planes().size(); ++i) {
      const planning::Transit transit = transit_of(i);
      const auto shortest = planning::shortest_clear_length(
          rules_.avoidance, transit.from, transit.to, transit.radius_m, transit.hazards);
      if (!shortest) {
        return Error{vehicle_name(planes()[i]) +
                     " finds no way to its place on the track: " + shortest.error().message};
      }
      seconds = std::max(seconds, *shortest / speeds_of(planes()[i].spec).liked_mps);
    }
    std::string why;
    for (int k = 0; k < kTries; ++k, seconds += kTryStep_s) {
      auto tried = joined_in(seconds);
      if (tried) return tried;
      why = tried.error().message;
    }
    return Error{why +
                 "; give the planes heights of their own, separation_m apart and more, or "
                 "lead the track's beginning elsewhere"};
  }

  [[nodiscard]] Result<PlannedTrack> joined_in(double seconds) const {
    PlannedTrack planned = planned_;
    planned.joined = request_.start + from_seconds(seconds);
    planned.centre.start_time = planned.joined - from_seconds(entry_m_ / planned.centre.speed_mps);
    planned.ends = planned.centre.end_time();
    for (std::size_t i = 0; i < planes().size(); ++i) {
      const auto way = way_in(i, seconds);
      if (!way) {
        return Error{vehicle_name(planes()[i]) +
                     " finds no way to its place on the track: " + way.error().message};
      }
      TimedPath timed;
      timed.start_time = request_.start;
      timed.speed_mps = request_.speed_mps;
      timed.path.start = way->start;
      const double pace = way->length_m() / seconds / request_.speed_mps;
      if (!timed.append(*way, pace) ||
          !append_placed(timed, planned.centre, places_[i], entry_m_)) {
        return too_many_pieces();
      }
      if (auto held = check_way(planes()[i], rules_, timed); !held) return held.error();
      planned.flights.push_back({planes()[i], places_[i], timed});
    }
    auto conflict = conflict_on_ways(planned, rules_, request_.start, planned.joined);
    if (conflict) return Error{*std::move(conflict)};
    return planned;
  }

  const TrackRequest& request_;
  const TrackRules& rules_;
  PlannedTrack planned_;
  std::vector<TrackPlace> places_;  ///< in the order of shapes, and then of planes
  double entry_m_ = 0.0;            ///< of the centre, when all are in their places
};

}  // namespace

Result<PlannedTrack> plan_track(const TrackRequest& request) { return Planner{request}.plan(); }

}  // namespace skein::formation
