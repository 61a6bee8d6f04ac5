// SPDX-License-Identifier: Apache-2.0
#include "assignment_lanes.hpp"

namespace skein::planning {

bool least_sum_avx2(const AssignmentTable& table, const double* row_guess) {
  return AssignmentLanes<4>::least_sum(table, row_guess);
}

void least_largest_avx2(const AssignmentTable& table, AssignmentThreshold& result) {
  AssignmentLanes<4>::least_largest(table, result);
}

}  // namespace skein::planning
