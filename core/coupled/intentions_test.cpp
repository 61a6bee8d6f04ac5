// SPDX-License-Identifier: Apache-2.0
#include "skein/coupled/intentions.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "instances.hpp"
#include "judge.hpp"

namespace skein::planning {
namespace {

using ::testing::IsEmpty;

CoupledProblem mission(std::uint64_t seed) {
  Random random{seed};
  CoupledProblem problem =
      draw_makespan(random, {.sites = 2, .vehicles = 9, .deliveries = 2, .assessments = 1});
  problem.share = TaskShare::one_a_site;
  problem.decide_wait = std::chrono::seconds{10};
  return problem;
}

double ways_m(const CoupledPlan& plan) {
  double sum_m = 0.0;
  for (const CoupledTask& task : plan.tasks) sum_m += task.least_transit_m;
  return sum_m;
}

TEST(Intentions, TiesAreSettledByShorterWaysAndNothingElseChanges) {
  int shorter = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const CoupledProblem problem = mission(seed);
    auto plan = branch_and_bound(problem, {200, {}});
    ASSERT_TRUE(plan.ok()) << seed;
    const double before_m = ways_m(*plan);
    settle_ties(problem, *plan);
    EXPECT_THAT(faults_of(problem, *plan), IsEmpty()) << seed;
    EXPECT_LE(ways_m(*plan), before_m + 1e-6) << seed;
    shorter += ways_m(*plan) < before_m - 1.0 ? 1 : 0;
  }
  EXPECT_GT(shorter, 5) << "or there were no ties";
}

TEST(Intentions, SurveyorsFindTheirSitesAndTheOthersWaitBeforeTheirTasks) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    CoupledProblem problem = mission(seed);
    const SiteId hardest{static_cast<std::uint16_t>(1 + seed % 2)};
    std::erase(problem.open_tasks,
               TaskId{SiteId{static_cast<std::uint16_t>(2 - seed % 2)}, TaskKind::assess, 0});
    const auto plan = branch_and_bound(problem, {200, {}});
    ASSERT_TRUE(plan.ok());
    const auto intentions = intentions_of(problem, *plan);
    ASSERT_EQ(intentions.size(), problem.vehicles.size());
    for (std::size_t i = 0; i < intentions.size(); ++i) {
      const CoupledVehicle& vehicle = problem.vehicles[i];
      EXPECT_EQ(intentions[i].vehicle, vehicle.id);
      std::size_t surveys = 0;
      const CoupledTask* first = nullptr;
      for (const CoupledTask& task : plan->tasks) {
        if (task.vehicle != vehicle.id) continue;
        if (first == nullptr) first = &task;
        if (task.task.kind != TaskKind::survey) continue;
        const Vec2 off = intentions[i].way.at(surveys) - site_of(problem, task.task.site)->position;
        EXPECT_LT(off.norm(), vehicle.sensor_radius_m) << "it finds the site there";
        ++surveys;
      }
      if (first == nullptr) {
        EXPECT_TRUE(intentions[i].way.empty());
      } else if (surveys == 0) {
        ASSERT_EQ(intentions[i].way.size() > 8U, first->task.site != hardest)
            << "laps, then where it may be needed";
        const Vec2 to_entry = first->entry.position() - intentions[i].way.front();
        EXPECT_GT(to_entry.dot(unit_vector(first->entry.heading_rad)), 0.0) << "it is before it";
      } else {
        EXPECT_EQ(intentions[i].way.size(), surveys);
      }
    }
  }
}

TEST(Intentions, NobodyWaitsInAHazard) {
  CoupledProblem problem = mission(3);
  const auto plan = branch_and_bound(problem, {200, {}});
  ASSERT_TRUE(plan.ok());
  const auto open = intentions_of(problem, *plan);
  const auto waits = std::ranges::find_if(plan->tasks, [&](const CoupledTask& task) {
    const auto& own = *std::ranges::find(open, task.vehicle, &Intention::vehicle);
    return task.task.kind == TaskKind::deliver && own.way.size() == 1 &&
           (own.way.front() - task.entry.position()).norm() > 1.0;
  });
  ASSERT_NE(waits, plan->tasks.end());
  const auto place = [&](const std::vector<Intention>& all) {
    return std::ranges::find(all, waits->vehicle, &Intention::vehicle)->way.front();
  };
  problem.hazards.push_back({HazardId{1}, place(open), 30.0});
  EXPECT_GT((place(intentions_of(problem, *plan)) - place(open)).norm(), 30.0);
}

}  // namespace
}  // namespace skein::planning
