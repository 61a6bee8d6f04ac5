// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/assignment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "skein/base/assert.hpp"

namespace skein::planning {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

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

void AssignmentSolver::start(std::size_t rows, std::size_t columns, std::span<int> column_of) {
  SKEIN_ASSERT(rows <= columns);
  row_price_.assign(rows, 0.0);
  column_price_.assign(columns, 0.0);
  row_of_.assign(columns, -1);
  std::fill(column_of.begin(), column_of.end(), -1);
}

void AssignmentSolver::start_row() {
  distance_.assign(row_of_.size(), kInfinity);
  predecessor_.assign(row_of_.size(), -1);
  done_.assign(row_of_.size(), 0);
}

/// Swaps the owners along the alternating path from `row` to the free column `sink`.
void AssignmentSolver::take_path(std::size_t row, std::size_t sink, std::span<int> column_of) {
  auto column = static_cast<int>(sink);
  while (true) {
    const int from = predecessor_[static_cast<std::size_t>(column)];
    row_of_[static_cast<std::size_t>(column)] = from;
    std::swap(column, column_of[static_cast<std::size_t>(from)]);
    if (static_cast<std::size_t>(from) == row) return;
  }
}

/// Dijkstra from the row `current` to the nearest free column; kNone where none is reached. `least`
/// is how far the search has come. `onward(row, least)` says how far it is by way of that row:
/// a function of an entry of its and the entry's column.
template <typename Onward>
std::size_t AssignmentSolver::nearest_free(std::span<const double> cost, std::size_t current,
                                           double& least, const Onward& onward) {
  const std::size_t columns = row_of_.size();
  start_row();
  std::size_t row = current;
  while (true) {
    const std::span<const double> entries = cost.subspan(row * columns, columns);
    const auto through = onward(row, least);
    std::size_t nearest = kNone;
    double nearest_distance = kInfinity;
    for (std::size_t column = 0; column < columns; ++column) {
      if (done_[column] != 0) continue;
      const double reached = through(entries[column], column);
      if (reached < distance_[column]) {
        distance_[column] = reached;
        predecessor_[column] = static_cast<int>(row);
      }
      const double distance = distance_[column];
      const bool free_at_tie = distance == nearest_distance && nearest != kNone &&
                               row_of_[nearest] >= 0 && row_of_[column] < 0;
      if (distance < nearest_distance || free_at_tie) {
        nearest = column;
        nearest_distance = distance;
      }
    }
    if (nearest == kNone) return kNone;
    least = nearest_distance;
    done_[nearest] = 1;
    if (row_of_[nearest] < 0) return nearest;
    row = static_cast<std::size_t>(row_of_[nearest]);
  }
}

bool AssignmentSolver::least_sum(std::span<const double> cost, std::size_t columns,
                                 std::span<int> column_of) {
  const std::size_t rows = column_of.size();
  SKEIN_ASSERT(cost.size() == rows * columns);
  start(rows, columns, column_of);
  // Lengths add up, over reduced costs.
  const auto onward = [this](std::size_t row, double least) {
    return [this, base = least - row_price_[row]](double entry, std::size_t column) {
      return base + entry - column_price_[column];
    };
  };
  for (std::size_t current = 0; current < rows; ++current) {
    double least = 0.0;
    const std::size_t sink = nearest_free(cost, current, least, onward);
    if (sink == kNone) return false;
    row_price_[current] += least;
    for (std::size_t column = 0; column < columns; ++column) {
      if (done_[column] == 0 || column == sink) continue;
      const double slack = least - distance_[column];
      row_price_[static_cast<std::size_t>(row_of_[column])] += slack;
      column_price_[column] -= slack;
    }
    take_path(current, sink, column_of);
  }
  return true;
}

/// The assignment of the rows so far stays within the threshold; by Berge's theorem one more row
/// fits within the least threshold at which an alternating path leads from it to a free column.
std::optional<double> AssignmentSolver::bottleneck(std::span<const double> cost,
                                                   std::size_t columns, std::span<int> column_of) {
  const std::size_t rows = column_of.size();
  SKEIN_ASSERT(cost.size() == rows * columns);
  start(rows, columns, column_of);
  // The length of a path is its largest entry.
  const auto onward = [](std::size_t, double threshold) {
    return [threshold](double entry, std::size_t) { return std::max(threshold, entry); };
  };
  double threshold = -kInfinity;
  for (std::size_t current = 0; current < rows; ++current) {
    const std::size_t sink = nearest_free(cost, current, threshold, onward);
    if (sink == kNone) return std::nullopt;
    take_path(current, sink, column_of);
  }
  return threshold;
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
