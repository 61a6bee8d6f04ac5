// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/assignment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "skein/base/assert.hpp"

namespace skein::planning {
namespace {
constexpr double kInfinity = std::numeric_limits<double>::infinity();
}

std::optional<Assignment> least_sum_assignment(const Eigen::MatrixXd& cost) {
  const auto rows = static_cast<int>(cost.rows());
  const auto columns = static_cast<int>(cost.cols());
  if (rows > columns) return std::nullopt;
  // Shortest augmenting paths with dual variables; column 0 is a dummy that holds the row to place.
  const auto n = static_cast<std::size_t>(rows) + 1;
  const auto m = static_cast<std::size_t>(columns) + 1;
  std::vector<double> row_dual(n, 0.0);
  std::vector<double> column_dual(m, 0.0);
  std::vector<std::size_t> row_of(m, 0);
  std::vector<std::size_t> came_from(m, 0);
  for (std::size_t row = 1; row < n; ++row) {
    row_of[0] = row;
    std::size_t column = 0;
    std::vector<double> least(m, kInfinity);
    std::vector<bool> used(m, false);
    do {
      used[column] = true;
      const std::size_t i = row_of[column];
      double delta = kInfinity;
      std::size_t next = 0;
      for (std::size_t j = 1; j < m; ++j) {
        if (used[j]) continue;
        const double reduced =
            cost(static_cast<Eigen::Index>(i - 1), static_cast<Eigen::Index>(j - 1)) - row_dual[i] -
            column_dual[j];
        if (reduced < least[j]) {
          least[j] = reduced;
          came_from[j] = column;
        }
        if (least[j] < delta) {
          delta = least[j];
          next = j;
        }
      }
      if (delta == kInfinity) return std::nullopt;
      for (std::size_t j = 0; j < m; ++j) {
        if (used[j]) {
          row_dual[row_of[j]] += delta;
          column_dual[j] -= delta;
        } else {
          least[j] -= delta;
        }
      }
      column = next;
    } while (row_of[column] != 0);
    while (column != 0) {
      const std::size_t previous = came_from[column];
      row_of[column] = row_of[previous];
      column = previous;
    }
  }
  Assignment result;
  result.column_of.assign(static_cast<std::size_t>(rows), -1);
  for (std::size_t j = 1; j < m; ++j) {
    if (row_of[j] == 0) continue;
    result.column_of[row_of[j] - 1] = static_cast<int>(j) - 1;
    result.cost += cost(static_cast<Eigen::Index>(row_of[j] - 1), static_cast<Eigen::Index>(j - 1));
  }
  return result;
}

std::optional<Assignment> bottleneck_assignment(const Eigen::MatrixXd& cost) {
  std::vector<double> levels;
  for (Eigen::Index i = 0; i < cost.rows(); ++i) {
    for (Eigen::Index j = 0; j < cost.cols(); ++j) {
      if (std::isfinite(cost(i, j))) levels.push_back(cost(i, j));
    }
  }
  std::sort(levels.begin(), levels.end());
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
  const auto up_to = [&cost](double level) {
    return least_sum_assignment(
        cost.unaryExpr([level](double c) { return c <= level ? c : kInfinity; }));
  };
  if (levels.empty() || !up_to(levels.back())) {
    return cost.rows() == 0 ? std::optional{Assignment{}} : std::nullopt;
  }
  const auto least = std::partition_point(levels.begin(), levels.end(),
                                          [&](double level) { return !up_to(level).has_value(); });
  auto result = up_to(*least);
  SKEIN_ASSERT(result.has_value());
  result->cost = *least;
  return result;
}

}  // namespace skein::planning
