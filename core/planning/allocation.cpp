// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/allocation.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "allocation_table.hpp"
#include "ant_colony.hpp"
#include "coalition_baselines.hpp"
#include "exact_allocation.hpp"
#include "skein/base/assert.hpp"
#include "skein/base/random.hpp"
#include "skein/planning/arrival.hpp"
#include "skein/planning/avoidance.hpp"
#include "task_leg.hpp"

namespace skein::planning {
namespace {

constexpr double kLeft = 1.0;
constexpr std::array<std::string_view, static_cast<std::size_t>(AllocationMethod::count)>
    kMethodNames{"best", "exact", "earliest", "colony", "polynomial", "greedy"};

TaskPlan assemble(const Path& transit, const TaskPath& task, Instant start, double speed_mps,
                  double radius_m) {
  TaskPlan plan{{start, speed_mps, kLeft / radius_m, transit}, transit.length_m()};
  SKEIN_ASSERT(plan.timed.path.append(task.run));
  return plan;
}

MethodResult run(const AllocationParams& params, AllocationMethod method, AllocationTable& table,
                 const PlanningBudget& budget) {
  switch (method) {
    case AllocationMethod::exact:
      return exact_allocation(table, budget);
    case AllocationMethod::earliest:
      return earliest_allocation(table, budget);
    case AllocationMethod::colony:
      return ant_colony(params.colony, table, budget, Random{table.problem().seed});
    case AllocationMethod::polynomial:
      return polynomial_allocation(table);
    case AllocationMethod::greedy:
      return greedy_allocation(table);
    case AllocationMethod::best:
    case AllocationMethod::count:
      break;
  }
  return {};
}

struct Chosen {
  AllocationMethod method = AllocationMethod::exact;
  MethodResult result;
};

/// Exact is fast; the others are of use only where it was cut short.
Chosen run_best(const AllocationParams& params, AllocationTable& table,
                const PlanningBudget& budget) {
  Chosen best{AllocationMethod::exact, run(params, AllocationMethod::exact, table, budget)};
  for (const auto method : {AllocationMethod::greedy, AllocationMethod::colony}) {
    // Whoever chooses the vehicles, the moments are of those that exact has looked at.
    if (best.result.proven || (best.result.plan && !best.result.cut)) break;
    // Where exact found a plan but not the time to finish, there is none for the others.
    if (best.result.plan && budget.is_spent(0)) break;
    MethodResult other = run(params, method, table, budget);
    if (!other.plan) continue;
    if (best.result.plan && other.plan->value <= best.result.plan->value) continue;
    best.method = method;
    best.result.plan = std::move(other.plan);
  }
  return best;
}

Error no_plan(const Chosen& chosen, AllocationTable& table, const PlanningBudget& budget) {
  const AllocationMethod method = chosen.method;
  const bool tries_all = method == AllocationMethod::exact || method == AllocationMethod::earliest;
  const bool feasible_by_count = quick_bound(table) > -std::numeric_limits<double>::infinity();
  if (feasible_by_count && !chosen.result.proven &&
      (tries_all || (method == AllocationMethod::colony && budget.is_spent(0)))) {
    return Error{table.name() + ": no plan was found within the planning budget; there may be one"};
  }
  // So far the lengths may have been lower bounds: the reason may be hazards.
  table.measure_all();
  if (auto error = table.missing()) return *error;
  const std::string deliveries = std::to_string(table.deliveries());
  if (quick_bound(table) == -std::numeric_limits<double>::infinity()) {
    return Error{table.name() + ": the candidates can fly some of its " + deliveries +
                 " deliveries, but not all of them together"};
  }
  return Error{
      table.name() +
      (tries_all ? ": it is proven that there are no times "
                 : ": no times were found by the method " + std::string{to_string(method)} + " ") +
      "at which " + std::to_string(table.columns()) + " candidates could fly its " + deliveries +
      " deliveries and " + std::to_string(table.assessments()) +
      " assessments within their ranges"};
}

}  // namespace

std::string_view to_string(AllocationMethod method) {
  const auto index = static_cast<std::size_t>(method);
  return index < kMethodNames.size() ? kMethodNames[index] : "unknown";
}

std::optional<AllocationMethod> allocation_method(std::string_view name) {
  const auto found = std::find(kMethodNames.begin(), kMethodNames.end(), name);
  if (found == kMethodNames.end()) return std::nullopt;
  return static_cast<AllocationMethod>(found - kMethodNames.begin());
}

Result<Allocation> allocate(const AllocationParams& params, const AllocationProblem& problem,
                            const PlanningBudget& budget) {
  auto made = AllocationTable::make(params, problem);
  if (!made) return made.error();
  AllocationTable& table = *made;
  if (table.rows() == 0) return Error{table.name() + " has no open task"};
  if (auto error = table.missing()) return *error;
  const Chosen chosen = params.method == AllocationMethod::best
                            ? run_best(params, table, budget)
                            : Chosen{params.method, run(params, params.method, table, budget)};
  if (!chosen.result.plan) return no_plan(chosen, table, budget);
  Allocation allocation = table.allocation(*chosen.result.plan);
  allocation.method = chosen.method;
  const bool bounded = chosen.result.bound < std::numeric_limits<double>::infinity();
  allocation.value_bound = bounded ? chosen.result.bound : quick_bound(table);
  allocation.value_bound = std::max(allocation.value_bound, allocation.value.total);
  allocation.value_bound += table.free_slack();
  allocation.proven = allocation.gap() <= kValueTolerance;
  return allocation;
}

Result<TaskPlan> plan_task(const AllocationParams& params, const Candidate& vehicle, Instant start,
                           const Site& site, const TaskAssignment& assignment,
                           std::span<const Hazard> hazards) {
  const auto leg =
      leg_of(params.avoidance, vehicle, departure_of(vehicle, hazards), site, assignment.task);
  if (!leg) return leg.error();
  const TaskKind kind = assignment.task.kind;
  const auto path =
      path_of_length(params.avoidance, transit_of(vehicle, leg->task, hazards),
                     transit_length_m(vehicle, kind, leg->task, start, assignment.time));
  if (!path) return path.error();
  return assemble(*path, leg->task, start, vehicle.speed_mps, vehicle.planning_radius_m);
}

std::vector<Hazard> with_room_for_arcs(std::span<const Hazard> hazards) {
  constexpr double kRoom_m = 1.0;
  std::vector<Hazard> wide{hazards.begin(), hazards.end()};
  for (Hazard& circle : wide) circle.radius_m += kRoom_m;
  return wide;
}

Result<TaskPlan> plan_survey(const AllocationParams& params, const VehicleSpec& vehicle,
                             const Pose2& from, Instant start, const Site& site,
                             std::span<const Hazard> hazards) {
  const double radius_m = vehicle.planning_radius_m();
  // A survey is flown alone: in the sense that gets there sooner.
  const auto leg_among = [&](std::span<const Hazard> circles) {
    const Departure departure{from, radius_m, circles};
    const auto leg_in = [&](int turn) {
      return leg_to_arc(params.avoidance, departure, vehicle.sensor_radius_m,
                        vehicle.cruise_speed_mps, site, site.survey, turn, ArcStarts::some);
    };
    Result<Leg> leg = leg_in(kCounterClockwise);
    auto other = leg_in(kClockwise);
    if (other && (!leg || other->shortest_m < leg->shortest_m)) leg = std::move(other);
    return leg;
  };
  Result<Leg> leg = leg_among(with_room_for_arcs(hazards));
  if (!leg) leg = leg_among(hazards);
  if (!leg) return leg.error();
  const auto path = shortest_clear_path(params.avoidance, from, leg->task.entry, radius_m, hazards);
  if (!path) return path.error();
  TaskPlan plan = assemble(*path, leg->task, start, vehicle.cruise_speed_mps, radius_m);
  plan.timed.tail_curvature_per_m = leg->task.run.curvature_per_m;  // it stays around the site
  return plan;
}

}  // namespace skein::planning
