// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <span>

#include "skein/base/time.hpp"
#include "skein/domain/task.hpp"

namespace skein::planning {

struct AllocationProblem;

/// What a plan is judged by (Wang 2022, eq. 12). The paper adds rewards, metres and seconds and
/// gives no weights; here each part is a share of what could be had, so the weights are plain
/// numbers. The defaults put time first: a timing weight above 0.2 would hold deliveries back for
/// the sake of late assessments under a reward that halves in 140 s.
struct ValueWeights {
  double reward = 1.0;                                   ///< w1
  double range = 1.0;                                    ///< w2
  double timing = 0.2;                                   ///< w3
  Duration timing_reference = std::chrono::seconds{60};  ///< an error of a task that counts as 1
};

/// The value of a plan: raw (J1, J2, J3) and as shares, and J.
struct PlanValue {
  double reward = 0.0;          ///< J1 = sum of F exp(-beta t) over the tasks (eq. 9)
  double range_left_m = 0.0;    ///< J2: of all candidates together, after the plan (eq. 10)
  double timing_error_s = 0.0;  ///< J3 = sum of |planned - required| over the tasks (eq. 11)
  double reward_share = 0.0;    ///< J1 / sum of F
  double range_share = 0.0;     ///< J2 / range of all candidates together before the plan
  double timing_share = 0.0;    ///< J3 / (reference time * tasks)
  double total = 0.0;           ///< J = w1 J1' + w2 J2' - w3 J3', of the shares
};

/// The value of any assignments of the problem's open tasks, by whomever made. t counts from the
/// problem's start to the task's completion: a delivery's moment over the site, an assessment's end
/// of its arc. Required are: each delivery at the common time that the latest of them (less its
/// offset) sets, plus its offset; each assessment at the last delivery plus the site's wait, but
/// not before the start. Each vehicle flies until its task is complete.
/// Precondition: every assignment names a candidate and a task of the site.
[[nodiscard]] PlanValue value_of(const ValueWeights& weights, const AllocationProblem& problem,
                                 std::span<const TaskAssignment> assignments);

}  // namespace skein::planning
