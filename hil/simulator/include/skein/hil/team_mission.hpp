// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/checks/run_record.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/hil/team_simulator.hpp"

namespace skein::hil {

/// The scenario as the simulator flies it, with the faults of its time line.
[[nodiscard]] TeamMission team_mission(const configuration::Scenario& scenario);

/// The scenario with this seed in place of its own, and with the faults that the profiles draw with
/// it besides ("none": none). In a formation the shapes and the gusts are drawn then too; with
/// "none" the scenario's script is flown. Fails for a profile that there is not for such a mission.
[[nodiscard]] Result<TeamMission> seeded_mission(const configuration::Scenario& scenario,
                                                 std::uint64_t seed, const std::string& profiles);

/// The scripted decisions as the ground agent takes them.
[[nodiscard]] std::vector<mission::ScriptedDecision> scripted_decisions(
    const std::vector<configuration::OperatorDecision>& decisions);

/// The wind's velocity and gusts as the models take them.
[[nodiscard]] models::WindParams wind_params(const configuration::WindConfig& wind,
                                             std::uint64_t seed);

[[nodiscard]] radio::RadioParams radio_params(const configuration::RadioConfig& radio);

/// The scenario's expectations as the judges' limits.
[[nodiscard]] checks::Limits limits_of(const configuration::Expectations& expect);
/// Times are agreed by clocks that differ, and judged by the true one.
void allow_for_clocks(checks::Limits& limits, const coalition::ProtocolParams& protocol);

}  // namespace skein::hil
