// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "skein/base/vector_width.hpp"

namespace skein::planning {

/// column_of[row], each column used at most once; `cost` is the sum of the entries used.
/// Precondition of both: rows <= columns.
struct Assignment {
  std::vector<int> column_of;
  double cost = 0.0;
};

/// Entries that must not be used are +infinity. Nothing where no complete assignment exists.
/// Least sum: shortest augmenting paths (Jonker and Volgenant 1987), O(rows^2 columns).
[[nodiscard]] std::optional<Assignment> least_sum_assignment(const Eigen::MatrixXd& cost);
/// Least largest entry, and the least sum among those: augmenting paths of least largest entry.
[[nodiscard]] std::optional<Assignment> bottleneck_assignment(const Eigen::MatrixXd& cost);

/// The same for callers that solve many problems, or large ones: it keeps its buffers. Exact and
/// deterministic, the same bits on every processor (AVX2 or plain code, chosen at run time).
class AssignmentSolver {
 public:
  using Width = VectorWidth;
  /// What this processor can do, narrowest first.
  [[nodiscard]] static std::span<const Width> widths() { return vector_widths(); }

  AssignmentSolver() : AssignmentSolver{widths().back()} {}
  /// Precondition: one of widths().
  explicit AssignmentSolver(Width width);

  /// `cost` is row by row, of column_of.size() (<= columns) rows. False where there is no complete
  /// assignment; column_of is then of no meaning.
  [[nodiscard]] bool least_sum(std::span<const double> cost, std::size_t columns,
                               std::span<int> column_of);
  /// The least value that the largest entry of a complete assignment can have, and one of the
  /// assignments that have it; -infinity without rows. Entries may be -infinity.
  [[nodiscard]] std::optional<double> bottleneck(std::span<const double> cost, std::size_t columns,
                                                 std::span<int> column_of);

  /// For callers that fill a table in place: row i begins at entries + i * stride, a multiple of 64
  /// bytes. What is beyond a row's columns must be +infinity.
  struct Table {
    double* entries;
    std::size_t stride;
  };
  /// Valid until the next call that gives another table; its entries are those of before, or any.
  [[nodiscard]] Table table(std::size_t rows, std::size_t columns);
  /// Of the last table. `row_guess` (empty, or by row) are dual prices of the rows, as far as they
  /// are known: the nearer they are, the sooner it is solved, and that is all they change but for
  /// ties. Read for square tables only.
  [[nodiscard]] bool least_sum(std::span<const double> row_guess, std::span<int> column_of);
  /// Of the last table; entries must not be -infinity. Nothing where no complete assignment exists.
  [[nodiscard]] std::optional<double> bottleneck(std::span<int> column_of);

  /// Dual prices of the columns, of the last least_sum().
  [[nodiscard]] std::span<const double> column_prices() const;
  /// Of the last bottleneck(), what proves it (Hall 1935): these rows have entries below it in no
  /// other columns than those, which are fewer.
  [[nodiscard]] std::span<const int> crowded_rows() const;
  [[nodiscard]] std::span<const int> near_columns() const;

 private:
  struct alignas(64) Line {
    std::array<double, 8> values;
  };
  struct Layout;
  [[nodiscard]] Layout lay_out(std::span<int> column_of);
  void fill(std::span<const double> cost, std::size_t columns, std::size_t rows, double least);

  Width width_;
  std::size_t rows_ = 0;
  std::size_t columns_ = 0;
  std::size_t stride_ = 0;
  std::size_t crowded_ = 0;
  std::size_t near_ = 0;
  std::vector<Line> numbers_;
  std::vector<int> indices_;
};

}  // namespace skein::planning
