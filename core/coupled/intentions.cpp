// SPDX-License-Identifier: Apache-2.0
#include "skein/coupled/intentions.hpp"

#include <algorithm>

namespace skein::planning {
namespace {

/// So near to a site, in sensor radii, that it is found also where the wind leads astray.
constexpr double kFound_radii = 0.85;
/// Short of the entry, in planning radii: room to turn into it from anywhere on an orbit.
constexpr double kWaits_radii = 2.0;

bool is_clear_of(const std::vector<Hazard>& hazards, const Vec2& place, double room_m) {
  return std::ranges::all_of(hazards, [&](const Hazard& hazard) {
    return (hazard.centre - place).norm() > hazard.radius_m + room_m;
  });
}

Vec2 found_from(const CoupledProblem& problem, const CoupledTask& survey) {
  const auto site = std::ranges::find(problem.sites, survey.task.site, &Site::id);
  return site->position + kFound_radii * (survey.entry.position() - site->position);
}

/// Nearer to the entry where hazards leave no room for an orbit.
Vec2 waits_at(const CoupledProblem& problem, const CoupledVehicle& vehicle,
              const CoupledTask& task) {
  const Vec2 forward = unit_vector(task.entry.heading_rad);
  for (const double radii : {kWaits_radii, kWaits_radii / 2.0}) {
    const Vec2 place = task.entry.position() - radii * vehicle.planning_radius_m * forward;
    if (is_clear_of(problem.hazards, place, 2.0 * vehicle.planning_radius_m)) return place;
  }
  return task.entry.position();
}

}  // namespace

CoupledVehicle coupled_vehicle(const VehicleSpec& spec, const Pose2& pose) {
  CoupledVehicle v;
  v.id = spec.id;
  v.pose = pose;
  v.speed_mps = spec.cruise_speed_mps;
  v.planning_radius_m = spec.planning_radius_m();
  v.range_left_m = spec.range_m;
  v.final_approach_m = spec.final_approach_m;
  v.sensor_radius_m = spec.sensor_radius_m;
  v.assess_radius_m = spec.assess_radius_m;
  v.capabilities = spec.capabilities;
  v.loads = spec.loads;
  return v;
}

std::vector<TaskId> tasks_of(const std::vector<Site>& sites) {
  std::vector<TaskId> tasks;
  for (const Site& site : sites) {
    tasks.push_back({site.id, TaskKind::survey, 0});
    for (const TaskId& task : tasks_after_survey(site)) tasks.push_back(task);
  }
  return tasks;
}

std::vector<Intention> intentions_of(const CoupledProblem& problem, const CoupledPlan& plan) {
  std::vector<Intention> intentions;
  for (const CoupledVehicle& vehicle : problem.vehicles) {
    Intention intention{vehicle.id, {}};
    const CoupledTask* first = nullptr;
    for (const CoupledTask& task : plan.tasks) {
      if (task.vehicle != vehicle.id) continue;
      if (first == nullptr) first = &task;
      if (task.task.kind == TaskKind::survey) intention.way.push_back(found_from(problem, task));
    }
    if (first != nullptr && intention.way.empty()) {
      intention.way.push_back(waits_at(problem, vehicle, *first));
    }
    intentions.push_back(std::move(intention));
  }
  return intentions;
}

}  // namespace skein::planning
