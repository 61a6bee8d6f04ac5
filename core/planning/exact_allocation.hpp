// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "allocation_table.hpp"

/// One coalition is a bottleneck assignment problem and not hard: for each pair of moments one
/// assignment problem decides, and few moments can be best. J falls with either moment but for late
/// assessments, which later deliveries make less late; it is convex in between. So the best
/// moments are among those at which a pair becomes possible or stops to be, or at which the
/// assessments are just on time. They are swept upwards, each with an upper bound of its J first.
/// Gaps in the lengths of paths are looked for only where an assignment would use them; a pair that
/// is refused has another moment to be tried at.
namespace skein::planning {

/// The greatest J. Not proven when the budget ended the sweep, or when deliveries that wait for
/// assessments were refused by a gap at a moment that could have been the best.
[[nodiscard]] MethodResult exact_allocation(AllocationTable& table, const PlanningBudget& budget);

/// The earliest deliveries, then the earliest assessments that go with them, then the least sum of
/// shortest lengths.
[[nodiscard]] MethodResult earliest_allocation(AllocationTable& table,
                                               const PlanningBudget& budget);

/// No moments of any plan are before these. Nothing where the deliveries, or the assessments,
/// cannot be assigned.
[[nodiscard]] std::optional<Moments> least_moments(const AllocationTable& table);

/// An upper bound of J that costs two bottleneck assignments. -infinity where the deliveries or the
/// assessments cannot be assigned.
[[nodiscard]] double quick_bound(const AllocationTable& table);

}  // namespace skein::planning
