// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "instances.hpp"
#include "judge.hpp"

/// Sites that may be left out, services without a run, ways home, and more than
/// 64 tasks.
namespace skein::planning {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Services at points, by vehicles that turn on the spot and come home: team
/// orienteering.
CoupledProblem orienteering(Random& random, std::size_t places, std::size_t vehicles,
                            double range_m) {
  CoupledProblem problem;
  const double side_m = 100.0;
  for (std::size_t i = 0; i < vehicles; ++i) {
    CoupledVehicle v;
    v.id = VehicleId{static_cast<std::uint16_t>(i + 1)};
    v.speed_mps = 1.0;
    v.range_left_m = range_m;
    v.capabilities.add(TaskKind::survey);
    v.home = Vec2{side_m, side_m};
    problem.vehicles.push_back(v);
  }
  for (std::size_t j = 0; j < places; ++j) {
    Site site;
    site.id = SiteId{static_cast<std::uint16_t>(j + 1)};
    site.position = {random.uniform(0.0, side_m), random.uniform(0.0, side_m)};
    site.survey.dwell = std::chrono::seconds{static_cast<int>(random.index(10))};
    site.reward = 1.0 + static_cast<double>(random.index(20));
    problem.open_tasks.push_back({site.id, TaskKind::survey, 0});
    problem.optional_sites.push_back(site.id);
    problem.service_sites.push_back(site.id);
    problem.sites.push_back(site);
  }
  problem.weights = {1.0, 0.0};
  return problem;
}

/// Every way of giving places to vehicles in every order: the most of J, by
/// nothing but distances.
class EveryPlan {
 public:
  explicit EveryPlan(const CoupledProblem& problem)
      : problem_{problem}, used_(problem.sites.size(), false) {
    for (const Site& site : problem.sites) rewards_ += site.reward;
    go(0, problem.vehicles.front().pose.position(), 0.0, 0.0);
  }
  [[nodiscard]] double best() const { return best_; }

 private:
  void go(std::size_t vehicle, const Vec2& at, double free_s, double value) {
    best_ = std::max(best_, value / rewards_);
    const CoupledVehicle& v = problem_.vehicles[vehicle];
    for (std::size_t s = 0; s < used_.size(); ++s) {
      const Site& site = problem_.sites[s];
      const double end_s =
          free_s + (site.position - at).norm() / v.speed_mps + to_seconds(site.survey.dwell);
      const double home_s = (*v.home - site.position).norm() / v.speed_mps;
      if (used_[s] || (end_s + home_s) * v.speed_mps > v.range_left_m) continue;
      used_[s] = true;
      go(vehicle, site.position, end_s,
         value + site.reward * std::exp(-site.reward_decay_per_s * end_s));
      used_[s] = false;
    }
    if (vehicle + 1 < problem_.vehicles.size()) {
      go(vehicle + 1, problem_.vehicles[vehicle + 1].pose.position(), 0.0, value);
    }
  }

  const CoupledProblem& problem_;
  std::vector<bool> used_;
  double rewards_ = 0.0;
  double best_ = 0.0;
};

TEST(CoupledOptional, TheBestTeamIsThatOfEveryPlan) {
  int left_out = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random{seed};
    CoupledProblem problem =
        orienteering(random, 7, 1 + seed % 2, 180.0 + 2.0 * static_cast<double>(seed));
    if (seed % 3 == 0) {
      for (Site& site : problem.sites) site.reward_decay_per_s = 0.01;
    }
    const auto plan = branch_and_bound(problem, {});
    ASSERT_TRUE(plan.ok()) << seed << plan.error().message;
    EXPECT_TRUE(plan->proven) << seed;
    EXPECT_THAT(faults_of(problem, *plan), IsEmpty()) << seed;
    EXPECT_NEAR(plan->objective, EveryPlan{problem}.best(), 1e-9) << seed;
    left_out += plan->left_out.empty() ? 0 : 1;
  }
  EXPECT_GT(left_out, 20) << "or nothing was tried";
}

TEST(CoupledOptional, TheSearchIsSoundAndRarelyBehind) {
  double lost = 0.0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random{seed};
    const CoupledProblem problem = orienteering(random, 8, 2, 200.0);
    const auto best = branch_and_bound(problem, {});
    Random search{seed};
    const auto plan = ruin_and_recreate(problem, search, {200, {}});
    ASSERT_TRUE(best.ok() && plan.ok());
    EXPECT_THAT(faults_of(problem, *plan), IsEmpty()) << seed;
    EXPECT_LE(plan->objective, best->objective + 1e-12);
    lost += best->objective - plan->objective;
  }
  EXPECT_LT(lost / 20.0, 0.01);
}

/// Every choice of the sites that are left out, each solved as a problem of
/// what remains.
double best_of_choices(const CoupledProblem& problem) {
  double all = 0.0;
  for (const TaskId& task : problem.open_tasks) all += site_of(problem, task.site)->reward;
  double best = 0.0;
  const std::size_t sites = problem.sites.size();
  for (std::size_t choice = 1; choice < (std::size_t{1} << sites); ++choice) {
    CoupledProblem part = problem;
    part.optional_sites.clear();
    part.open_tasks.clear();
    double rewards = 0.0;
    for (const TaskId& task : problem.open_tasks) {
      if ((choice >> (task.site.value - 1U) & 1U) == 0) continue;
      part.open_tasks.push_back(task);
      rewards += site_of(problem, task.site)->reward;
    }
    part.weights.reward = problem.weights.reward * rewards / all;
    if (const auto plan = branch_and_bound(part, {})) best = std::max(best, plan->objective);
  }
  return best;
}

