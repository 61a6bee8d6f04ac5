// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/task_planning.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <initializer_list>

#include "plan_folder.hpp"
#include "skein/coupled/intentions.hpp"

namespace skein::groundstation {
namespace {

using configuration::Scenario;
using configuration::TaskingPlan;
using planning::CoupledPlan;
using planning::CoupledProblem;
using planning::CoupledTask;
using planning::Criterion;

TaskingPlan file_of(const Scenario& scenario, const CoupledProblem& problem,
                    const CoupledPlan& plan) {
  TaskingPlan file;
  file.title = scenario.title;
  file.criterion = problem.criterion;
  file.objective = plan.objective;
  file.bound = plan.bound.value_or(0.0);
  file.proven = plan.proven;
  file.left_out = plan.left_out;
  for (const planning::Intention& intention : planning::intentions_of(problem, plan)) {
    configuration::VehicleTasks part{intention.vehicle, intention.way, {}};
    for (const CoupledTask& task : plan.tasks) {
      if (task.vehicle == intention.vehicle) {
        part.tasks.push_back({task.task, task.time_s, task.end_s});
      }
    }
    if (!part.tasks.empty()) file.vehicles.push_back(std::move(part));
  }
  return file;
}

/// Of all tasks, were they done at once.
double reward_of(const CoupledProblem& problem) {
  double sum = 0.0;
  for (const TaskId& task : problem.open_tasks) {
    sum += std::ranges::find(problem.sites, task.site, &Site::id)->reward;
  }
  return std::max(sum, 1e-12);
}

std::string goodness(const CoupledPlan& plan, Criterion criterion) {
  const auto number = [criterion](double value) {
    return criterion == Criterion::value ? fmt::format("{:.4f}", value)
                                         : fmt::format("{:.2f} s", value);
  };
  const std::string_view what = configuration::kCriteria.at(static_cast<std::size_t>(criterion));
  if (plan.proven) return fmt::format("{} {}, proven the best", what, number(plan.objective));
  return fmt::format("{} {}; no plan is better than {} (a gap of {:.2f} %)", what,
                     number(plan.objective), number(plan.bound.value_or(0.0)), 100.0 * plan.gap());
}

/// Whether there are as many vehicles that can do tasks beside surveys as there are such tasks, of
/// each kind and in all.
bool each_may_have_one(const CoupledProblem& problem) {
  const auto enough = [&](std::initializer_list<TaskKind> kinds) {
    const auto is_of = [&](const TaskId& task) {
      return std::ranges::find(kinds, task.kind) != kinds.end();
    };
    const auto can = [&](const planning::CoupledVehicle& vehicle) {
      return std::ranges::any_of(kinds,
                                 [&](TaskKind kind) { return vehicle.capabilities.has(kind); });
    };
    return std::ranges::count_if(problem.open_tasks, is_of) <=
           std::ranges::count_if(problem.vehicles, can);
  };
  return enough({TaskKind::deliver}) && enough({TaskKind::assess}) &&
         enough({TaskKind::deliver, TaskKind::assess});
}

}  // namespace

CoupledProblem tasking_problem(const Scenario& scenario) {
  CoupledProblem problem;
  for (const configuration::ScenarioVehicle& vehicle : scenario.vehicles) {
    if (vehicle.spec.capabilities == Capabilities{}) continue;
    problem.vehicles.push_back(planning::coupled_vehicle(vehicle.spec, vehicle.start));
  }
  for (const Site& site : scenario.sites) {
    if (std::ranges::find(scenario.tasking.known, site.id) != scenario.tasking.known.end()) {
      problem.sites.push_back(site);
    }
  }
  problem.open_tasks = planning::tasks_of(problem.sites);
  problem.decide_wait = scenario.protocol.formation_time() + scenario.protocol.authorisation_lead;
  problem.hazards = hazards_known_at(scenario.hazards, Instant{});
  problem.criterion = scenario.tasking.criterion;
  problem.optional_sites = scenario.tasking.optional;
  problem.flyable_waits = false;  // who is early waits on an orbit
  problem.weights = {1.0, 0.0};
  return problem;
}

Result<PlannedTasks> plan_tasks(const Scenario& scenario, const planning::PlanningBudget& budget) {
  if (!scenario.tasks_sites()) {
    return Error{
        "the mission plans no routes, and no site is known before take-off; name some under "
        "tasking.known, or all with --all-known"};
  }
  PlannedTasks planned;
  planned.problem = tasking_problem(scenario);
  if (const std::size_t team = planned.problem.vehicles.size();
      team > planning::kCoupledVehiclesMax) {
    return Error{fmt::format(
        "tasks are planned for {} vehicles at most, and the mission has {}; plan parts of the team "
        "for parts of the sites",
        planning::kCoupledVehiclesMax, team)};
  }
  // Where there are too few vehicles for one task each, they have one at each of several sites.
  const bool few = !each_may_have_one(planned.problem);
  planned.problem.share = few ? planning::TaskShare::one_a_site : planning::TaskShare::one;
  auto plan = planning::branch_and_bound(planned.problem, budget);
  if (!few && (!plan || !plan->left_out.empty())) {
    CoupledProblem wider = planned.problem;
    wider.share = planning::TaskShare::one_a_site;
    auto more = planning::branch_and_bound(wider, budget);
    if (!plan || (more && more->reward > plan->reward)) {
      planned.problem = std::move(wider);
      plan = std::move(more);
    }
  }
  if (!plan) {
    return Error{plan.error().message +
                 "; add vehicles, loads or range, or leave sites out of tasking.known"};
  }
  planned.plan = *std::move(plan);
  planning::settle_ties(planned.problem, planned.plan);
  planned.file = file_of(scenario, planned.problem, planned.plan);
  return planned;
}

std::string tasks_text(const PlannedTasks& planned) {
  const CoupledPlan& plan = planned.plan;
  std::string text =
      fmt::format("{} tasks at {} sites by {} of {} vehicles: {}.\n", plan.tasks.size(),
                  planned.problem.sites.size(), planned.file.vehicles.size(),
                  planned.problem.vehicles.size(), goodness(plan, planned.problem.criterion));
  if (planned.problem.share == planning::TaskShare::one) {
    text += "Among plans in which each vehicle has one task beside surveys, and waits for it.\n\n";
  }
  text += fmt::format("{:<8}  {:<20}  {:>8}  {:>8}  {:>8}\n", "vehicle", "task", "begins s",
                      "ends s", "waits s");
  for (const CoupledTask& task : plan.tasks) {
    const auto& vehicle =
        *std::ranges::find(planned.problem.vehicles, task.vehicle, &planning::CoupledVehicle::id);
    const double waits_s = std::max(0.0, task.transit_m - task.least_transit_m) / vehicle.speed_mps;
    text += fmt::format("{:>7}   {:<20}  {:>8.1f}  {:>8.1f}  {:>8.1f}\n", task.vehicle.value,
                        to_string(task.task), task.time_s, task.end_s, waits_s);
  }
  std::vector<std::uint16_t> free;
  for (const auto& vehicle : planned.problem.vehicles) {
    if (std::ranges::find(plan.tasks, vehicle.id, &CoupledTask::vehicle) == plan.tasks.end()) {
      free.push_back(vehicle.id.value);
    }
  }
  text += fmt::format("\nthe last task ends at {:.1f} s; {:.3f} of all reward\n", plan.makespan_s,
                      plan.reward / reward_of(planned.problem));
  for (const SiteId site : plan.left_out) text += fmt::format("left out: site {}\n", site.value);
  if (!free.empty()) text += fmt::format("without a task: {}\n", fmt::join(free, ", "));
  return text;
}

Result<std::vector<std::string>> write_tasks(const PlannedTasks& planned,
                                             const std::filesystem::path& folder) {
  if (auto made = make_folder(folder); !made) return made.error();
  return write_files(folder, {{"plan.yaml", to_yaml(planned.file)}});
}

}  // namespace skein::groundstation
