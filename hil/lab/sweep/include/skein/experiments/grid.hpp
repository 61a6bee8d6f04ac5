// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/configuration/experiment.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/hil/team_simulator.hpp"

namespace skein::experiments {

/// One combination of the axes' points: an index into each axis's points.
struct Cell {
  std::vector<std::size_t> points;
};

/// Every combination; the last axis changes fastest.
[[nodiscard]] std::vector<Cell> cells_of(const configuration::Experiment& experiment);

/// One label for each axis.
[[nodiscard]] std::vector<std::string> labels(const configuration::Experiment& experiment,
                                              const Cell& cell);

/// The scenario as it is flown in that cell with that seed. A team that lacks what a site needs is
/// drawn again. Fails where the scenario with these settings cannot be flown; the sentence names
/// the cell and the keys.
[[nodiscard]] Result<configuration::Scenario> scenario_of(
    const configuration::Experiment& experiment, const configuration::Scenario& base,
    const Cell& cell, std::uint64_t seed);

/// The fleet of `count` vehicles that the seed gives, ids from 1, each with its own height. The
/// larger count's fleet begins with the smaller one's.
[[nodiscard]] std::vector<configuration::ScenarioVehicle> draw_team(
    const configuration::RandomTeam& team, const configuration::Scenario& base, std::size_t count,
    std::uint64_t seed);

/// For the simulator: scenario_of() with the reported sites and the time that an allocation takes.
[[nodiscard]] Result<hil::TeamMission> mission_of(const configuration::Experiment& experiment,
                                                  const configuration::Scenario& base,
                                                  const Cell& cell, std::uint64_t seed);

}  // namespace skein::experiments
