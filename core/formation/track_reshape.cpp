// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "skein/formation/place_assignment.hpp"
#include "skein/formation/track_planner.hpp"
#include "track_checks.hpp"

namespace skein::formation {
namespace {

/// Nobody slides over less of the track than this.
constexpr double kSlideLeast_m = 50.0;
/// From one length of the slide that is tried to the next.
constexpr double kSlideGrowth = 1.15;
/// Less, a place stays where it is across the track.
constexpr double kStays_m = 1e-6;

class Reshape {
 public:
  Reshape(const PlannedTrack& present, const TrackRequest& request)
      : present_{present}, request_{request}, centre_{present.centre} {}

  Result<PlannedTrack> plan() {
    if (request_.planes.empty()) {
      return Error{"no plane is heard; is the team switched on and in range?"};
    }
    if (request_.start < present_.joined) {
      return Error{"planes are still on their way to their places; wait until the formation holds"};
    }
    if (auto held = check_heights(request_); !held) return held.error();
    if (auto found = find_present(); !found) return found.error();
    if (auto placed = give_places(); !placed) return placed.error();
    for (std::size_t i = 0; i < now_.size(); ++i) {
      if (auto held = check_place(now_[i].plane, request_.rules, then_[i], centre_); !held) {
        return held.error();
      }
    }
    return slide();
  }

 private:
  Result<void> find_present() {
    for (const TrackPlane& plane : request_.planes) {
      const auto found = std::find_if(
          present_.flights.begin(), present_.flights.end(),
          [&](const TrackFlightPlan& flight) { return flight.plane.spec.id == plane.spec.id; });
      if (found == present_.flights.end()) {
        return Error{vehicle_name(plane) + " does not fly along the track; order fly-along again"};
      }
      now_.push_back(*found);
      now_.back().plane = plane;
      now_.back().plane.flies = found->timed;
    }
    return {};
  }

  /// By least squares, as places lie to the track.
  Result<void> give_places() {
    const auto places = track_places(request_.shape, now_.size());
    if (!places) return places.error();
    std::vector<Vec3> from;
    std::vector<Vec3> to;
    for (const auto& flight : now_)
      from.emplace_back(flight.place.ahead_m, flight.place.left_m, 0.0);
    for (const auto& place : *places) to.emplace_back(place.ahead_m, place.left_m, 0.0);
    const auto assigned = assign_places({}, from, to, Random{1});
    if (!assigned) return assigned.error();
    for (const int place : assigned->place_of) {
      then_.push_back((*places)[static_cast<std::size_t>(place)]);
    }
    return {};
  }

  /// How far the centre has come when a slide of that length can begin: all of it on one straight
  /// piece, for every place.
  [[nodiscard]] std::optional<double> begin_of(double slide_m) const {
    double rearmost_m = 0.0;
    double foremost_m = 0.0;
    for (std::size_t i = 0; i < now_.size(); ++i) {
      rearmost_m = std::min(rearmost_m, now_[i].place.ahead_m);
      foremost_m = std::max({foremost_m, now_[i].place.ahead_m, then_[i].ahead_m});
    }
    double begin_m = 0.0;
    for (const Segment& segment : centre_.path.segments) {
      const double end_m = begin_m + segment.length_m;
      const double from_m = std::max(begin_m - rearmost_m, centre_.distance_at(request_.start));
      begin_m = end_m;
      const bool straight = segment.curvature_per_m == 0.0;
      if (straight && from_m + slide_m + foremost_m <= end_m) return from_m;
    }
    return std::nullopt;
  }

  /// Two arcs, or a line, from one place to the other.
  struct Slide {
    double curvature_per_m = 0.0;
    double length_m = 0.0;  ///< of each of two pieces
    double speed_mps = 0.0;
  };
  [[nodiscard]] std::optional<Slide> slide_of(std::size_t i, double slide_m) const {
    const double along_m = slide_m + then_[i].ahead_m - now_[i].place.ahead_m;
    const double across_m = then_[i].left_m - now_[i].place.left_m;
    if (along_m <= std::abs(across_m)) return std::nullopt;
    Slide slide;
    slide.length_m = along_m / 2.0;
    if (std::abs(across_m) > kStays_m) {
      const double radius_m =
          (along_m * along_m + across_m * across_m) / (4.0 * std::abs(across_m));
      slide.curvature_per_m = std::copysign(1.0 / radius_m, across_m);
      slide.length_m = radius_m * 2.0 * std::atan(std::abs(across_m) / along_m);
    }
    slide.speed_mps = 2.0 * slide.length_m * centre_.speed_mps / slide_m;
    return slide;
  }

