// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "skein/formation/place_assignment.hpp"

namespace skein::formation {

/// assign_places with the method colony. Precondition: what it checks.
[[nodiscard]] std::vector<int> colony_places(const PlaceColonyParams& params,
                                             std::span<const Vec3> vehicles,
                                             std::span<const Vec3> places, Random random,
                                             const planning::PlanningBudget& budget);

}  // namespace skein::formation
