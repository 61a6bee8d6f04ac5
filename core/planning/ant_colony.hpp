// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "allocation_table.hpp"
#include "skein/base/random.hpp"

namespace skein::planning {

/// Division-of-labour ant colony (Wang 2022, eq. 26-32): a subgroup of ants for each candidate; ant
/// j of every subgroup together form cluster j, which builds one complete plan. Move by move a
/// vehicle is drawn by its capability, then its task by pheromone and visibility. The best plan so
/// far is kept, so more generations are never worse; the lots are `random`'s alone.
/// Where the paper is silent: a move's required moment is that of the best plan so far; a vehicle
/// takes one task, so its moves all begin at its own pose; a move that would leave a task without a
/// vehicle is not allowed; a plan is timed at the best moments of its vehicles, with every length
/// verified before it counts.
[[nodiscard]] MethodResult ant_colony(const ColonyParams& params, AllocationTable& table,
                                      const PlanningBudget& budget, Random random);

}  // namespace skein::planning
