// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/assignment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "skein/base/random.hpp"

namespace skein::planning {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Best {
  double sum = kInfinity;
  double largest = kInfinity;
  double sum_of_least_largest = kInfinity;
};

/// By every permutation of the columns.
Best brute_force(const Eigen::MatrixXd& cost) {
  std::vector<int> columns(static_cast<std::size_t>(cost.cols()));
  std::iota(columns.begin(), columns.end(), 0);
  Best best;
  do {
    double sum = 0.0;
    double largest = -kInfinity;
    for (Eigen::Index r = 0; r < cost.rows(); ++r) {
      const double value = cost(r, columns[static_cast<std::size_t>(r)]);
      sum += value;
      largest = std::max(largest, value);
    }
    best.sum = std::min(best.sum, sum);
    if (largest < best.largest) best.sum_of_least_largest = kInfinity;
    best.largest = std::min(best.largest, largest);
    if (largest == best.largest) {
      best.sum_of_least_largest = std::min(best.sum_of_least_largest, sum);
    }
  } while (std::next_permutation(columns.begin(), columns.end()));
  return best;
}

Eigen::MatrixXd random_matrix(Random& random, int rows, int columns, double forbidden) {
  Eigen::MatrixXd cost(rows, columns);
  for (double& value : cost.reshaped()) {
    // Few values, so that ties are common.
    value = random.chance(forbidden) ? kInfinity : static_cast<double>(random.index(20)) - 3.0;
  }
  return cost;
}

double largest_of(const Eigen::MatrixXd& cost, const Assignment& a) {
  double largest = -kInfinity;
  for (Eigen::Index r = 0; r < cost.rows(); ++r) {
    largest = std::max(largest, cost(r, a.column_of[static_cast<std::size_t>(r)]));
  }
  return largest;
}

void expect_valid(const Eigen::MatrixXd& cost, const Assignment& a) {
  ASSERT_EQ(static_cast<Eigen::Index>(a.column_of.size()), cost.rows());
  const std::set<int> used(a.column_of.begin(), a.column_of.end());
  EXPECT_EQ(used.size(), a.column_of.size());
  double sum = 0.0;
  for (Eigen::Index r = 0; r < cost.rows(); ++r) {
    sum += cost(r, a.column_of[static_cast<std::size_t>(r)]);
  }
  EXPECT_DOUBLE_EQ(a.cost, sum);
}

TEST(Assignment, BothAgreeWithEveryPermutation) {
  Random random{21};
  int impossible = 0;
  for (int i = 0; i < 600; ++i) {
    const int columns = 1 + static_cast<int>(random.index(6));
    const int rows = 1 + static_cast<int>(random.index(static_cast<std::uint64_t>(columns)));
    const Eigen::MatrixXd cost = random_matrix(random, rows, columns, i % 2 == 0 ? 0.0 : 0.4);
    const Best best = brute_force(cost);
    const auto sum = least_sum_assignment(cost);
    const auto bottleneck = bottleneck_assignment(cost);
    ASSERT_EQ(sum.has_value(), std::isfinite(best.sum));
    ASSERT_EQ(bottleneck.has_value(), std::isfinite(best.sum));
    if (!sum) {
      ++impossible;
      continue;
    }
    expect_valid(cost, *sum);
    expect_valid(cost, *bottleneck);
    EXPECT_DOUBLE_EQ(sum->cost, best.sum);
    EXPECT_DOUBLE_EQ(largest_of(cost, *bottleneck), best.largest);
    EXPECT_DOUBLE_EQ(bottleneck->cost, best.sum_of_least_largest);
  }
  EXPECT_GT(impossible, 30);
}

TEST(Assignment, NoRowsNeedNothing) {
  const Eigen::MatrixXd cost(0, 3);
  ASSERT_TRUE(least_sum_assignment(cost).has_value());
  ASSERT_TRUE(bottleneck_assignment(cost).has_value());
  EXPECT_TRUE(bottleneck_assignment(cost)->column_of.empty());
}

TEST(Assignment, ManyColumns) {
  Random random{22};
  Eigen::MatrixXd cost(14, 56);
  for (double& value : cost.reshaped()) value = random.uniform();
  // Dual bound: the least of each row is never more than what the assignment costs.
  const auto sum = least_sum_assignment(cost);
  ASSERT_TRUE(sum.has_value());
  EXPECT_GE(sum->cost, cost.rowwise().minCoeff().sum());
  const auto bottleneck = bottleneck_assignment(cost);
  ASSERT_TRUE(bottleneck.has_value());
  EXPECT_GE(bottleneck->cost, sum->cost - 1e-12);
  EXPECT_LE(largest_of(cost, *bottleneck), largest_of(cost, *sum));
  EXPECT_GE(largest_of(cost, *bottleneck), cost.rowwise().minCoeff().maxCoeff());
}

/// A table, and what a solver makes of it.
struct Table {
  std::size_t rows;
  std::size_t columns;
  std::vector<double> cost;
  [[nodiscard]] double at(std::size_t row, int column) const {
    return cost[row * columns + static_cast<std::size_t>(column)];
  }
};

/// Some with ties, some with entries that are forbidden, square or not.
std::vector<Table> tables(Random& random) {
  std::vector<Table> result;
  for (int i = 0; i < 120; ++i) {
    const std::size_t columns = 1 + random.index(i < 100 ? 24 : 90);
    const std::size_t rows = i % 2 == 0 ? columns : 1 + random.index(columns);
    Table table{rows, columns, std::vector<double>(rows * columns)};
    const double forbidden = i % 3 == 0 ? 0.2 : 0.0;
    for (double& entry : table.cost) {
      entry = i % 4 < 2 ? static_cast<double>(random.index(9)) : random.uniform(-50.0, 1000.0);
      if (random.chance(forbidden)) entry = kInfinity;
    }
    result.push_back(table);
  }
  return result;
}

/// Weak duality: no assignment costs less than the sum of all column prices and of what each row's
/// least entry is without them, where no price is above 0 of columns that may stay free.
void expect_proven(const Table& table, std::span<const int> column_of,
                   std::span<const double> price) {
  ASSERT_EQ(price.size(), table.columns);
  double sum = 0.0;
  double bound = 0.0;
  for (const double column : price) {
    bound += column;
    if (table.rows < table.columns) {
      EXPECT_LE(column, 0.0);
    }
  }
  for (std::size_t row = 0; row < table.rows; ++row) {
    sum += table.at(row, column_of[row]);
    double least = kInfinity;
    for (std::size_t j = 0; j < table.columns; ++j) {
      least = std::min(least, table.cost[row * table.columns + j] - price[j]);
    }
    bound += least;
  }
  EXPECT_NEAR(sum, bound, 1e-9 * (1.0 + std::abs(sum)));
  EXPECT_EQ(std::set<int>(column_of.begin(), column_of.end()).size(), table.rows);
}

TEST(AssignmentSolver, ProvesWhatItFindsWithEveryWidthTheSame) {
  Random random{23};
  int solved = 0;
  for (const Table& table : tables(random)) {
    std::vector<int> first;
    std::vector<double> first_price;
    for (const auto width : AssignmentSolver::widths()) {
      AssignmentSolver solver{width};
      std::vector<int> column_of(table.rows);
      if (!solver.least_sum(table.cost, table.columns, column_of)) continue;
      const auto price = solver.column_prices();
      expect_proven(table, column_of, price);
      ++solved;
      if (first.empty()) {
        first = column_of;
        first_price.assign(price.begin(), price.end());
      }
      EXPECT_EQ(column_of, first);
      EXPECT_TRUE(std::ranges::equal(price, first_price));
    }
  }
  EXPECT_GT(solved, 150);
}

TEST(AssignmentSolver, AnyGuessGivesTheSameSum) {
  Random random{24};
  AssignmentSolver solver;
  for (const Table& table : tables(random)) {
    std::vector<int> column_of(table.rows);
    if (!solver.least_sum(table.cost, table.columns, column_of)) continue;
    const auto sum = [&] {
      double result = 0.0;
      for (std::size_t row = 0; row < table.rows; ++row) result += table.at(row, column_of[row]);
      return result;
    };
    const double without = sum();
    std::vector<double> guess(table.rows);
    for (double& price : guess) price = random.uniform(-300.0, 300.0);
    ASSERT_TRUE(solver.least_sum(guess, column_of));  // the entries are still there
    EXPECT_NEAR(sum(), without, 1e-9 * (1.0 + std::abs(without)));
    expect_proven(table, column_of, solver.column_prices());
  }
}

TEST(AssignmentSolver, BottlenecksAreProvenByRowsWithTooFewColumns) {
  Random random{25};
  AssignmentSolver solver;
  int proven = 0;
  for (const Table& table : tables(random)) {
    std::vector<int> column_of(table.rows);
    const auto threshold = solver.bottleneck(table.cost, table.columns, column_of);
    if (!threshold) continue;
    const auto crowded = solver.crowded_rows();
    const auto near = solver.near_columns();
    const std::set<int> among(near.begin(), near.end());
    EXPECT_EQ(among.size(), near.size());
    EXPECT_GT(std::set<int>(crowded.begin(), crowded.end()).size(), near.size());
    double largest = -kInfinity;
    for (std::size_t row = 0; row < table.rows; ++row) {
      largest = std::max(largest, table.at(row, column_of[row]));
    }
    EXPECT_EQ(largest, *threshold);
    for (const int row : crowded) {
      for (int j = 0; j < static_cast<int>(table.columns); ++j) {
        if (among.contains(j)) continue;
        EXPECT_GE(table.at(static_cast<std::size_t>(row), j), *threshold);
      }
    }
    ++proven;
  }
  EXPECT_GT(proven, 80);
}

TEST(AssignmentSolver, EntriesMayBeOfNoCostAtAll) {
  AssignmentSolver solver;
  std::vector<int> column_of(2);
  const std::vector<double> free{-kInfinity, kInfinity, 5.0, kInfinity, -kInfinity, -kInfinity};
  EXPECT_EQ(solver.bottleneck(free, 3, column_of), -kInfinity);
  const std::vector<double> contested{-kInfinity, 4.0, 7.0, -kInfinity, 9.0, kInfinity};
  EXPECT_EQ(solver.bottleneck(contested, 3, column_of), 4.0);
  const std::vector<double> impossible{-kInfinity, kInfinity, -kInfinity, kInfinity};
  EXPECT_EQ(solver.bottleneck(impossible, 2, column_of), std::nullopt);
  EXPECT_FALSE(solver.least_sum(std::vector<double>{1.0, kInfinity, 2.0, kInfinity}, 2, column_of));
  EXPECT_FALSE(solver.least_sum(std::vector<double>{1.0, 2.0, kInfinity, kInfinity}, 2, column_of));
}

}  // namespace
}  // namespace skein::planning
