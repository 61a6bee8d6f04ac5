// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "skein/formation/track_planner.hpp"

/// What both planners of tracks need, and are held to.
namespace skein::formation {

[[nodiscard]] std::string vehicle_name(const TrackPlane& plane);
/// To one decimal.
[[nodiscard]] std::string in_tenths(double value);

/// The shape's places as they lie to a track, in the order in which they are filled.
[[nodiscard]] Result<std::vector<TrackPlace>> track_places(const ShapeSpec& shape, std::size_t n);

/// Can the plane fly a piece of that curvature at that ground speed?
[[nodiscard]] Result<void> check_piece(const TrackPlane& plane, const TrackRules& rules,
                                       double curvature_per_m, double speed_mps);
/// Its place on all pieces of the centre's path, and in the orbit at the end.
[[nodiscard]] Result<void> check_place(const TrackPlane& plane, const TrackRules& rules,
                                       const TrackPlace& place, const TimedPath& centre);
/// Its whole way: clear of hazards, the orbit included, and within its range.
[[nodiscard]] Result<void> check_way(const TrackPlane& plane, const TrackRules& rules,
                                     const TimedPath& timed);
/// Heights: below the ceiling, and others than those of silent planes.
[[nodiscard]] Result<void> check_heights(const TrackRequest& request);

/// The place's way from where the centre has flown `centre_m` on.
[[nodiscard]] bool append_placed(TimedPath& timed, const TimedPath& centre, const TrackPlace& place,
                                 double centre_m);
[[nodiscard]] Error too_many_pieces();

/// When the centre is at the end of the track and once around the orbit there.
[[nodiscard]] Instant end_of_orbit(const TimedPath& centre);

/// Where the paths lead from one moment to another, at equal steps.
class SampledWays {
 public:
  SampledWays(Instant from, Instant to) : from_{from}, to_{to} {}
  void add(const TimedPath& timed);
  /// The least distance of the a-th and b-th from `since` on; nothing that is nearer by more than
  /// kMissed_m happens between.
  struct Closest {
    double apart_m = 0.0;
    Instant at{};
  };
  [[nodiscard]] Closest closest(std::size_t a, std::size_t b, Instant since) const;
  static constexpr double kMissed_m = 0.2;

 private:
  Instant from_;
  Instant to_;
  std::vector<std::vector<Vec2>> ways_;
};

/// To the side, of references that planes may be off by tracking_m.
[[nodiscard]] double needed_m(const TrackRules& rules);
[[nodiscard]] bool apart_in_height(const TrackPlane& a, const TrackPlane& b,
                                   const TrackRules& rules);

/// The least distance of any two once all are in their places; fails where it is too small.
[[nodiscard]] Result<double> check_places_apart(const PlannedTrack& planned,
                                                const TrackRules& rules, Instant since);
/// From `start` on, each new way to the others' new ways until `joined`, and to what they fly now.
/// What comes too near, or nothing.
[[nodiscard]] std::optional<std::string> conflict_on_ways(const PlannedTrack& planned,
                                                          const TrackRules& rules, Instant start,
                                                          Instant joined);

}  // namespace skein::formation
