// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <utility>

#include "process_fields.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/configuration/tasking.hpp"

namespace skein::configuration {
namespace {

constexpr Range kObjective{-1e6, 1e6};

void criterion_field(FieldVisitor& v, std::string_view text, planning::Criterion& criterion) {
  auto index = static_cast<std::size_t>(criterion);
  v.choice({"criterion", text}, kCriteria, index);
  criterion = static_cast<planning::Criterion>(index);
}

void planned_task_fields(FieldVisitor& v, PlannedTask& planned) {
  constexpr std::array<std::string_view, 3> kKinds{"survey", "deliver", "assess"};
  id(v, {"site", "of the task", kRequired}, planned.task.site);
  auto kind = static_cast<std::size_t>(planned.task.kind);
  v.choice({"kind", "of the task", kRequired}, kKinds, kind);
  planned.task.kind = static_cast<TaskKind>(kind);
  whole(v, {"index", "of the site's tasks of the kind"}, {0.0, 255.0}, planned.task.index);
  v.number({"begins_s", "mission time of its run, of a delivery over the site", kRequired},
           kSeconds, planned.begins_s);
  v.number({"ends_s", "mission time", kRequired}, kSeconds, planned.ends_s);
}

void vehicle_tasks_fields(FieldVisitor& v, VehicleTasks& tasks) {
  id(v, {"vehicle", "whose part it is", kRequired}, tasks.vehicle);
  search_list(v, tasks.search);
  v.list({"tasks", "as planned, in their order; who does them is found out by bids"},
         groups_of(tasks.tasks, kListMax, planned_task_fields));
}

}  // namespace

void tasking_section(FieldVisitor& v, TaskingConfig& config) {
  v.section({"tasking", "what `skein-ground plan` tasks before take-off; none without known sites"},
            [&config](FieldVisitor& inner) {
              ids(inner, {"known", "ids of sites known before take-off"}, config.known, "site");
              ids(inner, {"optional", "ids of those that may be left out; by reward alone"},
                  config.optional, "site");
              criterion_field(inner,
                              "what is best: the most reward (it decays), the least mean end of "
                              "tasks by reward, or the earliest end of the last",
                              config.criterion);
            });
}

void fields(FieldVisitor& v, TaskingPlan& plan) {
  version_field(v);
  v.text({"title", "one line", kRequired}, plan.title);
  criterion_field(v, "what it is best by", plan.criterion);
  v.number({"objective", "by it: a share of all reward, or seconds"}, kObjective, plan.objective);
  v.number({"bound", "no plan is better"}, kObjective, plan.bound);
  constexpr std::array<std::string_view, 2> kProven{"no", "yes"};
  auto proven = static_cast<std::size_t>(plan.proven);
  v.choice({"proven", "whether it is the best"}, kProven, proven);
  plan.proven = proven == 1;
  ids(v, {"left_out", "ids of sites that nobody goes to"}, plan.left_out, "site");
  v.list({"vehicles", "who does what", kRequired},
         unique_groups_of(plan.vehicles, kVehiclesMax, vehicle_tasks_fields, "vehicle",
                          [](const VehicleTasks& tasks) { return tasks.vehicle.value; }));
}

Result<void> give_tasks(const TaskingPlan& plan, Scenario& scenario) {
  const auto anew = "; plan it anew with `skein-ground plan`";
  std::vector<std::pair<ScenarioVehicle*, const VehicleTasks*>> given;
  for (const VehicleTasks& part : plan.vehicles) {
    const std::string who = "the plan's vehicle " + std::to_string(part.vehicle.value);
    const auto vehicle = std::ranges::find_if(
        scenario.vehicles,
        [&](const ScenarioVehicle& candidate) { return candidate.spec.id == part.vehicle; });
    if (vehicle == scenario.vehicles.end()) return Error{who + " is not in the fleet" + anew};
    for (const PlannedTask& planned : part.tasks) {
      const auto site = std::ranges::find(scenario.sites, planned.task.site, &Site::id);
      if (site == scenario.sites.end() ||
          planned.task.index >= task_count(*site, planned.task.kind)) {
        return Error{who + " has the task '" + to_string(planned.task) +
                     "', which the mission does not have" + anew};
      }
    }
    given.emplace_back(&*vehicle, &part);
  }
  for (const auto& [vehicle, part] : given) {
    if (!part->search.empty()) vehicle->search = part->search;
  }
  return {};
}

}  // namespace skein::configuration
