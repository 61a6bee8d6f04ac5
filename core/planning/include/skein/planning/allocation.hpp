// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/domain/hazard.hpp"
#include "skein/domain/site.hpp"
#include "skein/domain/task.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/planning/avoidance.hpp"

namespace skein::planning {

/// A vehicle that may be given tasks, as its bid describes it.
struct Candidate {
  VehicleId id;
  Pose2 pose;  ///< predicted for AllocationProblem::start
  double speed_mps = 0.0;
  double planning_radius_m = 0.0;
  double range_left_m = 0.0;
  double final_approach_m = 0.0;
  double assess_radius_m = 0.0;
  Capabilities capabilities;
  std::uint8_t loads = 0;
};

struct AllocationProblem {
  Site site;
  std::vector<TaskId> open_tasks;  ///< of that site, none of them surveys
  std::vector<Candidate> candidates;
  std::vector<Hazard> hazards;
  Instant start{};              ///< t_e: when the candidates are at their predicted poses
  Instant earliest_delivery{};  ///< no delivery before it (the operator needs time to decide)
  /// When the last delivery of the site was or will be flown by somebody outside this problem;
  /// assessments wait for it too.
  Instant deliveries_done{};
};

struct AllocationParams {
  AvoidanceParams avoidance;
  /// Lengths are raised by this factor before a time is promised, so that the wind can be paid for.
  double time_margin = 1.01;
};

struct Allocation {
  std::vector<TaskAssignment> assignments;  ///< by task, each open task once
  double first_delivery_s = 0.0;            ///< after the problem's start; 0 without deliveries
};

/// Vehicles to tasks, one task each: deliveries by bottleneck assignment (the earliest common time,
/// then the least sum of lengths), then assessments among the rest. Every time is one that the
/// vehicle can fly exactly (path_of_length succeeds), within its range. Deterministic: ties by id.
/// Fails with what is missing ("site 2 needs 6 deliveries: 4 of 9 candidates can deliver").
/// Cost: O(tasks * candidates) paths and O(n^3) per assignment.
[[nodiscard]] Result<Allocation> allocate(const AllocationParams& params,
                                          const AllocationProblem& problem);

/// The path of one assignment, from where the vehicle is at `start`: to the task's entry, timed,
/// and the task's run. `gate_m` is where the run begins: a delivery does not pass it unauthorised.
struct TaskPlan {
  TimedPath timed;      ///< transit + run, tail = orbit of the planning radius to the left
  double gate_m = 0.0;  ///< distance along timed.path at which the task's run begins
};
[[nodiscard]] Result<TaskPlan> plan_task(const AllocationParams& params, const Candidate& vehicle,
                                         Instant start, const Site& site,
                                         const TaskAssignment& assignment,
                                         std::span<const Hazard> hazards);

/// The path that surveys the site soonest, in either sense; its start angle is the required one, or
/// the best. After the arc it goes on around the site.
[[nodiscard]] Result<TaskPlan> plan_survey(const AllocationParams& params,
                                           const VehicleSpec& vehicle, const Pose2& from,
                                           Instant start, const Site& site,
                                           std::span<const Hazard> hazards);

}  // namespace skein::planning
