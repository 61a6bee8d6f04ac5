// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/allocation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "skein/base/angles.hpp"
#include "skein/planning/arrival.hpp"
#include "skein/planning/assignment.hpp"
#include "skein/planning/task_path.hpp"

namespace skein::planning {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kRoundsMax = 12;           ///< of raising a time until everybody can fly it
constexpr double kLatenessWeight = 1e4;  ///< metres that a second of a late assessment is worth

bool can_do(const Candidate& v, const TaskId& task) {
  if (!v.capabilities.has(task.kind)) return false;
  return task.kind == TaskKind::deliver ? v.loads > 0 : v.assess_radius_m >= v.planning_radius_m;
}

TaskPath task_path(const Candidate& v, const Site& site, const TaskId& task) {
  if (task.kind == TaskKind::deliver) {
    return delivery_path(site, site.deliveries.at(task.index), v.final_approach_m);
  }
  const auto& arc = site.assessments.at(task.index);
  // All in one sense, so that those on one circle keep their distance.
  return arc_path(site, arc.start_angle_rad.value_or(0.0), arc.dwell, v.assess_radius_m,
                  v.speed_mps, 1);
}

Transit transit_to(const Candidate& v, const TaskPath& task, std::span<const Hazard> hazards) {
  return {v.pose, task.entry, v.planning_radius_m, v.range_left_m - task.run.length_m, hazards};
}

/// The part of the run that lies before the moment that the task's time names.
double run_before_time(const TaskId& task, const TaskPath& path) {
  return task.kind == TaskKind::deliver ? path.run.length_m : 0.0;
}

double transit_length(const Candidate& v, const TaskId& task, const TaskPath& path, Instant start,
                      Instant time) {
  return to_seconds(time - start) * v.speed_mps - run_before_time(task, path);
}

/// The first moment from `time` on at which this vehicle can do the task.
Result<Instant> next_time(const AllocationParams& params, const AllocationProblem& problem,
                          const Candidate& v, const TaskId& task, Instant time) {
  const TaskPath path = task_path(v, problem.site, task);
  const Transit transit = transit_to(v, path, problem.hazards);
  const double wanted = transit_length(v, task, path, problem.start, time);
  if (path_of_length(params.avoidance, transit, wanted)) return time;
  const auto least = least_length_from(params.avoidance, transit, wanted);
  if (!least) return least.error();
  // A little more than the least, so that rounding to nanoseconds does not fall below it again.
  return problem.start + from_seconds((*least + 0.01 + run_before_time(task, path)) / v.speed_mps);
}

std::string count_of(std::size_t n, const char* what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

struct Tables {
  Eigen::MatrixXd arrival_s;  ///< tasks x candidates, after the start; infinite where it cannot be
  Eigen::MatrixXd length_m;
};

Tables tables(const AllocationParams& params, const AllocationProblem& problem,
              const std::vector<TaskId>& tasks) {
  const auto rows = static_cast<Eigen::Index>(tasks.size());
  const auto columns = static_cast<Eigen::Index>(problem.candidates.size());
  Tables t{Eigen::MatrixXd::Constant(rows, columns, kInfinity),
           Eigen::MatrixXd::Zero(rows, columns)};
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index j = 0; j < columns; ++j) {
      const auto& v = problem.candidates[static_cast<std::size_t>(j)];
      const auto& task = tasks[static_cast<std::size_t>(i)];
      if (!can_do(v, task)) continue;
      const TaskPath path = task_path(v, problem.site, task);
      const auto way = shortest_clear_path(params.avoidance, v.pose, path.entry,
                                           v.planning_radius_m, problem.hazards);
      if (!way) continue;
      const double length = way->length_m() * params.time_margin;
      if (length + path.run.length_m > v.range_left_m) continue;
      t.length_m(i, j) = length;
      t.arrival_s(i, j) = (length + run_before_time(task, path)) / v.speed_mps;
    }
  }
  return t;
}

