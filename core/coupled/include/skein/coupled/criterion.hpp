// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace skein::planning {

/// What is optimised. Every criterion can only get worse when a task ends later; so for given
/// orders of tasks the earliest times are the best, and what remains to be found is the orders.
enum class Criterion : std::uint8_t {
  /// J of Wang 2022, eq. (8)-(12), maximised: reward that decays with the time at which a task
  /// ends, over the sum of rewards, and range left, over the sum of ranges; weighted. J3 is 0
  /// because the times that deliveries require of each other are constraints here.
  value,
  completion,  ///< seconds, minimised: the mean of the ends of the tasks, weighted by reward
  makespan,    ///< seconds, minimised: the end of the last task
};

}  // namespace skein::planning
