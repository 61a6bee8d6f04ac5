// SPDX-License-Identifier: Apache-2.0
#include "skein/coupled/intentions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "skein/base/angles.hpp"
#include "skein/planning/assignment.hpp"
#include "skein/planning/avoidance.hpp"
#include "skein/planning/dubins.hpp"

namespace skein::planning {
namespace {

/// So near to a site, in sensor radii, that it is found also where the wind leads astray.
constexpr double kFound_radii = 0.85;
/// Short of the entry, in planning radii: room to turn into it from anywhere on an orbit.
constexpr double kWaits_radii = 2.0;
constexpr double kRounding_m = 1e-6;
/// Who is not awarded anything so long after its planned end looks who else needs it.
constexpr double kPatience_s = 60.0;
constexpr double kLap_radii = 1.2;
constexpr int kLapPoints = 4;
constexpr int kLapsMax = 20;
constexpr int kVisits = 3;  ///< of the site that may need it
/// As many points as a search route in a file may have.
constexpr std::size_t kWayMax = 256;

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

/// Laps through a place, which is passed as its task is entered, of so many seconds at least.
void add_laps(std::vector<Vec2>& way, const CoupledVehicle& vehicle, const Vec2& place,
              double heading_rad, double seconds) {
  const double radius_m = kLap_radii * vehicle.planning_radius_m;
  if (radius_m <= 0.0) return;  // it stands there
  const Vec2 centre = place + radius_m * left_of(unit_vector(heading_rad));
  const double laps = seconds * vehicle.speed_mps / (kTwoPi * radius_m);
  const int count = std::clamp(static_cast<int>(std::ceil(laps)), 0, kLapsMax);
  for (int k = 1; k <= count * kLapPoints; ++k) {
    const double turned_rad = k * kTwoPi / kLapPoints - kPi / 2.0;
    way.push_back(centre + radius_m * unit_vector(heading_rad + turned_rad));
  }
}

/// That of the most tasks: its coalition is the hardest to form. None where there is one site.
const Site* hardest_of(const CoupledProblem& problem, const CoupledPlan& plan) {
  const Site* hardest = nullptr;
  std::ptrdiff_t most = 0;
  for (const Site& site : problem.sites) {
    const auto tasks = std::ranges::count_if(
        plan.tasks, [&](const CoupledTask& task) { return task.task.site == site.id; });
    if (tasks <= most) continue;
    most = tasks;
    hardest = &site;
  }
  return problem.sites.size() > 1 ? hardest : nullptr;
}

/// To and fro between there and where the vehicle waits first, as somebody may be needed.
void add_other_site(std::vector<Vec2>& way, const CoupledProblem& problem,
                    const CoupledVehicle& vehicle, const Site& other, double heading_rad) {
  const Vec2 own = way.front();
  const Vec2 off = own - other.position;
  const double beside_m = kWaits_radii * vehicle.planning_radius_m;
  const Vec2 place = other.position + std::min(1.0, beside_m / std::max(off.norm(), 1.0)) * off;
  if (!is_clear_of(problem.hazards, place, beside_m)) return;
  for (int k = 0; k < kVisits; ++k) {
    if (k > 0) way.push_back(own);
    way.push_back(place);
    add_laps(way, vehicle, place, heading_rad, kPatience_s);
  }
}

/// Flies the tasks of the other in the same time.
bool alike(const CoupledVehicle& a, const CoupledVehicle& b) {
  return a.speed_mps == b.speed_mps && a.planning_radius_m == b.planning_radius_m &&
         a.final_approach_m == b.final_approach_m && a.assess_radius_m == b.assess_radius_m;
}

double way_m(const CoupledProblem& problem, const CoupledVehicle& vehicle, const Pose2& to) {
  const double radius_m = vehicle.planning_radius_m;
  if (problem.hazards.empty()) return shortest_dubins_length(vehicle.pose, to, radius_m);
  const auto length_m =
      shortest_clear_length(problem.avoidance, vehicle.pose, to, radius_m, problem.hazards);
  return length_m ? *length_m : std::numeric_limits<double>::infinity();
}

}  // namespace

void settle_ties(const CoupledProblem& problem, CoupledPlan& plan) {
  const auto vehicle_of = [&](VehicleId id) -> const CoupledVehicle& {
    return *std::ranges::find(problem.vehicles, id, &CoupledVehicle::id);
  };
  const auto tasks_of_vehicle = [&](VehicleId id) {
    return std::ranges::count(plan.tasks, id, &CoupledTask::vehicle);
  };
  std::vector<CoupledTask*> tasks;
  std::vector<const CoupledVehicle*> vehicles;
  for (CoupledTask& task : plan.tasks) {
    const bool single = tasks_of_vehicle(task.vehicle) == 1;
    if (single && task.task.kind != TaskKind::survey) tasks.push_back(&task);
  }
  for (const CoupledVehicle& vehicle : problem.vehicles) {
    const bool moves = std::ranges::any_of(
        tasks, [&](const CoupledTask* task) { return task->vehicle == vehicle.id; });
    if (moves || tasks_of_vehicle(vehicle.id) == 0) vehicles.push_back(&vehicle);
  }
  if (tasks.empty()) return;
  std::vector<double> costs;
  for (const CoupledTask* task : tasks) {
    for (const CoupledVehicle* vehicle : vehicles) {
      const double there_m = way_m(problem, *vehicle, task->entry);
      const bool able = alike(*vehicle, vehicle_of(task->vehicle)) &&
                        vehicle->capabilities.has(task->task.kind) &&
                        (task->task.kind != TaskKind::deliver || vehicle->loads > 0) &&
                        there_m <= task->transit_m + kRounding_m &&
                        task->end_s * vehicle->speed_mps <= vehicle->range_left_m;
      costs.push_back(able ? there_m : std::numeric_limits<double>::infinity());
    }
  }
  std::vector<int> who(tasks.size());
  if (!AssignmentSolver{}.least_sum(costs, vehicles.size(), who)) return;
  for (std::size_t k = 0; k < tasks.size(); ++k) {
    const auto i = static_cast<std::size_t>(who[k]);
    tasks[k]->vehicle = vehicles[i]->id;
    tasks[k]->least_transit_m = costs[k * vehicles.size() + i];
  }
  const auto place = [&](const CoupledTask& task) { return &vehicle_of(task.vehicle); };
  std::ranges::stable_sort(plan.tasks, [&](const CoupledTask& a, const CoupledTask& b) {
    return place(a) < place(b) || (place(a) == place(b) && a.time_s < b.time_s);
  });
}

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
  const Site* const hardest = hardest_of(problem, plan);
  for (const CoupledVehicle& vehicle : problem.vehicles) {
    Intention intention{vehicle.id, {}};
    const CoupledTask* first = nullptr;
    for (const CoupledTask& task : plan.tasks) {
      if (task.vehicle != vehicle.id) continue;
      if (first == nullptr) first = &task;
      if (task.task.kind != TaskKind::survey) continue;
      intention.way.push_back(found_from(problem, task));
    }
    if (first != nullptr && intention.way.empty()) {
      const Vec2 place = waits_at(problem, vehicle, *first);
      const double there_s = first->least_transit_m / vehicle.speed_mps;
      intention.way.push_back(place);
      if (hardest != nullptr && hardest->id != first->task.site) {
        const double heading_rad = first->entry.heading_rad;
        add_laps(intention.way, vehicle, place, heading_rad, first->end_s + kPatience_s - there_s);
        add_other_site(intention.way, problem, vehicle, *hardest, heading_rad);
        if (intention.way.size() > kWayMax) intention.way.resize(kWayMax);
      }
    }
    intentions.push_back(std::move(intention));
  }
  return intentions;
}

}  // namespace skein::planning
