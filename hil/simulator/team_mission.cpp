// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/team_mission.hpp"

#include <algorithm>

namespace skein::hil {

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
  return {radio.range_m, radio.ground_range_m, radio.delay_mean, radio.delay_jitter,
          radio.loss_ratio};
}

TeamMission team_mission(const configuration::Scenario& scenario) {
  TeamMission team;
  for (const auto& v : scenario.vehicles) team.vehicles.push_back({v.spec, v.start, v.search});
  team.sites = scenario.sites;
  for (const auto& h : scenario.hazards) team.hazards.push_back({h.hazard, h.known_from});
  team.protocol = scenario.protocol;
  team.planning = scenario.planning;
  team.decisions = scripted_decisions(scenario.operator_decisions);
  team.radio = radio_params(scenario.radio);
  team.faults = faults_of(scenario);
  team.wind = wind_params(scenario.wind, scenario.seed);
  team.duration_max = scenario.duration_max;
  team.seed = scenario.seed;
  return team;
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
  return limits;
}

}  // namespace skein::hil
