// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/assignment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "skein/base/assert.hpp"

namespace skein::planning {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Index = Eigen::Index;

std::size_t at(Index i) { return static_cast<std::size_t>(i); }

/// Gives `row` a column by an alternating path of allowed entries; false where there is none.
bool augment(const Eigen::MatrixXd& cost, double threshold, Index row, std::vector<char>& seen,
             std::vector<int>& row_of) {
  for (Index column = 0; column < cost.cols(); ++column) {
    if (!(cost(row, column) <= threshold) || seen[at(column)] != 0) continue;
    seen[at(column)] = 1;
    int& owner = row_of[at(column)];
    if (owner < 0 || augment(cost, threshold, owner, seen, row_of)) {
      owner = static_cast<int>(row);
      return true;
    }
  }
  return false;
}

bool complete_below(const Eigen::MatrixXd& cost, double threshold) {
  std::vector<int> row_of(at(cost.cols()), -1);
  for (Index row = 0; row < cost.rows(); ++row) {
    std::vector<char> seen(at(cost.cols()), 0);
    if (!augment(cost, threshold, row, seen, row_of)) return false;
  }
  return true;
}

}  // namespace

std::optional<Assignment> least_sum_assignment(const Eigen::MatrixXd& cost) {
  SKEIN_ASSERT(cost.rows() <= cost.cols());
  const Index rows = cost.rows();
  const Index columns = cost.cols();
  std::vector<double> row_price(at(rows), 0.0);
  std::vector<double> column_price(at(columns), 0.0);
  std::vector<int> column_of(at(rows), -1);
  std::vector<int> row_of(at(columns), -1);

  for (Index current = 0; current < rows; ++current) {
    // Dijkstra over reduced costs from the row `current` to the nearest free column.
    std::vector<double> distance(at(columns), kInfinity);
    std::vector<Index> predecessor(at(columns), -1);
    std::vector<char> done(at(columns), 0);
    Index row = current;
    Index sink = -1;
    double least = 0.0;
    while (sink < 0) {
      Index nearest = -1;
      for (Index column = 0; column < columns; ++column) {
        if (done[at(column)] != 0) continue;
        const double through =
            least + cost(row, column) - row_price[at(row)] - column_price[at(column)];
        if (through < distance[at(column)]) {
          distance[at(column)] = through;
          predecessor[at(column)] = row;
        }
        const bool nearer = nearest < 0 || distance[at(column)] < distance[at(nearest)];
        const bool free_at_tie = nearest >= 0 && distance[at(column)] == distance[at(nearest)] &&
                                 row_of[at(nearest)] >= 0 && row_of[at(column)] < 0;
        if (nearer || free_at_tie) nearest = column;
      }
      if (nearest < 0 || !std::isfinite(distance[at(nearest)])) return std::nullopt;
      least = distance[at(nearest)];
      done[at(nearest)] = 1;
      if (row_of[at(nearest)] < 0) {
        sink = nearest;
      } else {
        row = row_of[at(nearest)];
      }
    }
    row_price[at(current)] += least;
    for (Index column = 0; column < columns; ++column) {
      if (done[at(column)] == 0 || column == sink) continue;
      const double slack = least - distance[at(column)];
      row_price[at(row_of[at(column)])] += slack;
      column_price[at(column)] -= slack;
    }
    Index column = sink;
    while (true) {
      const Index from = predecessor[at(column)];
      row_of[at(column)] = static_cast<int>(from);
      const Index next = column_of[at(from)];
      column_of[at(from)] = static_cast<int>(column);
      if (from == current) break;
      column = next;
    }
  }

  Assignment result{std::move(column_of), 0.0};
  for (Index row = 0; row < rows; ++row) result.cost += cost(row, result.column_of[at(row)]);
  return result;
}

std::optional<Assignment> bottleneck_assignment(const Eigen::MatrixXd& cost) {
  SKEIN_ASSERT(cost.rows() <= cost.cols());
  if (cost.rows() == 0) return Assignment{};
  std::vector<double> values;
  for (const double value : cost.reshaped()) {
    if (std::isfinite(value)) values.push_back(value);
  }
  std::sort(values.begin(), values.end());
  const auto threshold = std::partition_point(
      values.begin(), values.end(), [&](double value) { return !complete_below(cost, value); });
  if (threshold == values.end()) return std::nullopt;
  const Eigen::MatrixXd allowed = cost.unaryExpr(
      [limit = *threshold](double value) { return value <= limit ? value : kInfinity; });
  auto result = least_sum_assignment(allowed);
  SKEIN_ASSERT(result.has_value());
  return result;
}

}  // namespace skein::planning
