// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/domain/hazard.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/formation/limits.hpp"
#include "skein/formation/shapes.hpp"
#include "skein/formation/track.hpp"
#include "skein/idl/formation.hpp"
#include "skein/planning/avoidance.hpp"

namespace skein::formation {

/// A plane that is to fly in a formation.
struct TrackPlane {
  VehicleSpec spec;
  TimedPath flies;            ///< the plan that it follows now
  double range_left_m = 0.0;  ///< that it may use up
};

/// What planes are held to.
struct TrackRules {
  /// Two planes are apart by their heights, or to the side. In their places they are apart to the
  /// side whatever their heights are.
  Separation separation;
  double tracking_m = 5.0;  ///< how far a plane may be from where its plan has it
  double wind_mps = 0.0;    ///< that their airspeeds leave room for, gusts and corrections included
  double ceiling_m = 120.0;
  planning::AvoidanceParams avoidance;
  std::vector<Hazard> hazards;
};

struct TrackRequest {
  Track track;
  int laps = 1;            ///< of a closed one
  double speed_mps = 0.0;  ///< of the centre, over the ground; > 0
  ShapeSpec shape;         ///< its heading is the track's; heights are the planes' own
  Instant start{};         ///< when all leave what they fly now
  std::vector<TrackPlane> planes;
  std::vector<TrackPlane> silent;  ///< nobody knows where they fly: others keep to other heights
  TrackRules rules;
};

struct TrackFlightPlan {
  TrackPlane plane;
  TrackPlace place;
  TimedPath timed;  ///< from TrackRequest::start on: to its place, along the track, the orbit
};

/// A formation that flies along a track, as it was checked.
struct PlannedTrack {
  TimedPath centre;  ///< `joined` is in it; before that it is of no meaning
  std::vector<TrackFlightPlan> flights;
  Instant joined{};                 ///< all are in their places
  Instant ends{};                   ///< of the track; then all orbit
  double least_separation_m = 0.0;  ///< to the side, of any two in their places
};

/// Ways for all planes from what they fly now into their places and along the track, and the proof:
/// turn radii, speeds, range, hazards, and separation between any two, sampled so that nothing
/// above 0.2 m is missed. As nobody waits for the others to have heard, each new way is checked
/// against what the others fly now, too. Fails with what is wrong and what to change.
/// Cost: some 10 ms for 5 planes; in proportion to the square of their number.
[[nodiscard]] Result<PlannedTrack> plan_track(const TrackRequest& request);

/// The same formation in another shape: all slide into their new places along the first straight
/// piece of the track that has the room. Planes that are not among `planes` any more are left out;
/// what those fly now is not read, but taken from `present`.
[[nodiscard]] Result<PlannedTrack> plan_reshape(const PlannedTrack& present,
                                                const TrackRequest& request);

}  // namespace skein::formation
