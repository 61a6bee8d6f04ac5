// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/excuses.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <optional>
#include <set>
#include <string_view>

#include "skein/checks/task_runs.hpp"

namespace skein::hil {
namespace {

/// Can every task have a vehicle of its own? Augmenting paths (Kuhn 1955).
bool all_matched(std::size_t tasks, std::size_t vehicles,
                 const std::function<bool(std::size_t task, std::size_t vehicle)>& can) {
  std::vector<std::optional<std::size_t>> task_of(vehicles);
  for (std::size_t task = 0; task < tasks; ++task) {
    std::vector<bool> seen(vehicles, false);
    const std::function<bool(std::size_t)> place = [&](std::size_t t) {
      for (std::size_t v = 0; v < vehicles; ++v) {
        if (seen[v] || !can(t, v)) continue;
        seen[v] = true;
        if (task_of[v] && !place(*task_of[v])) continue;
        task_of[v] = t;
        return true;
      }
      return false;
    };
    if (!place(task)) return false;
  }
  return true;
}

/// What leaders told the operator about deliveries that nobody can know of. Without a grant for its
/// site no delivery can have been flown.
std::set<TaskId> may_have_been_flown(const checks::RunRecord& record) {
  std::set<TaskId> tasks;
  std::set<SiteId> granted;
  for (const auto& event : record.ground_events) {
    if (event.kind() == mission::EventKind::authorised) granted.insert(event.task.site);
  }
  for (const auto& recorded : record.recordings) {
    for (const auto& event : recorded.events) {
      if (event.kind() == mission::EventKind::task_unknown && granted.contains(event.task.site)) {
        tasks.insert(event.task);
      }
    }
  }
  return tasks;
}

bool is_withdrawn(const checks::RunRecord& record, const Site& site) {
  return std::ranges::any_of(record.ground_events, [&site](const mission::MissionEvent& event) {
    return event.kind() == mission::EventKind::site_withdrawn && event.task.site == site.id;
  });
}

bool is_covered(const checks::RunRecord& record, const Site& site) {
  return std::ranges::any_of(record.hazards, [&site](const TimedHazard& known) {
    return (known.hazard.centre - site.position).norm() < known.hazard.radius_m;
  });
}

}  // namespace

std::vector<checks::Excuse> excuses(const checks::RunRecord& record,
                                    const std::vector<VehicleEnd>& vehicles) {
  std::vector<checks::Excuse> all;
  std::set<TaskId> done;
  const auto excuse = [&all](const TaskId& task, std::string_view why) {
    checks::Excuse& added = all.emplace_back();
    added.task = task;
    added.why = why;
  };
  std::set<TaskId> unknown = may_have_been_flown(record);
  for (const auto& run : checks::task_runs(record)) {
    if (run.done && !run.failed) done.insert(run.task);
    if (run.cut_off && run.task.kind == TaskKind::deliver) unknown.insert(run.task);
  }
  for (const TaskId& task : unknown) {
    if (!done.contains(task)) excuse(task, "may have been flown by who fell silent");
  }

  const auto excuse_site = [&](const Site& site, std::string_view why) {
    std::vector<TaskId> tasks = tasks_after_survey(site);
    tasks.push_back({site.id, TaskKind::survey, 0});
    for (const TaskId& task : tasks) {
      if (!done.contains(task)) excuse(task, why);
    }
  };
  for (const Site& site : record.sites) {
    if (is_withdrawn(record, site)) excuse_site(site, "withdrawn by the operator");
    if (is_covered(record, site)) excuse_site(site, "lies in a hazard");
  }

  std::vector<const VehicleSpec*> specs;
  std::vector<const VehicleEnd*> left;
  for (const auto& end : vehicles) {
    if (end.gone || end.barred || end.spent) continue;
    left.push_back(&end);
    specs.push_back(&*std::find_if(record.vehicles.begin(), record.vehicles.end(),
                                   [&](const auto& spec) { return spec.id == end.vehicle; }));
  }
  for (const Site& site : record.sites) {
    std::vector<TaskId> open = tasks_after_survey(site);
    std::erase_if(open, [&](const TaskId& t) { return done.contains(t) || unknown.contains(t); });
    const TaskId survey{site.id, TaskKind::survey, 0};
    const bool surveyed = done.contains(survey);
    const auto can = [&](std::size_t task, std::size_t v) {
      return specs[v]->capabilities.has(open[task].kind) &&
             (open[task].kind != TaskKind::deliver || left[v]->loads > 0);
    };
    const bool surveyable =
        surveyed || std::any_of(specs.begin(), specs.end(), [](const VehicleSpec* s) {
          return s->capabilities.has(TaskKind::survey);
        });
    if (surveyable && all_matched(open.size(), left.size(), can)) continue;
    if (!surveyed) open.push_back(survey);
    for (const TaskId& task : open) excuse(task, "beyond the vehicles that are left");
  }
  return all;
}

}  // namespace skein::hil
