// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/configuration/tasking.hpp"
#include "skein/coupled/coupled.hpp"
#include "skein/planning/budget.hpp"

/// Who goes to the sites that are known before take-off: planned, told, written (docs/tasking.md).
namespace skein::groundstation {

struct PlannedTasks {
  planning::CoupledProblem problem;
  planning::CoupledPlan plan;
  configuration::TaskingPlan file;
};

/// Nodes of the search, where nobody says otherwise: what 32 vehicles and 42 tasks take in some
/// seconds.
inline constexpr std::uint64_t kTaskingSteps = 20'000;

/// The scenario's known sites as a coupled problem: vehicles at their starts, the hazards that are
/// known at the begin, and from each survey to the deliveries the time that forming a coalition and
/// asking the operator take.
[[nodiscard]] planning::CoupledProblem tasking_problem(const configuration::Scenario& scenario);

/// Of plans that give each vehicle one task beside surveys, so that all can wait where theirs
/// begin; where none is found, one task of each site. With a budget of steps alone the same
/// scenario gives the same plan, byte for byte. Fails with a sentence where no site is known, or
/// nobody can do what has to be done.
[[nodiscard]] Result<PlannedTasks> plan_tasks(const configuration::Scenario& scenario,
                                              const planning::PlanningBudget& budget = {
                                                  kTaskingSteps, {}});

/// What a person reads: who does what, in which order and when, and how good that is.
[[nodiscard]] std::string tasks_text(const PlannedTasks& planned);

/// Writes plan.yaml into the folder, which is made. Gives the files' names; fails with the file
/// that cannot be written.
[[nodiscard]] Result<std::vector<std::string>> write_tasks(const PlannedTasks& planned,
                                                           const std::filesystem::path& folder);

}  // namespace skein::groundstation
