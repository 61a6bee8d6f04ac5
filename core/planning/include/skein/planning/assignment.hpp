// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace skein::planning {

/// column_of[row], each column used at most once; `cost` is the sum of the entries used.
/// Precondition of both: rows <= columns.
struct Assignment {
  std::vector<int> column_of;
  double cost = 0.0;
};

/// Entries that must not be used are +infinity. Nothing where no complete assignment exists.
/// Least sum: shortest augmenting paths (Crouse 2016), O(rows^2 columns).
[[nodiscard]] std::optional<Assignment> least_sum_assignment(const Eigen::MatrixXd& cost);
/// Least largest entry, and the least sum among those: thresholds by bisection.
[[nodiscard]] std::optional<Assignment> bottleneck_assignment(const Eigen::MatrixXd& cost);

}  // namespace skein::planning