Result<void> enough_vehicles(const AllocationProblem& problem, const std::vector<TaskId>& tasks) {
  const std::string site = "site " + std::to_string(problem.site.id.value);
  for (const TaskKind kind : {TaskKind::deliver, TaskKind::assess}) {
    const auto wanted = static_cast<std::size_t>(std::count_if(
        tasks.begin(), tasks.end(), [kind](const TaskId& t) { return t.kind == kind; }));
    const auto able = static_cast<std::size_t>(std::count_if(
        problem.candidates.begin(), problem.candidates.end(), [&](const Candidate& v) {
          return can_do(v, {problem.site.id, kind, 0});
        }));
    if (able >= wanted) continue;
    return Error{
        site + " needs " +
        count_of(wanted, kind == TaskKind::deliver ? "delivery vehicle" : "assessment vehicle") +
        ": " + std::to_string(able) + " of " + count_of(problem.candidates.size(), "candidate") +
        " can"};
  }
  if (tasks.size() > problem.candidates.size()) {
    return Error{site + " has " + count_of(tasks.size(), "task") + " for " +
                 count_of(problem.candidates.size(), "candidate") + ", one each"};
  }
  return {};
}

}  // namespace

Result<Allocation> allocate(const AllocationParams& params, const AllocationProblem& problem) {
  std::vector<TaskId> tasks = problem.open_tasks;
  std::sort(tasks.begin(), tasks.end());
  if (const auto enough = enough_vehicles(problem, tasks); !enough) return enough.error();
  const auto is_delivery = [&](Eigen::Index i) {
    return tasks[static_cast<std::size_t>(i)].kind == TaskKind::deliver;
  };
  const auto offset = [&](const TaskId& task) {
    return problem.site.deliveries.at(task.index).offset;
  };
  const Tables table = tables(params, problem, tasks);

  // The earliest first delivery for which all deliveries and, whenever, all assessments find a
  // vehicle.
  Eigen::MatrixXd cost = table.arrival_s;
  Duration last_offset{};
  bool delivers = false;
  for (Eigen::Index i = 0; i < cost.rows(); ++i) {
    if (is_delivery(i)) {
      delivers = true;
      last_offset = std::max(last_offset, offset(tasks[static_cast<std::size_t>(i)]));
      cost.row(i).array() -= to_seconds(offset(tasks[static_cast<std::size_t>(i)]));
    } else {
      cost.row(i) =
          cost.row(i).unaryExpr([](double c) { return std::isfinite(c) ? 0.0 : c; }).eval();
    }
  }
  const auto soonest = bottleneck_assignment(cost);
  if (!soonest) {
    return Error{"site " + std::to_string(problem.site.id.value) +
                 ": the candidates cannot be shared out over the tasks within their range and "
                 "clear of hazards"};
  }
  Instant first = std::max(problem.start + from_seconds(soonest->cost), problem.earliest_delivery);
  if (!delivers) first = problem.start;

  // For that time: assessments late by as little as can be, then the least sum of lengths.
  const auto assess_from = [&] {
    return delivers
               ? std::max(first + last_offset, problem.deliveries_done) + problem.site.assess_wait
               : std::max(problem.deliveries_done + problem.site.assess_wait, problem.start);
  };
  Eigen::MatrixXd choice = table.length_m;
  for (Eigen::Index i = 0; i < choice.rows(); ++i) {
    for (Eigen::Index j = 0; j < choice.cols(); ++j) {
      const double arrival = table.arrival_s(i, j);
      if (!std::isfinite(arrival) ||
          (is_delivery(i) && cost(i, j) > to_seconds(first - problem.start) + 1e-6)) {
        choice(i, j) = kInfinity;
      } else if (!is_delivery(i)) {
        choice(i, j) +=
            kLatenessWeight * std::max(0.0, arrival - to_seconds(assess_from() - problem.start));
      }
    }
  }
  const auto best = least_sum_assignment(choice);
  if (!best) return Error{"no complete assignment for the earliest time"};

  // Every promised time must be one that the vehicle's path can be stretched to: raise them till
  // all are.
  const auto vehicle_of = [&](std::size_t i) -> const Candidate& {
    return problem.candidates[static_cast<std::size_t>(best->column_of[i])];
  };
  const auto settle = [&](TaskKind kind, Instant& base) -> Result<void> {
    for (int round = 0; round < kRoundsMax; ++round) {
      const Instant before = base;
      for (std::size_t i = 0; i < tasks.size(); ++i) {
        if (tasks[i].kind != kind) continue;
        const Duration after = kind == TaskKind::deliver ? offset(tasks[i]) : Duration{};
        const auto time = next_time(params, problem, vehicle_of(i), tasks[i], base + after);
        if (!time) {
          return Error{to_string(tasks[i]) + " by vehicle " +
                       std::to_string(vehicle_of(i).id.value) + ": " + time.error().message};
        }
        base = std::max(base, *time - after);
      }
      if (base == before) return {};
    }
    return Error{"no common time was found that everybody can fly"};
  };
  if (delivers) {
    if (const auto settled = settle(TaskKind::deliver, first); !settled) return settled.error();
  }
  Instant assess = assess_from();
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    if (tasks[i].kind != TaskKind::assess) continue;
    const double arrival = table.arrival_s(static_cast<Eigen::Index>(i), best->column_of[i]);
    assess = std::max(assess, problem.start + from_seconds(arrival));
  }
  if (const auto settled = settle(TaskKind::assess, assess); !settled) return settled.error();

  Allocation allocation;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const Instant time = tasks[i].kind == TaskKind::deliver ? first + offset(tasks[i]) : assess;
    allocation.assignments.push_back({tasks[i], vehicle_of(i).id, time});
  }
  allocation.first_delivery_s = delivers ? to_seconds(first - problem.start) : 0.0;
  return allocation;
}

