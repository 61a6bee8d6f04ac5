// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/assignment.hpp"

#include <algorithm>
#include <limits>

#include "assignment_lanes.hpp"
#include "skein/base/assert.hpp"

namespace skein::planning {
namespace {

using Width = AssignmentSolver::Width;
using Baseline = AssignmentLanes<2>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Stands for -infinity, of which nothing can be subtracted.
constexpr double kLowest = std::numeric_limits<double>::lowest();
constexpr std::size_t kRowsOfDoubles = 6;  ///< before the entries
constexpr std::size_t kRowsOfInts = 6;

std::vector<double> by_rows(const Eigen::MatrixXd& cost) {
  std::vector<double> entries;
  entries.reserve(static_cast<std::size_t>(cost.size()));
  for (Eigen::Index row = 0; row < cost.rows(); ++row) {
    for (Eigen::Index column = 0; column < cost.cols(); ++column) {
      entries.push_back(cost(row, column));
    }
  }
  return entries;
}

std::optional<Assignment> least_sum_of(AssignmentSolver& solver, std::span<const double> cost,
                                       std::size_t rows, std::size_t columns) {
  Assignment result{std::vector<int>(rows), 0.0};
  if (!solver.least_sum(cost, columns, result.column_of)) return std::nullopt;
  for (std::size_t row = 0; row < rows; ++row) {
    result.cost += cost[row * columns + static_cast<std::size_t>(result.column_of[row])];
  }
  return result;
}

}  // namespace

AssignmentSolver::AssignmentSolver(Width width) : width_{width} {
  SKEIN_ASSERT(static_cast<std::size_t>(width) < widths().size());
}

struct AssignmentSolver::Layout {
  AssignmentTable table;
  int* crowded;
  int* near;
};

AssignmentSolver::Table AssignmentSolver::table(std::size_t rows, std::size_t columns) {
  SKEIN_ASSERT(rows <= columns);
  rows_ = rows;
  columns_ = columns;
  stride_ = (columns + kAssignmentLine - 1) / kAssignmentLine * kAssignmentLine;
  const std::size_t lines = (rows + kRowsOfDoubles) * (stride_ / kAssignmentLine);
  if (numbers_.size() < lines) numbers_.resize(lines);
  if (indices_.size() < kRowsOfInts * stride_) indices_.resize(kRowsOfInts * stride_);
  if (stride_ == 0) return {nullptr, 0};
  return {numbers_.data()->values.data() + kRowsOfDoubles * stride_, stride_};
}

AssignmentSolver::Layout AssignmentSolver::lay_out(std::span<int> column_of) {
  SKEIN_ASSERT(column_of.size() == rows_);
  double* number = numbers_.data()->values.data();
  int* index = indices_.data();
  Layout layout{};
  AssignmentTable& t = layout.table;
  t.rows = rows_;
  t.columns = columns_;
  t.stride = stride_;
  t.column_of = column_of.data();
  for (double** row :
       {&t.price, &t.distance, &t.taken, &t.reach, &t.base, &t.kept_price, &t.cost}) {
    *row = number;
    number += stride_;
  }
  for (int** row :
       {&layout.crowded, &layout.near, &t.row_of, &t.waiting, &t.seen_row, &t.seen_column}) {
    *row = index;
    index += stride_;
  }
  return layout;
}

void AssignmentSolver::fill(std::span<const double> cost, std::size_t columns, std::size_t rows,
                            double least) {
  SKEIN_ASSERT(cost.size() == rows * columns);
  const Table to = table(rows, columns);
  for (std::size_t row = 0; row < rows; ++row) {
    double* const entries = to.entries + row * to.stride;
    for (std::size_t j = 0; j < columns; ++j) entries[j] = std::max(least, cost[row * columns + j]);
    std::fill(entries + columns, entries + to.stride, kInfinity);
  }
}

bool AssignmentSolver::least_sum(std::span<const double> cost, std::size_t columns,
                                 std::span<int> column_of) {
  fill(cost, columns, column_of.size(), kLowest);
  return least_sum(std::span<const double>{}, column_of);
}

bool AssignmentSolver::least_sum(std::span<const double> row_guess, std::span<int> column_of) {
  SKEIN_ASSERT(row_guess.empty() || row_guess.size() == rows_);
  if (rows_ == 0) return true;
  const Layout layout = lay_out(column_of);
  const double* const guess = row_guess.empty() ? nullptr : row_guess.data();
#if defined(__x86_64__)
  if (width_ == Width::avx2) return least_sum_avx2(layout.table, guess);
#endif
  return Baseline::least_sum(layout.table, guess);
}

std::optional<double> AssignmentSolver::bottleneck(std::span<const double> cost,
                                                   std::size_t columns, std::span<int> column_of) {
  fill(cost, columns, column_of.size(), kLowest);
  const auto found = bottleneck(column_of);
  return found && *found == kLowest ? -kInfinity : found;
}

std::optional<double> AssignmentSolver::bottleneck(std::span<int> column_of) {
  crowded_ = near_ = 0;
  if (rows_ == 0) return -kInfinity;
  const Layout layout = lay_out(column_of);
  AssignmentThreshold found{0.0, 0, 0, layout.crowded, layout.near};
#if defined(__x86_64__)
  if (width_ == Width::avx2) {
    least_largest_avx2(layout.table, found);
  } else {
    Baseline::least_largest(layout.table, found);
  }
#else
  Baseline::least_largest(layout.table, found);
#endif
  if (found.threshold == kInfinity) return std::nullopt;
  crowded_ = found.rows;
  near_ = found.columns;
  return found.threshold;
}

std::span<const double> AssignmentSolver::column_prices() const {
  if (columns_ == 0) return {};
  return {numbers_.data()->values.data(), columns_};
}

std::span<const int> AssignmentSolver::crowded_rows() const { return {indices_.data(), crowded_}; }

std::span<const int> AssignmentSolver::near_columns() const {
  return {indices_.data() + stride_, near_};
}

std::optional<Assignment> least_sum_assignment(const Eigen::MatrixXd& cost) {
  AssignmentSolver solver;
  return least_sum_of(solver, by_rows(cost), static_cast<std::size_t>(cost.rows()),
                      static_cast<std::size_t>(cost.cols()));
}

std::optional<Assignment> bottleneck_assignment(const Eigen::MatrixXd& cost) {
  AssignmentSolver solver;
  const auto rows = static_cast<std::size_t>(cost.rows());
  const auto columns = static_cast<std::size_t>(cost.cols());
  std::vector<double> entries = by_rows(cost);
  std::vector<int> column_of(rows);
  const auto threshold = solver.bottleneck(entries, columns, column_of);
  if (!threshold) return std::nullopt;
  for (double& entry : entries) {
    if (entry > *threshold) entry = kInfinity;
  }
  return least_sum_of(solver, entries, rows, columns);
}

}  // namespace skein::planning