  /// Longer slides are gentler: the first that all can fly, and that keeps them apart.
  Result<PlannedTrack> slide() {
    std::string why = "the places are too far from each other";
    bool tried = false;
    for (double slide_m = kSlideLeast_m;; slide_m *= kSlideGrowth) {
      const auto begin_m = begin_of(slide_m);
      if (!begin_m) {
        const std::string room = "no straight piece of the track ahead has room to slide into ";
        return Error{room + std::string{to_string(request_.shape.kind)} + " over " +
                     in_tenths(slide_m) + " m" + (tried ? ", and over less " + why : "") +
                     "; ask for a smaller change, or give the track a longer leg"};
      }
      auto planned = over(*begin_m, slide_m);
      if (planned) return planned;
      tried = true;
      why = planned.error().message;
    }
  }

  [[nodiscard]] Result<PlannedTrack> over(double begin_m, double slide_m) const {
    PlannedTrack planned = present_;
    planned.flights.clear();
    planned.joined = centre_.time_at(begin_m + slide_m);
    for (std::size_t i = 0; i < now_.size(); ++i) {
      auto timed = way_of(i, begin_m, slide_m);
      if (!timed) return timed.error();
      if (auto held = check_way(now_[i].plane, request_.rules, *timed); !held) return held.error();
      planned.flights.push_back({now_[i].plane, then_[i], *timed});
    }
    const auto least = check_places_apart(planned, request_.rules, planned.joined);
    if (!least) return least.error();
    planned.least_separation_m = *least;
    auto conflict = conflict_on_ways(planned, request_.rules, request_.start, planned.joined);
    if (conflict) return Error{*std::move(conflict)};
    return planned;
  }

  [[nodiscard]] Result<TimedPath> way_of(std::size_t i, double begin_m, double slide_m) const {
    const TimedPath& old = now_[i].timed;
    const auto slide = slide_of(i, slide_m);
    if (!slide) return Error{"the slide is too short for " + vehicle_name(now_[i].plane)};
    for (const double curvature : {slide->curvature_per_m, -slide->curvature_per_m}) {
      if (auto held = check_piece(now_[i].plane, request_.rules, curvature, slide->speed_mps);
          !held) {
        return held.error();
      }
    }
    TimedPath timed;
    timed.start_time = request_.start;
    timed.speed_mps = old.speed_mps;
    const double from_m = old.distance_at(request_.start);
    const double to_m = old.distance_at(centre_.time_at(begin_m));
    timed.path.start = old.pose_at_distance(from_m);
    bool fits = true;
    double passed_m = 0.0;
    for (std::size_t k = 0; k < old.path.segments.size() && k < old.paces.size(); ++k) {
      const Segment& segment = old.path.segments[k];
      const double end_m = passed_m + segment.length_m;
      const double length_m = std::min(to_m, end_m) - std::max(from_m, passed_m);
      passed_m = end_m;
      fits = fits && timed.append(Segment{segment.curvature_per_m, length_m}, old.paces[k]);
    }
    const double pace = slide->speed_mps / centre_.speed_mps;
    fits = fits && timed.append(Segment{slide->curvature_per_m, slide->length_m}, pace) &&
           timed.append(Segment{-slide->curvature_per_m, slide->length_m}, pace) &&
           append_placed(timed, centre_, then_[i], begin_m + slide_m);
    if (!fits) return too_many_pieces();
    return timed;
  }

  const PlannedTrack& present_;
  const TrackRequest& request_;
  const TimedPath& centre_;
  std::vector<TrackFlightPlan> now_;
  std::vector<TrackPlace> then_;
};

}  // namespace

Result<PlannedTrack> plan_reshape(const PlannedTrack& present, const TrackRequest& request) {
  return Reshape{present, request}.plan();
}

}  // namespace skein::formation
