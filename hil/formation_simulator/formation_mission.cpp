// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "skein/base/random.hpp"
#include "skein/hil/fault_profiles.hpp"
#include "skein/hil/formation_simulator.hpp"
#include "skein/hil/run_parallel.hpp"
#include "skein/hil/team_mission.hpp"

namespace skein::hil {
namespace {

constexpr std::uint64_t kScriptStream = 0x666f726d73637201;
constexpr std::size_t kShapes = 3;

/// Take-off, rally, shapes somewhere above the rally, rally, land.
std::vector<std::string> random_script(const configuration::FormationConfig& formation,
                                       std::size_t vehicles, Random& random) {
  std::vector<std::string> shapes{"line-abreast", "column", "echelon", "wedge", "pentagon"};
  for (const auto& shape : formation.shapes) shapes.push_back(shape.name);
  std::vector<std::string> script{"take-off", "rally"};
  const double room = 8.0 * static_cast<double>(vehicles);
  for (std::size_t i = 0; i < kShapes; ++i) {
    const Vec3& rally = formation.rally.centre;
    script.push_back(fmt::format(
        "form {} spacing {:.1f} heading {:.0f} at {:.1f} {:.1f} {:.1f}",
        shapes[random.index(shapes.size())], formation.rally.spacing_m * random.uniform(0.8, 1.3),
        random.uniform(0.0, 359.0), rally.x() + random.uniform(-room, room),
        rally.y() + random.uniform(-room, room), rally.z() + random.uniform(0.0, 15.0)));
    if (random.chance(0.3)) {
      script.back() += fmt::format(" places {}", 1 + random.index(vehicles));
    }
    script.emplace_back("wait 1");
  }
  script.emplace_back("rally");
  script.emplace_back("land");
  return script;
}

}  // namespace

Result<FormationMission> formation_mission(const configuration::Scenario& scenario,
                                           std::uint64_t seed, const std::string& faults) {
  FormationMission mission;
  mission.seed = seed;
  mission.formation = scenario.formation;
  mission.radio = radio_params(scenario.radio);
  mission.faults = faults_of(scenario);
  for (const auto& vehicle : scenario.vehicles) {
    mission.vehicles.push_back(
        {vehicle.spec.id, {vehicle.start.position().x(), vehicle.start.position().y(), 0.0}});
  }
  std::sort(mission.vehicles.begin(), mission.vehicles.end(),
            [](const auto& a, const auto& b) { return a.id < b.id; });
  std::vector<VehicleId> ids;
  for (const auto& vehicle : mission.vehicles) ids.push_back(vehicle.id);
  std::size_t changes = 1;
  if (faults != "none") {
    Random random{seed ^ kScriptStream};
    mission.formation.script = random_script(scenario.formation, ids.size(), random);
    mission.gust_error_m = random.uniform(0.02, 0.1);
    changes = kShapes + 4;
  }
  const auto drawn = formation_faults(faults, ids, changes, seed);
  if (!drawn) return drawn.error();
  mission.faults.insert(mission.faults.end(), drawn->begin(), drawn->end());
  return mission;
}

Result<std::vector<FormationRun>> fly_formations(
    const configuration::Scenario& scenario, const FormationSeries& series,
    const std::function<void(const FormationRun&)>& on_done) {
  const auto fly = [&](std::size_t i) -> Result<FormationRun> {
    const auto mission = formation_mission(scenario, series.first_seed + i, series.faults);
    if (!mission) return mission.error();
    return fly_formation(*mission);
  };
  return run_parallel<FormationRun>(series.runs, series.jobs, fly, on_done);
}

}  // namespace skein::hil
