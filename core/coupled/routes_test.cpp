// SPDX-License-Identifier: Apache-2.0
#include "routes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "instances.hpp"
#include "model.hpp"

/// Makespans by routes against every order of every choice of vehicles, without a bound.
namespace skein::planning::coupled {
namespace {

using std::chrono::seconds;

constexpr Routes::Effort kAll{1'000'000, 1'000'000};

/// The least makespan: every task at every place of every vehicle, one after the other.
class Exhaustive {
 public:
  explicit Exhaustive(const Model& model)
      : model_{model}, timing_{model}, orders_(model.vehicles.size()) {
    insert(0);
  }
  [[nodiscard]] double best() const { return best_; }
  [[nodiscard]] const Orders& worst() const { return worst_orders_; }
  [[nodiscard]] double worst_cost() const { return worst_; }

 private:
  void insert(Index t) {
    if (t == model_.task_count()) {
      const double cost = timing_.evaluate(orders_);
      if (cost == kInfinity) return;
      best_ = std::min(best_, cost);
      if (cost <= worst_) return;
      worst_ = cost;
      worst_orders_ = orders_;
      return;
    }
    const Task& task = model_.tasks[at(t)];
    for (Index i = 0; i < model_.vehicle_count(); ++i) {
      auto& order = orders_[at(i)];
      if (!may_take(i, task)) continue;
      for (Index v = task.first_visit; v < task.first_visit + task.visits; ++v) {
        for (std::size_t p = 0; p <= order.size(); ++p) {
          order.insert(order.begin() + static_cast<std::ptrdiff_t>(p), v);
          insert(t + 1);
          order.erase(order.begin() + static_cast<std::ptrdiff_t>(p));
        }
      }
    }
  }
  [[nodiscard]] bool may_take(Index vehicle, const Task& task) const {
    const auto& order = orders_[at(vehicle)];
    if (has_its_share(model_, order, task)) return false;
    if (task.id.kind != TaskKind::deliver) return true;
    int loads = model_.vehicles[at(vehicle)].loads;
    for (const Index v : order) {
      if (model_.tasks[at(model_.task_of[at(v)])].id.kind == TaskKind::deliver) --loads;
    }
    return loads > 0;
  }

  const Model& model_;
  Timing timing_;
  Orders orders_;
  Orders worst_orders_;
  double best_ = kInfinity;
  double worst_ = -kInfinity;
};

CoupledProblem problem_of(std::uint64_t seed) {
  Random random{700 + seed};
  CoupledDraw draw;
  draw.sites = 2;
  draw.vehicles = 3;
  draw.deliveries = seed % 4 == 1 ? 2 : 1;
  draw.side_m = seed % 4 < 2 ? 6000.0 : 2500.0;
  draw.interval_s = seed % 8 == 5 ? 7.0 : 0.0;
  CoupledProblem problem = draw_problem(random, draw);
  problem.criterion = Criterion::makespan;
  problem.decide_wait = seconds{seed % 4 == 1 ? 8 : 0};
  problem.flyable_waits = seed % 2 == 0;
  problem.share = seed % 7 == 6 ? TaskShare::one_a_site : TaskShare::any;
  if (seed % 4 == 3) problem.vehicles[0].range_left_m = 9000.0;
  if (seed % 8 == 2) problem.open_tasks.erase(problem.open_tasks.begin());
  if (seed % 8 == 6) {  // any start angle, on few of them
    problem.sites[0].survey.start_angle_rad.reset();
    problem.free_starts = 3;
  }
  return problem;
}

/// From the worst plan of all, so that routes and nothing else find the best.
TEST(Routes, EqualExhaustiveSearchFromTheWorstPlan) {
  int solved = 0;
  for (std::uint64_t seed = 0; seed < 32; ++seed) {
    SCOPED_TRACE(seed);
    const auto model = Model::make(problem_of(seed));
    ASSERT_TRUE(model.ok());
    const Exhaustive all{*model};
    if (all.best() == kInfinity) continue;
    Orders orders = all.worst();
    double cost = all.worst_cost();
    Routes routes{*model};
    EXPECT_EQ(routes.improve(orders, cost, kAll, {}), Routes::Outcome::done);
    EXPECT_NEAR(cost, all.best(), 1e-8 * all.best());
    EXPECT_DOUBLE_EQ(Timing{*model}.evaluate(orders), cost);
    double again = cost;
    EXPECT_EQ(routes.improve(orders, again, kAll, {}), Routes::Outcome::done);
    EXPECT_EQ(again, cost);
    ++solved;
  }
  EXPECT_GT(solved, 25);
}

/// Large enough for prices and windows to matter. The tree proves them before it asks for routes.
TEST(Routes, EqualTheTreeOnThreeSites) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    Random random{900 + seed};
    CoupledDraw draw;
    draw.vehicles = 4 + seed % 3;
    CoupledProblem problem = draw_makespan(random, draw);
    const auto exact = branch_and_bound(problem, {});
    ASSERT_TRUE(exact.ok() && exact->proven);
    ASSERT_LT(exact->steps, 500U);
    const auto model = Model::make(problem);
    ASSERT_TRUE(model.ok());
    auto orders = greedy_orders(*model);
    ASSERT_TRUE(orders.has_value());
    double cost = Timing{*model}.evaluate(*orders);
    Routes routes{*model};
    EXPECT_EQ(routes.improve(*orders, cost, kAll, {}), Routes::Outcome::done);
    EXPECT_NEAR(cost, exact->objective, 1e-8 * cost);
  }
}

TEST(Routes, SayWhenTheyWereCutOff) {
  Random random{901};
  CoupledProblem problem = draw_problem(random, {.sites = 5, .vehicles = 6});
  problem.criterion = Criterion::makespan;
  const auto model = Model::make(problem);
  ASSERT_TRUE(model.ok());
  auto orders = greedy_orders(*model);
  ASSERT_TRUE(orders.has_value());
  const double greedy = Timing{*model}.evaluate(*orders);
  Routes routes{*model};
  double cost = greedy;
  EXPECT_EQ(routes.improve(*orders, cost, {10, 1000}, {}), Routes::Outcome::too_many);
  EXPECT_EQ(routes.improve(*orders, cost, {1'000'000, 0}, {}), Routes::Outcome::cut_off);
  EXPECT_EQ(cost, greedy);
  const PlanningBudget none{.expired = [] { return true; }};
  EXPECT_NE(routes.improve(*orders, cost, kAll, none), Routes::Outcome::done);
  EXPECT_EQ(routes.improve(*orders, cost, kAll, {}), Routes::Outcome::done);
  EXPECT_LT(cost, greedy);
}

/// Six sites, six vehicles: more than the tree proves in so many nodes.
TEST(Routes, ProveWhatTheTreeAloneWouldNot) {
  for (std::uint64_t seed = 100; seed < 106; ++seed) {
    Random draws{seed};
    CoupledProblem problem = draw_makespan(draws, {.sites = 6, .vehicles = 6});
    const auto exact = branch_and_bound(problem, {.steps_max = 2000, .expired = {}});
    Random random{1};
    const auto found = ruin_and_recreate(problem, random, {.steps_max = 800, .expired = {}});
    ASSERT_TRUE(exact.ok() && found.ok());
    EXPECT_TRUE(exact->proven) << seed;
    EXPECT_TRUE(found->proven) << seed;
    EXPECT_NEAR(found->objective, exact->objective, 1e-8 * exact->objective) << seed;
  }
}

}  // namespace
}  // namespace skein::planning::coupled
