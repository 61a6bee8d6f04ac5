// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
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
/// Least largest entry, and the least sum among those: augmenting paths of least largest entry.
[[nodiscard]] std::optional<Assignment> bottleneck_assignment(const Eigen::MatrixXd& cost);

/// The same for callers that solve many small problems: it keeps its buffers. `cost` is row by
/// row, of column_of.size() (<= columns) rows.
class AssignmentSolver {
 public:
  /// False where there is no complete assignment; column_of is then of no meaning.
  [[nodiscard]] bool least_sum(std::span<const double> cost, std::size_t columns,
                               std::span<int> column_of);
  /// The least value that the largest entry of a complete assignment can have, and one of the
  /// assignments that have it; -infinity without rows. Entries may be -infinity.
  [[nodiscard]] std::optional<double> bottleneck(std::span<const double> cost, std::size_t columns,
                                                 std::span<int> column_of);

 private:
  void start(std::size_t rows, std::size_t columns, std::span<int> column_of);
  void start_row();
  template <typename Onward>
  std::size_t nearest_free(std::span<const double> cost, std::size_t current, double& least,
                           const Onward& onward);
  void take_path(std::size_t row, std::size_t sink, std::span<int> column_of);

  std::vector<double> row_price_;
  std::vector<double> column_price_;
  std::vector<double> distance_;
  std::vector<int> row_of_;
  std::vector<int> predecessor_;
  std::vector<char> done_;
};

}  // namespace skein::planning
