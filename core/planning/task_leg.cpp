// SPDX-License-Identifier: Apache-2.0
#include "task_leg.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"

namespace skein::planning {
namespace {

std::string name(const Site& site) { return "site " + std::to_string(site.id.value); }

Result<Leg> leg_to(const AvoidanceParams& params, const Pose2& from, double radius_m,
                   const TaskPath& task, std::span<const Hazard> hazards) {
  Path run{.start = task.entry, .segments = {}};
  SKEIN_ASSERT(run.append(task.run));
  if (const Hazard* entered = first_entered(run, hazards)) {
    return Error{"The run itself enters hazard " + std::to_string(entered->id.value)};
  }
  const auto path = shortest_clear_path(params, from, task.entry, radius_m, hazards);
  if (!path) return path.error();
  return Leg{task, path->length_m()};
}

}  // namespace

double arc_start_rad(const Site& site, const Pose2& from, int index) {
  const Vec2 out = from.position() - site.position;
  const double nearest = out.norm() > 0.0 ? std::atan2(out.y(), out.x()) : 0.0;
  return index == 0 ? nearest : wrap_pi(nearest + index * kTwoPi / kArcStarts);
}

Result<TaskPath> fixed_arc(const Site& site, double start_rad, Duration dwell, double arc_radius_m,
                           double planning_radius_m, double speed_mps, int turn) {
  if (arc_radius_m < planning_radius_m) {
    return Error{"The arc around " + name(site) + " has a radius of " +
                 std::to_string(std::lround(arc_radius_m)) + " m, less than the turn radius of " +
                 std::to_string(std::lround(planning_radius_m)) + " m"};
  }
  return arc_path(site, start_rad, dwell, arc_radius_m, speed_mps, turn);
}

Result<Leg> leg_to_arc(const AvoidanceParams& params, const Pose2& from, double planning_radius_m,
                       double arc_radius_m, double speed_mps, const Site& site,
                       const ArcRequirement& arc, int turn, std::span<const Hazard> hazards) {
  const auto from_angle = [&](double start_rad) -> Result<Leg> {
    const auto task =
        fixed_arc(site, start_rad, arc.dwell, arc_radius_m, planning_radius_m, speed_mps, turn);
    if (!task) return task.error();
    return leg_to(params, from, planning_radius_m, *task, hazards);
  };
  if (arc.start_angle_rad) return from_angle(*arc.start_angle_rad);
  Result<Leg> best = from_angle(arc_start_rad(site, from, 0));
  for (int i = 1; i < kArcStarts; ++i) {
    auto leg = from_angle(arc_start_rad(site, from, i));
    if (leg && (!best || leg->shortest_m < best->shortest_m)) best = std::move(leg);
  }
  return best;
}

Result<Leg> leg_of(const AvoidanceParams& params, const Candidate& vehicle, const Site& site,
                   const TaskId& task, std::span<const Hazard> hazards) {
  if (task.kind == TaskKind::deliver && task.index < site.deliveries.size()) {
    return leg_to(params, vehicle.pose, vehicle.planning_radius_m,
                  delivery_path(site, site.deliveries[task.index], vehicle.final_approach_m),
                  hazards);
  }
  if (task.kind == TaskKind::assess && task.index < site.assessments.size()) {
    return leg_to_arc(params, vehicle.pose, vehicle.planning_radius_m, vehicle.assess_radius_m,
                      vehicle.speed_mps, site, site.assessments[task.index], kAssessmentSense,
                      hazards);
  }
  return Error{name(site) + " has no task '" + to_string(task) + "' to plan"};
}

double timed_run_m(TaskKind kind, const TaskPath& task) {
  return kind == TaskKind::deliver ? task.run.length_m : 0.0;
}

Transit transit_of(const Candidate& vehicle, const TaskPath& task,
                   std::span<const Hazard> hazards) {
  return {vehicle.pose, task.entry, vehicle.planning_radius_m,
          vehicle.range_left_m - task.run.length_m, hazards};
}

double transit_length_m(const Candidate& vehicle, TaskKind kind, const TaskPath& task,
                        Instant start, Instant time) {
  return vehicle.speed_mps * to_seconds(time - start) - timed_run_m(kind, task);
}

}  // namespace skein::planning
