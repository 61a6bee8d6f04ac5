// SPDX-License-Identifier: Apache-2.0
#include "task_leg.hpp"

#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "free_start.hpp"
#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"
#include "skein/planning/dubins.hpp"

namespace skein::planning {
namespace {

constexpr int kArcStarts = 24;

std::string name(const Site& site) { return "site " + std::to_string(site.id.value); }

/// The start angle of an arc that is tried among hazards as number `index`: the nearest point
/// first, then round.
double arc_start_rad(const Site& site, const Pose2& from, int index) {
  const Vec2 out = from.position() - site.position;
  const double nearest = out.norm() > 0.0 ? std::atan2(out.y(), out.x()) : 0.0;
  return index == 0 ? nearest : wrap_pi(nearest + index * kTwoPi / kArcStarts);
}

/// As shortest_clear_path, with the way that was found.
Result<Leg> leg_to(const AvoidanceParams& params, const Departure& departure,
                   const TaskPath& task) {
  const std::span<const Hazard> hazards = departure.hazards;
  Path run{.start = task.entry, .segments = {}};
  SKEIN_ASSERT(run.append(task.run));
  if (const Hazard* entered = first_entered(run, hazards)) {
    return Error{"The run itself enters hazard " + std::to_string(entered->id.value)};
  }
  const DubinsPath direct = shortest_dubins(departure.from, task.entry, departure.radius_m);
  if (out_of_reach(params, departure.from, task.entry, direct.length_m(), hazards)) {
    return Leg{task, direct.length_m(), {}};
  }
  auto found = find_clear_path(params, departure.from, task.entry, departure.radius_m, hazards,
                               departure.ways);
  if (!found) return found.error();
  Path whole = found->way_out;
  if (!whole.append(found->path)) return Error{"The path has too many pieces"};
  return Leg{task, whole.length_m(), std::move(*found)};
}

}  // namespace

Result<TaskPath> fixed_arc(const Site& site, double start_rad, Duration dwell, double arc_radius_m,
                           double planning_radius_m, double speed_mps, int turn) {
  if (arc_radius_m < planning_radius_m) {
    return Error{"The arc around " + name(site) + " has a radius of " +
                 std::to_string(std::lround(arc_radius_m)) + " m, less than the turn radius of " +
                 std::to_string(std::lround(planning_radius_m)) + " m"};
  }
  return arc_path(site, start_rad, dwell, arc_radius_m, speed_mps, turn);
}

Result<Leg> leg_to_arc(const AvoidanceParams& params, const Departure& departure,
                       double arc_radius_m, double speed_mps, const Site& site,
                       const ArcRequirement& arc, int turn, ArcStarts starts) {
  const auto task_from = [&](double start_rad) {
    return fixed_arc(site, start_rad, arc.dwell, arc_radius_m, departure.radius_m, speed_mps, turn);
  };
  if (arc.start_angle_rad) {
    const auto task = task_from(*arc.start_angle_rad);
    return task ? leg_to(params, departure, *task) : task.error();
  }
  if (auto task = task_from(0.0); !task) return task.error();
  std::optional<Result<Leg>> best;
  double least_m = 0.0;
  if (starts == ArcStarts::best) {
    const FreeStart plain =
        shortest_to_circle(departure.from, departure.radius_m, site.position, arc_radius_m, turn);
    best = leg_to(params, departure, *task_from(plain.start_rad));
    least_m = plain.least_m;
  }
  for (int i = 0; i < kArcStarts; ++i) {
    const auto task = task_from(arc_start_rad(site, departure.from, i));
    const double direct_m = shortest_dubins_length(departure.from, task->entry, departure.radius_m);
    if (best && *best && direct_m >= (*best)->shortest_m) continue;
    auto leg = leg_to(params, departure, *task);
    if (!best || (leg && (!*best || leg->shortest_m < (*best)->shortest_m))) best = std::move(leg);
  }
  if (*best) (*best)->slack_m = (*best)->shortest_m - least_m;
  return std::move(*best);
}

Result<Leg> leg_of(const AvoidanceParams& params, const Candidate& vehicle,
                   const Departure& departure, const Site& site, const TaskId& task) {
  if (task.kind == TaskKind::deliver && task.index < site.deliveries.size()) {
    return leg_to(params, departure,
                  delivery_path(site, site.deliveries[task.index], vehicle.final_approach_m));
  }
  if (task.kind == TaskKind::assess && task.index < site.assessments.size()) {
    return leg_to_arc(params, departure, vehicle.assess_radius_m, vehicle.speed_mps, site,
                      site.assessments[task.index], kAssessmentSense, ArcStarts::best);
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
