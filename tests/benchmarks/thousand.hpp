// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "skein/experiments/grid.hpp"
#include "skein/hil/team_mission.hpp"

namespace skein::hil {

/// 1,000 vehicles in 28 km by 28 km that search around 16 sites, of which they find some and form
/// coalitions: with that range of the radio, and of the protocol.
inline Result<configuration::Scenario> thousand_vehicles(double range_m, Duration duration) {
  constexpr double kHalf_m = 14000.0;
  constexpr double kStep_m = 7000.0;
  auto base = configuration::load_scenario(std::string{SKEIN_SCENARIOS} + "/coalition-32.yaml");
  if (!base) return base;
  const auto kinds = base->sites;
  base->sites.clear();
  base->operator_decisions.clear();
  for (std::uint16_t i = 0; i < 16; ++i) {
    Site site = kinds[i % kinds.size()];
    site.id = SiteId{static_cast<std::uint16_t>(i + 1)};
    const int row = i / 4;
    site.position = {kStep_m * (i % 4 - 1.5), kStep_m * (row - 1.5)};
    base->sites.push_back(site);
    base->operator_decisions.push_back({.site = site.id, .reaction = std::chrono::seconds{3}});
  }
  base->vehicles = experiments::draw_team(
      {.west_m = -kHalf_m, .east_m = kHalf_m, .south_m = -kHalf_m, .north_m = kHalf_m}, *base, 1000,
      1);
  base->radio.range_m = base->protocol.radio_range_m = range_m;
  base->duration_max = duration;
  return base;
}

}  // namespace skein::hil
