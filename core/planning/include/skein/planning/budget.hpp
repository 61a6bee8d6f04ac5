// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <limits>

namespace skein::planning {

/// How long an anytime method may go on. Nothing in core reads a clock: whoever owns one says when
/// the time is up. With `steps_max` alone the result is the same on every machine.
struct PlanningBudget {
  /// What a step is, the method says.
  std::uint64_t steps_max = std::numeric_limits<std::uint64_t>::max();
  /// True once the time is up; may be empty. Asked often: it must be cheap.
  std::function<bool()> expired;

  [[nodiscard]] bool is_spent(std::uint64_t steps) const {
    return steps >= steps_max || (expired && expired());
  }
};

}  // namespace skein::planning
