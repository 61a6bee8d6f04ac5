// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/team_mission.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>

#include "skein/base/random.hpp"
#include "skein/groundstation/orders.hpp"
#include "skein/hil/fault_profiles.hpp"

namespace skein::hil {
namespace {

/// Without faults a script takes some minutes; then it is going round in circles.
constexpr Duration kLongest = std::chrono::minutes{20};
constexpr std::uint64_t kScriptStream = 0x666f726d73637201;
constexpr std::size_t kShapes = 3;

/// Take-off, rally, shapes somewhere above the rally, rally, land.
std::vector<std::string> random_script(const configuration::FormationConfig& formation,
                                       std::size_t vehicles, Random& random) {
  std::vector<std::string> shapes = groundstation::shape_names();
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

/// A lap in one shape, and another shape on it.
std::vector<std::string> random_track_script(const configuration::FormationConfig& formation,
                                             Random& random) {
  static constexpr std::array<const char*, 4> kShapesOfPlanes{"line-abreast", "column", "echelon",
                                                              "wedge"};
  const auto shape = [&] {
    const double least = formation.separation.horizontal_m + 2.0 * formation.tracking_m;
    return fmt::format("{} spacing {:.1f}",
                       kShapesOfPlanes.at(random.index(kShapesOfPlanes.size())),
                       least * random.uniform(1.25, 1.5));
  };
  const auto& tracks = formation.tracks;
  std::vector<std::string> script;
  script.push_back(
      fmt::format("fly-along {} in {}", tracks[random.index(tracks.size())].name, shape()));
  script.push_back(fmt::format("wait {:.0f}", random.uniform(1.0, 60.0)));
  script.push_back("form " + shape());
  return script;
}

/// Shapes and gusts are drawn with the faults; so much of take-off, rally and landing is besides.
Result<void> add_formation_faults(TeamMission& mission, const std::string& profiles) {
  std::vector<VehicleId> ids;
  for (const auto& v : mission.vehicles) {
    if (v.flies_formation) ids.push_back(v.spec.id);
  }
  std::sort(ids.begin(), ids.end());
  std::size_t changes = 1;
  if (profiles != "none") {
    Random random{mission.seed ^ kScriptStream};
    if (mission.formation->planes && mission.formation->tracks.empty()) {
      return Error{"faults are drawn along a track; give formation.tracks one"};
    }
    if (mission.formation->planes) {
      mission.formation->script = random_track_script(*mission.formation, random);
      const auto drawn = formation_faults(profiles, ids, 2, mission.seed);
      if (!drawn) return drawn.error();
      mission.faults.insert(mission.faults.end(), drawn->begin(), drawn->end());
      return {};
    }
    mission.formation->script = random_script(*mission.formation, ids.size(), random);
    mission.gust_error_m = random.uniform(0.02, 0.1);
    changes = kShapes + 4;
  }
  const auto drawn = formation_faults(profiles, ids, changes, mission.seed);
  if (!drawn) return drawn.error();
  mission.faults.insert(mission.faults.end(), drawn->begin(), drawn->end());
  return {};
}

}  // namespace

std::vector<mission::ScriptedDecision> scripted_decisions(
    const std::vector<configuration::OperatorDecision>& decisions) {
  std::vector<mission::ScriptedDecision> scripted;
  scripted.reserve(decisions.size());
  for (const auto& d : decisions) scripted.push_back({d.site, d.grant, d.reaction, d.not_before});
  return scripted;
}

models::WindParams wind_params(const configuration::WindConfig& wind, std::uint64_t seed) {
  models::WindParams params;
  params.steady_mps = -wind.speed_mps * unit_vector(wind.from_rad);
  params.gust_mps = wind.gust_mps;
  params.seed = seed;
  return params;
}

radio::RadioParams radio_params(const configuration::RadioConfig& radio) {
  radio::RadioParams params{radio.range_m, radio.ground_range_m, radio.delay_mean,
                            radio.delay_jitter, radio.loss_ratio};
  if (radio.bytes_per_s > 0.0) params.bytes_per_s = radio.bytes_per_s;
  if (radio.mesh == configuration::MeshKind::none) return params;
  params.mesh.emplace();
  params.mesh->ground_relays = radio.mesh == configuration::MeshKind::all;
  return params;
}

TeamMission team_mission(const configuration::Scenario& scenario) {
  TeamMission team;
  for (const auto& v : scenario.vehicles) {
    team.vehicles.push_back({v.spec, v.start, v.search,
                             v.spec.is_copter() ? Body::multirotor : Body::heading_dynamics,
                             configuration::flies_formation(v.spec) || scenario.formation.planes});
  }
  if (scenario.flies_formation()) team.formation = scenario.formation;
  if (scenario.formation.planes) team.place_rms_m = scenario.expect.place_rms_m;
  team.sites = scenario.sites;
  team.hazards = scenario.hazards;
  team.fence = scenario.fence;
  team.protocol = scenario.protocol;
  team.traffic = scenario.traffic;
  team.aircraft = scenario.aircraft;
  team.planning = scenario.planning;
  team.decisions = scripted_decisions(scenario.operator_decisions);
  team.radio = radio_params(scenario.radio);
  team.faults = faults_of(scenario);
  team.wind = wind_params(scenario.wind, scenario.seed);
  team.duration_max = scenario.flies_formation() ? kLongest : scenario.duration_max;
  team.ends_landed = scenario.ends == configuration::Ending::landed;
  team.seed = scenario.seed;
  return team;
}

Result<TeamMission> seeded_mission(const configuration::Scenario& scenario, std::uint64_t seed,
                                   const std::string& profiles) {
  configuration::Scenario seeded = scenario;
  seeded.seed = seed;
  TeamMission mission = team_mission(seeded);
  if (mission.formation) {
    if (const auto drawn = add_formation_faults(mission, profiles); !drawn) return drawn.error();
    return mission;
  }
  const auto params = fault_params(profiles, seed);
  if (!params) return params.error();
  add_faults(mission, *params);
  return mission;
}

checks::Limits limits_of(const configuration::Expectations& expect) {
  checks::Limits limits;
  limits.arrival_s =
      std::max({expect.delivery_spread_s, expect.slot_error_s, expect.assess_start_error_s});
  limits.bearing_rad = expect.bearing_error_rad;
  limits.miss_m = expect.miss_distance_m;
  limits.separation_horizontal_m = expect.separation_horizontal_m;
  limits.separation_vertical_m = expect.separation_vertical_m;
  limits.place_rms_m = expect.place_rms_m;
  limits.arrival_spread_s = expect.arrival_spread_s;
  limits.copters_fly = expect.copters_fly;
  return limits;
}

void allow_for_clocks(checks::Limits& limits, const coalition::ProtocolParams& protocol) {
  const double differ = to_seconds(protocol.clock_guard);
  limits.planned_time_s += differ;
  limits.arrival_s += differ;
}

}  // namespace skein::hil
