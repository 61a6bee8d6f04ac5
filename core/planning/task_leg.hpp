// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "avoidance_margin.hpp"
#include "skein/base/result.hpp"
#include "skein/domain/hazard.hpp"
#include "skein/domain/site.hpp"
#include "skein/domain/task.hpp"
#include "skein/planning/allocation.hpp"
#include "skein/planning/arrival.hpp"
#include "skein/planning/task_path.hpp"

/// How a vehicle gets to a task: what allocate and plan_task share, so that what was promised is
/// what is flown.
namespace skein::planning {

inline constexpr int kCounterClockwise = 1;
inline constexpr int kClockwise = -1;
/// Every assessment of a site is flown in the same sense, so that vehicles on one circle keep their
/// spacing.
inline constexpr int kAssessmentSense = kCounterClockwise;
[[nodiscard]] Result<TaskPath> fixed_arc(const Site& site, double start_rad, Duration dwell,
                                         double arc_radius_m, double planning_radius_m,
                                         double speed_mps, int turn);

/// From where a vehicle begins its ways to all tasks.
struct Departure {
  Departure(const Pose2& pose, double turn_radius_m, std::span<const Hazard> around)
      : from{pose},
        radius_m{turn_radius_m},
        hazards{around},
        ways{ways_out(pose, turn_radius_m, around)} {}

  Pose2 from;
  double radius_m;
  std::span<const Hazard> hazards;
  WaysOut ways;
};

struct Leg {
  TaskPath task;
  double shortest_m = std::numeric_limits<double>::infinity();  ///< to the task's entry
  std::optional<ClearPath> around;  ///< the way of that length, where hazards were in reach
  double slack_m = 0.0;             ///< what another start of an arc that is free may be nearer by
};

/// Which starts of an arc are tried where its angle is free: 24, or the best of all too. A survey
/// is bound by no award, and keeps to the few: its way is turned about less at the edge of a fence.
enum class ArcStarts : std::uint8_t { some, best };

/// To the arc's start; of those tried the one that is reached soonest where the angle is free.
[[nodiscard]] Result<Leg> leg_to_arc(const AvoidanceParams& params, const Departure& departure,
                                     double arc_radius_m, double speed_mps, const Site& site,
                                     const ArcRequirement& arc, int turn, ArcStarts starts);

/// How the candidate flies the task, and the least that it takes, around every hazard. The
/// departure is the candidate's.
[[nodiscard]] Result<Leg> leg_of(const AvoidanceParams& params, const Candidate& vehicle,
                                 const Departure& departure, const Site& site, const TaskId& task);
[[nodiscard]] inline Departure departure_of(const Candidate& vehicle,
                                            std::span<const Hazard> hazards) {
  return {vehicle.pose, vehicle.planning_radius_m, hazards};
}

/// What of the run lies before the moment that the task's time refers to.
[[nodiscard]] double timed_run_m(TaskKind kind, const TaskPath& task);

[[nodiscard]] Transit transit_of(const Candidate& vehicle, const TaskPath& task,
                                 std::span<const Hazard> hazards);

/// Length of the transit that brings the vehicle to the task at `time`.
[[nodiscard]] double transit_length_m(const Candidate& vehicle, TaskKind kind, const TaskPath& task,
                                      Instant start, Instant time);

}  // namespace skein::planning
