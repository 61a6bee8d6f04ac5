// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"
#include "skein/coupled/coupled.hpp"

/// Random coupled problems for tests and benchmarks: vehicles of the three types of Wang 2022,
/// table 1, in turn, anywhere in a square with any heading, sites in the middle of it.
namespace skein::planning {

struct CoupledDraw {
  std::size_t sites = 3;
  std::size_t vehicles = 5;
  std::size_t deliveries = 1;   ///< of each site
  std::size_t assessments = 1;  ///< of each site
  double side_m = 8000.0;
  double interval_s = 0.0;  ///< between the deliveries of a site
};

inline CoupledVehicle draw_vehicle(Random& random, std::size_t index, double side_m) {
  CoupledVehicle v;
  v.id = VehicleId{static_cast<std::uint16_t>(index + 1)};
  v.pose = {random.uniform(0.0, side_m), random.uniform(0.0, side_m), random.uniform(-kPi, kPi)};
  v.speed_mps = 50.0;
  v.planning_radius_m = 165.0;
  v.range_left_m = 40000.0;
  v.final_approach_m = 400.0;
  v.sensor_radius_m = 300.0;
  v.assess_radius_m = 250.0;
  v.capabilities.add(TaskKind::survey).add(TaskKind::deliver).add(TaskKind::assess);
  v.loads = 2;
  if (index % 3 == 1) {
    v.speed_mps = 60.0;
    v.range_left_m = 50000.0;
    v.capabilities = Capabilities{}.add(TaskKind::deliver);
    v.loads = 4;
  }
  if (index % 3 == 2) {
    v.capabilities = Capabilities{}.add(TaskKind::survey).add(TaskKind::assess);
    v.loads = 0;
  }
  return v;
}

inline CoupledProblem draw_problem(Random& random, const CoupledDraw& draw) {
  using std::chrono::seconds;
  CoupledProblem problem;
  for (std::size_t i = 0; i < draw.vehicles; ++i) {
    problem.vehicles.push_back(draw_vehicle(random, i, draw.side_m));
  }
  for (std::size_t j = 0; j < draw.sites; ++j) {
    Site site;
    site.id = SiteId{static_cast<std::uint16_t>(j + 1)};
    site.position = {random.uniform(0.1, 0.9) * draw.side_m,
                     random.uniform(0.1, 0.9) * draw.side_m};
    site.survey = {random.uniform(-kPi, kPi), seconds{20}};
    for (std::size_t d = 0; d < draw.deliveries; ++d) {
      site.deliveries.push_back(
          {random.uniform(-kPi, kPi), from_seconds(draw.interval_s * static_cast<double>(d))});
    }
    site.assess_wait = seconds{10};
    for (std::size_t e = 0; e < draw.assessments; ++e) {
      site.assessments.push_back({random.uniform(-kPi, kPi), seconds{20}});
    }
    site.reward_decay_per_s = 0.005;
    problem.open_tasks.push_back({site.id, TaskKind::survey, 0});
    for (const TaskId& task : tasks_after_survey(site)) problem.open_tasks.push_back(task);
    problem.sites.push_back(site);
  }
  return problem;
}

/// Of a makespan, whose plans last as long as their bounds say: waits need not be flown.
inline CoupledProblem draw_makespan(Random& random, const CoupledDraw& draw) {
  CoupledProblem problem = draw_problem(random, draw);
  problem.criterion = Criterion::makespan;
  problem.flyable_waits = false;
  return problem;
}

}  // namespace skein::planning
