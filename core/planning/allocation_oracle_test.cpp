// SPDX-License-Identifier: Apache-2.0
#include <glpk.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"
#include "skein/planning/allocation.hpp"
#include "skein/planning/assignment.hpp"
#include "skein/planning/dubins.hpp"
#include "skein/planning/task_path.hpp"

/// The assignment problems as mixed integer programs, solved by GLPK, which knows nothing of us.
namespace skein::planning {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// x(r, c) in {0, 1}, each row once, each column at most once, infinite entries forbidden. Either
/// the least sum of the entries used or, with a last variable above all of them, the least largest.
class Program {
 public:
  Program(const Eigen::MatrixXd& cost, bool bottleneck)
      : problem_{glp_create_prob()},
        rows_{static_cast<int>(cost.rows())},
        columns_{static_cast<int>(cost.cols())} {
    glp_term_out(GLP_OFF);
    glp_add_rows(problem_, rows_ + columns_ + (bottleneck ? rows_ : 0));
    glp_add_cols(problem_, rows_ * columns_ + 1);
    const int largest = rows_ * columns_ + 1;
    glp_set_col_bnds(problem_, largest, GLP_FR, 0.0, 0.0);
    glp_set_obj_coef(problem_, largest, bottleneck ? 1.0 : 0.0);
    for (int r = 0; r < rows_; ++r) {
      glp_set_row_bnds(problem_, r + 1, GLP_FX, 1.0, 1.0);
      if (!bottleneck) continue;
      glp_set_row_bnds(problem_, rows_ + columns_ + r + 1, GLP_LO, 0.0, 0.0);
      add(rows_ + columns_ + r + 1, largest, 1.0);
    }
    for (int c = 0; c < columns_; ++c) {
      glp_set_row_bnds(problem_, rows_ + c + 1, GLP_UP, 0.0, 1.0);
    }
    for (int r = 0; r < rows_; ++r) {
      for (int c = 0; c < columns_; ++c) {
        const int variable = r * columns_ + c + 1;
        const double entry = cost(r, c);
        glp_set_col_kind(problem_, variable, GLP_BV);
        add(r + 1, variable, 1.0);
        add(rows_ + c + 1, variable, 1.0);
        if (!std::isfinite(entry)) {
          glp_set_col_bnds(problem_, variable, GLP_FX, 0.0, 0.0);
        } else if (bottleneck) {
          add(rows_ + columns_ + r + 1, variable, -entry);
        } else {
          glp_set_obj_coef(problem_, variable, entry);
        }
      }
    }
    glp_load_matrix(problem_, static_cast<int>(row_.size()) - 1, row_.data(), column_.data(),
                    value_.data());
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  ~Program() { glp_delete_prob(problem_); }

  [[nodiscard]] std::optional<double> solve() {
    glp_iocp options;
    glp_init_iocp(&options);
    options.msg_lev = GLP_MSG_OFF;
    options.presolve = GLP_ON;
    if (glp_intopt(problem_, &options) != 0 || glp_mip_status(problem_) != GLP_OPT) {
      return std::nullopt;
    }
    return glp_mip_obj_val(problem_);
  }

 private:
  void add(int row, int column, double value) {
    row_.push_back(row);
    column_.push_back(column);
    value_.push_back(value);
  }

  glp_prob* problem_;
  int rows_;
  int columns_;
  std::vector<int> row_{0};  ///< GLPK counts from 1
  std::vector<int> column_{0};
  std::vector<double> value_{0.0};
};

TEST(AllocationOracle, AssignmentsAgreeWithGlpk) {
  Random random{81};
  for (int i = 0; i < 30; ++i) {
    const int columns = 4 + static_cast<int>(random.index(12));
    const int rows = 2 + static_cast<int>(random.index(5));
    if (rows > columns) continue;
    Eigen::MatrixXd cost(rows, columns);
    for (double& entry : cost.reshaped()) {
      entry = random.chance(0.3) ? kInfinity : random.uniform(10.0, 100.0);
    }
    const auto sum = least_sum_assignment(cost);
    const auto least = Program{cost, false}.solve();
    ASSERT_EQ(sum.has_value(), least.has_value());
    const auto bottleneck = bottleneck_assignment(cost);
    const auto largest = Program{cost, true}.solve();
    ASSERT_EQ(bottleneck.has_value(), largest.has_value());
    if (!sum || !bottleneck) continue;
    EXPECT_NEAR(sum->cost, *least, 1e-6);
    double ours = 0.0;
    for (int r = 0; r < rows; ++r) {
      ours = std::max(ours, cost(r, bottleneck->column_of[static_cast<std::size_t>(r)]));
    }
    EXPECT_NEAR(ours, *largest, 1e-6);
  }
}

struct Fleet {
  AllocationProblem problem;
  Eigen::MatrixXd least_s;  ///< to each delivery, by each candidate
};

/// Vehicles on a ring far from the site, so that no length has a gap.
Fleet random_fleet(Random& random, std::size_t deliveries, std::size_t vehicles) {
  Fleet fleet;
  AllocationProblem& problem = fleet.problem;
  problem.site.id = SiteId{1};
  for (std::size_t i = 0; i < deliveries; ++i) {
    problem.site.deliveries.push_back({random.uniform(-kPi, kPi), {}});
  }
  problem.site.reward_decay_per_s = 0.005;
  problem.open_tasks = tasks_after_survey(problem.site);
  fleet.least_s.resize(static_cast<Eigen::Index>(deliveries), static_cast<Eigen::Index>(vehicles));
  for (std::size_t i = 0; i < vehicles; ++i) {
    Candidate c;
    c.id = VehicleId{static_cast<std::uint16_t>(i + 1)};
    const Vec2 at = random.uniform(2500.0, 6000.0) * unit_vector(random.uniform(-kPi, kPi));
    c.pose = {at.x(), at.y(), random.uniform(-kPi, kPi)};
    c.speed_mps = random.chance(0.5) ? 50.0 : 60.0;
    c.planning_radius_m = 165.0;
    c.range_left_m = 20000.0;
    c.final_approach_m = 300.0;
    c.capabilities.add(TaskKind::deliver);
    c.loads = 1;
    problem.candidates.push_back(c);
    for (std::size_t d = 0; d < deliveries; ++d) {
      const TaskPath task =
          delivery_path(problem.site, problem.site.deliveries[d], c.final_approach_m);
      const double length_m =
          shortest_dubins_length(c.pose, task.entry, c.planning_radius_m) + c.final_approach_m;
      fleet.least_s(static_cast<Eigen::Index>(d), static_cast<Eigen::Index>(i)) =
          length_m * AllocationParams{}.time_margin / c.speed_mps;
    }
  }
  return fleet;
}

TEST(AllocationOracle, TheEarliestRendezvousIsGlpksBottleneck) {
  Random random{82};
  for (int i = 0; i < 10; ++i) {
    const Fleet fleet = random_fleet(random, 4, 10);
    AllocationParams params;
    params.method = AllocationMethod::earliest;
    const auto plan = allocate(params, fleet.problem);
    ASSERT_TRUE(plan.ok());
    const auto largest = Program{fleet.least_s, true}.solve();
    ASSERT_TRUE(largest.has_value());
    EXPECT_NEAR(plan->first_delivery_s, *largest, 1e-6);
  }
}

/// J falls with the rendezvous, so that the best one is the least moment of some pair: one program
/// for each of them, with the metres flown as its cost.
TEST(AllocationOracle, TheGreatestValueIsGlpksOverAllRendezvous) {
  Random random{83};
  for (int i = 0; i < 6; ++i) {
    const Fleet fleet = random_fleet(random, 3, 7);
    AllocationParams params;
    params.method = AllocationMethod::exact;
    const auto plan = allocate(params, fleet.problem);
    ASSERT_TRUE(plan.ok());
    EXPECT_TRUE(plan->proven);
    double range_m = 0.0;
    for (const Candidate& c : fleet.problem.candidates) range_m += c.range_left_m;
    double best = -kInfinity;
    for (const double moment_s : fleet.least_s.reshaped()) {
      Eigen::MatrixXd metres = fleet.least_s;
      for (Eigen::Index c = 0; c < metres.cols(); ++c) {
        const double speed = fleet.problem.candidates[static_cast<std::size_t>(c)].speed_mps;
        for (double& entry : metres.col(c)) {
          entry = entry <= moment_s ? speed * moment_s : kInfinity;
        }
      }
      const auto flown_m = Program{metres, false}.solve();
      if (!flown_m) continue;
      best = std::max(best, std::exp(-0.005 * moment_s) + (range_m - *flown_m) / range_m);
    }
    EXPECT_NEAR(plan->value.total, best, 2.0 * kValueTolerance);
    EXPECT_GE(plan->value_bound, best - 1e-9);
  }
}

}  // namespace
}  // namespace skein::planning