TEST(CoupledOptional, ASiteIsDoneWholeOrLeftOut) {
  int left_out = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    Random random{70 + seed};
    CoupledDraw draw;
    draw.vehicles = 3;
    draw.deliveries = 1 + seed % 2;
    CoupledProblem problem = draw_problem(random, draw);
    for (CoupledVehicle& v : problem.vehicles) v.range_left_m = 15000.0;
    for (Site& site : problem.sites) {
      problem.optional_sites.push_back(site.id);
      site.reward = 1.0 + static_cast<double>(random.index(5));
    }
    const auto plan = branch_and_bound(problem, {});
    ASSERT_TRUE(plan.ok()) << seed;
    EXPECT_TRUE(plan->proven);
    EXPECT_THAT(faults_of(problem, *plan), IsEmpty()) << seed;
    EXPECT_NEAR(plan->objective, std::max(best_of_choices(problem), problem.weights.range), 1e-9)
        << seed;
    left_out += plan->left_out.empty() ? 0 : 1;
  }
  EXPECT_GT(left_out, 3);
}

TEST(CoupledOptional, NobodyTakesMoreThanItsShare) {
  int dearer = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Random random{90 + seed};
    CoupledProblem problem = draw_problem(random, {.sites = 2, .vehicles = 4});
    problem.criterion = Criterion::completion;
    double before_s = 0.0;
    for (const TaskShare share : {TaskShare::any, TaskShare::one_a_site, TaskShare::one}) {
      problem.share = share;
      const auto plan = branch_and_bound(problem, {});
      ASSERT_TRUE(plan.ok()) << seed;
      EXPECT_TRUE(plan->proven);
      EXPECT_THAT(faults_of(problem, *plan), IsEmpty()) << seed;
      EXPECT_GE(plan->objective, before_s - 1e-9);
      dearer += before_s > 0.0 && plan->objective > before_s + 1e-6 ? 1 : 0;
      before_s = plan->objective;
      Random search{seed};
      EXPECT_THAT(faults_of(problem, *ruin_and_recreate(problem, search, {100, {}})), IsEmpty());
      if (const auto greedy = greedy_awards(problem)) {
        EXPECT_THAT(faults_of(problem, *greedy), IsEmpty());
      }
    }
  }
  EXPECT_GT(dearer, 3) << "or it bars nothing";
}

TEST(CoupledOptional, AServiceIsFlownToOnAnyHeading) {
  Random random{5};
  CoupledProblem problem = draw_problem(random, {.sites = 3, .vehicles = 3});
  problem.open_tasks.clear();
  for (const Site& site : problem.sites) {
    problem.open_tasks.push_back({site.id, TaskKind::survey, 0});
    problem.service_sites.push_back(site.id);
  }
  const auto plan = branch_and_bound(problem, {});
  ASSERT_TRUE(plan.ok() && plan->proven);
  EXPECT_THAT(faults_of(problem, *plan), IsEmpty());
  problem.free_starts = 32;
  const auto finer = branch_and_bound(problem, {});
  EXPECT_GE(finer->objective, plan->objective - 1e-12) << "among more headings";
}

TEST(CoupledOptional, WhatCannotComeHomeIsLeftOut) {
  Random random{6};
  CoupledProblem problem = orienteering(random, 6, 1, 1000.0);
  EXPECT_THAT(branch_and_bound(problem, {})->left_out, IsEmpty());
  problem.vehicles.front().home = Vec2{900.0, 0.0};
  const auto plan = branch_and_bound(problem, {});
  EXPECT_FALSE(plan->left_out.empty());
  EXPECT_THAT(faults_of(problem, *plan), IsEmpty());
}

TEST(CoupledOptional, SaysWhatIsWrong) {
  Random random{7};
  CoupledProblem problem = orienteering(random, 3, 1, 100.0);
  problem.criterion = Criterion::makespan;
  EXPECT_THAT(branch_and_bound(problem, {}).error().message, HasSubstr("criterion is value"));
  problem = orienteering(random, 3, 1, 100.0);
  problem.optional_sites.push_back(SiteId{99});
  EXPECT_THAT(branch_and_bound(problem, {}).error().message, HasSubstr("Site 99"));
  problem = orienteering(random, 3, 1, 100.0);
  problem.hazards.push_back({HazardId{1}, {1.0, 1.0}, 1.0});
  EXPECT_THAT(branch_and_bound(problem, {}).error().message, HasSubstr("turns on the spot"));
}

TEST(CoupledLarge, MoreTasksThan64ArePlannedAnd129AreRefused) {
  Random random{8};
  CoupledDraw draw;
  draw.sites = 25;
  draw.vehicles = 12;
  draw.deliveries = 2;
  draw.assessments = 2;
  CoupledProblem problem = draw_problem(random, draw);
  for (CoupledVehicle& v : problem.vehicles) {
    v.range_left_m = 400000.0;
    v.loads = v.loads > 0 ? 20 : 0;
  }
  ASSERT_EQ(problem.open_tasks.size(), 125U);
  for (const Criterion criterion : {Criterion::makespan, Criterion::value}) {
    problem.criterion = criterion;
    const auto plan = branch_and_bound(problem, {20, {}});
    ASSERT_TRUE(plan.ok()) << plan.error().message;
    EXPECT_THAT(faults_of(problem, *plan), IsEmpty());
    ASSERT_TRUE(plan->bound);
    if (criterion == Criterion::makespan) {
      EXPECT_LE(*plan->bound, plan->objective);
    } else {
      EXPECT_GE(*plan->bound, plan->objective);
    }
  }
  draw.sites = 26;
  EXPECT_THAT(branch_and_bound(draw_problem(random, draw), {20, {}}).error().message,
              HasSubstr("128"));
}

}  // namespace
}  // namespace skein::planning
