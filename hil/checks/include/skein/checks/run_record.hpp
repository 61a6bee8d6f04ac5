// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"
#include "skein/domain/fence.hpp"
#include "skein/domain/hazard.hpp"
#include "skein/domain/site.hpp"
#include "skein/domain/task.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/mission/messages.hpp"
#include "skein/recording/recording.hpp"

namespace skein::checks {

/// A vehicle's program ended during the mission, on purpose; what the vehicle did then is unknown.
struct AgentEnd {
  VehicleId vehicle;
  Instant at{};
  std::optional<Instant> restarted_at;  ///< with a new agent that remembers nothing
};

/// For so long no program of a vehicle ran, or it stood still, for all or much of that time, or a
/// pilot had it: its autopilot had it alone.
struct LeftAlone {
  VehicleId vehicle;
  Instant from{};
  Instant until{};
};

/// A task that need not be done.
struct Excuse {
  TaskId task;
  std::string why;
};

/// The operator's decision against a site's deliveries has reached a vehicle: a refusal, or a grant
/// taken back.
struct RefusalHeard {
  VehicleId vehicle;
  SiteId site;
  std::string by;
  Instant at{};
};

/// Where a route that was planned before the mission is to end.
struct RouteEnd {
  VehicleId vehicle;
  Vec2 site{0.0, 0.0};
  double heading_rad = 0.0;  ///< direction of travel over it
  Instant planned{};
  Duration offset{};  ///< required, from the common time
};

/// A finished mission: what it was to be, and what was recorded of it.
struct RunRecord {
  std::vector<Site> sites;
  std::vector<TimedHazard> hazards;
  Fence fence = {};
  std::vector<VehicleSpec> vehicles;
  std::vector<recording::Recording> recordings;   ///< of vehicles, in any order
  std::vector<recording::Recording> truths = {};  ///< what simulated aircraft really did: tracks
  std::vector<mission::MissionEvent> ground_events;
  std::vector<RouteEnd> route_ends = {};
  std::vector<recording::PlaceRecord> places = {};  ///< of a formation, by the ground station
  std::vector<VehicleId> lost;  ///< vehicles that the bench ended on purpose before the mission did
  std::vector<AgentEnd> agent_ends;  ///< in the order of time
  /// By processes, or to pilots. In virtual time a program ends only where what its autopilot does
  /// then is safe.
  std::vector<LeftAlone> left_alone = {};
  /// Programs in virtual time, in the order of time: their aircraft flew on by what they had said.
  std::vector<LeftAlone> stood_still = {};
  std::vector<Excuse> excused = {};
  /// As whoever watches the network saw it, where somebody did; in the order of time.
  std::vector<RefusalHeard> refusals = {};
};

/// Of this vehicle; null where there is none.
[[nodiscard]] const recording::Recording* recording_of(
    const std::vector<recording::Recording>& recordings, VehicleId vehicle);
[[nodiscard]] inline const recording::Recording* recording_of(const RunRecord& record,
                                                              VehicleId vehicle) {
  return recording_of(record.recordings, vehicle);
}

/// The vehicle was, somewhere within that time.
[[nodiscard]] bool was_left_alone(const RunRecord& record, VehicleId vehicle, Instant from,
                                  Instant until);

/// What a mission is held to.
struct Limits {
  double turn_share = 0.03;    ///< flown tighter than the turn radius by at most this share
  double turn_window_s = 1.0;  ///< over which a flown turn is measured
  double plan_jump_m = 10.0;   ///< between two plans where one replaces the other
  double plan_jump_rad = radians(15.0);
  double hazard_reaction_s = 1.0;  ///< from learning of a hazard to a plan that avoids it
  double hazard_leaving_s = 1.0;   ///< more than the shortest way out of a hazard may take
  double planned_time_s = 0.05;    ///< to which planned times must keep the site's offsets
  double arrival_s = 1.0;          ///< flown against planned or required times
  double bearing_rad = radians(5.0);
  double miss_m = 30.0;             ///< horizontal distance from the site at a delivery
  double delivery_window_s = 10.0;  ///< around the planned time, where the pass is looked for
  double arc_radius_share = 0.10;
  double separation_horizontal_m = 30.0;  ///< below both of these at once is a breach
  double separation_vertical_m = 20.0;
  double place_rms_m = 0.3;       ///< from its place, of any vehicle while a formation holds
  double arrival_spread_s = 0.3;  ///< from the first vehicle in its place to the last
  Capabilities copters_fly;       ///< kinds of tasks of which copters have flown one at least
  double glide_ratio = 10.0;      ///< flown per metre of height by who lands, at most
  double track_gap_s = 1.0;       ///< a longer gap in a track cannot be judged
  /// From the start of a program, or from when it goes on, until it has its vehicle where it wants
  /// it: it waits for the link to the autopilot, plans, and flies back from where that had it.
  double taken_up_s = 10.0;
};

}  // namespace skein::checks
