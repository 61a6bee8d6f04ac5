// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "allocation_table.hpp"

/// What is published and common, to compare with. Neither looks at the range that waiting for the
/// others costs: whoever has not enough is left out, and the choice is made again.
namespace skein::planning {

/// Polynomial-time coalition formation (Sujit, Manathara, Ghose 2014): bidders by their time of
/// arrival are taken in until their resources suffice; walking back, each without whom they still
/// suffice is dropped. So the coalition completes earliest and, given that, is the smallest. The
/// members then choose in order of arrival, each the task that it can be at soonest.
[[nodiscard]] MethodResult polynomial_allocation(AllocationTable& table);

/// Contract net: the tasks are tendered one by one, in order, each to the bidder that is there
/// first. A bid that would leave a later task without any bidder is passed over.
[[nodiscard]] MethodResult greedy_allocation(AllocationTable& table);

}  // namespace skein::planning
