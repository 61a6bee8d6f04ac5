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

}  // namespace
}  // namespace skein::planning