Result<TaskPlan> plan_task(const AllocationParams& params, const Candidate& vehicle, Instant start,
                           const Site& site, const TaskAssignment& assignment,
                           std::span<const Hazard> hazards) {
  const TaskPath path = task_path(vehicle, site, assignment.task);
  const auto way =
      path_of_length(params.avoidance, transit_to(vehicle, path, hazards),
                     transit_length(vehicle, assignment.task, path, start, assignment.time));
  if (!way) return way.error();
  TaskPlan plan;
  plan.timed.start_time = start;
  plan.timed.speed_mps = vehicle.speed_mps;
  plan.timed.tail_curvature_per_m = 1.0 / vehicle.planning_radius_m;
  plan.timed.path = *way;
  plan.gate_m = way->length_m();
  if (!plan.timed.path.append(path.run)) return Error{"the path has too many pieces"};
  return plan;
}

Result<TaskPlan> plan_survey(const AllocationParams& params, const VehicleSpec& vehicle,
                             const Pose2& from, Instant start, const Site& site,
                             std::span<const Hazard> hazards) {
  constexpr int kAngles = 72;
  const double radius = vehicle.planning_radius_m();
  if (vehicle.sensor_radius_m < radius) {
    return Error{"the survey arc's radius (" + std::to_string(vehicle.sensor_radius_m) +
                 " m) is below the turn radius of the vehicle"};
  }
  std::optional<TaskPlan> best;
  const int angles = site.survey.start_angle_rad ? 1 : kAngles;
  for (int i = 0; i < angles; ++i) {
    const double angle = site.survey.start_angle_rad.value_or(kTwoPi * i / kAngles);
    for (const int turn : {1, -1}) {
      const TaskPath arc = arc_path(site, angle, site.survey.dwell, vehicle.sensor_radius_m,
                                    vehicle.cruise_speed_mps, turn);
      const auto way = shortest_clear_path(params.avoidance, from, arc.entry, radius, hazards);
      if (!way || (best && way->length_m() >= best->gate_m)) continue;
      TaskPlan plan;
      plan.timed.start_time = start;
      plan.timed.speed_mps = vehicle.cruise_speed_mps;
      plan.timed.tail_curvature_per_m = arc.run.curvature_per_m;
      plan.timed.path = *way;
      plan.gate_m = way->length_m();
      if (plan.timed.path.append(arc.run)) best = plan;
    }
  }
  if (!best)
    return Error{"no clear path to a survey arc around site " + std::to_string(site.id.value)};
  return *best;
}

}  // namespace skein::planning
