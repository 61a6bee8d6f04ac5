// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/team_mission.hpp"

namespace skein::hil {

std::vector<mission::ScriptedDecision> scripted_decisions(
    const std::vector<configuration::OperatorDecision>& decisions) {
  std::vector<mission::ScriptedDecision> scripted;
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

TeamMission team_mission(const configuration::Scenario& scenario) {
  TeamMission team;
  for (const auto& v : scenario.vehicles) team.vehicles.push_back({v.spec, v.start, v.search});
  team.sites = scenario.sites;
  for (const auto& h : scenario.hazards) team.hazards.push_back({h.hazard, h.known_from});
  team.protocol = scenario.protocol;
  team.decisions = scripted_decisions(scenario.operator_decisions);
  team.radio = {scenario.radio.range_m, scenario.radio.delay_mean, scenario.radio.delay_jitter,
                scenario.radio.loss_ratio};
  team.wind = wind_params(scenario.wind, scenario.seed);
  team.duration_max = scenario.duration_max;
  team.seed = scenario.seed;
  return team;
}

}  // namespace skein::hil
