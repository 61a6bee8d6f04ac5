// SPDX-License-Identifier: Apache-2.0
#include "skein/coupled/coupled.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "instances.hpp"
#include "judge.hpp"
#include "skein/planning/dubins.hpp"
#include "skein/planning/task_path.hpp"

namespace skein::planning {
namespace {

using std::chrono::seconds;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::array kCriteria{Criterion::value, Criterion::completion, Criterion::makespan};

/// Is `a` better than `b` by more than rounding?
bool better(const CoupledProblem& problem, double a, double b) {
  const double slack = 1e-8 * std::abs(b);
  return problem.criterion == Criterion::value ? a > b + slack : a < b - slack;
}

/// Every permutation of the tasks, cut into one piece a vehicle in every way, timed by
/// repetition.
class Exhaustive {
 public:
  explicit Exhaustive(const CoupledProblem& problem) : problem_{problem} {}

  [[nodiscard]] std::optional<double> best() {
    std::vector<TaskId> order = problem_.open_tasks;
    std::sort(order.begin(), order.end());
    do {
      cut(order, 0, 0);
    } while (std::next_permutation(order.begin(), order.end()));
    return best_;
  }

 private:
  struct Step {
    TaskId task;
    std::size_t vehicle = 0;
  };

  void cut(const std::vector<TaskId>& order, std::size_t first, std::size_t vehicle) {
    if (vehicle == problem_.vehicles.size()) {
      if (first == order.size()) time();
      return;
    }
    const std::size_t before = steps_.size();
    int loads = problem_.vehicles[vehicle].loads;
    cut(order, first, vehicle + 1);
    for (std::size_t i = first; i < order.size(); ++i) {
      if (!problem_.vehicles[vehicle].capabilities.has(order[i].kind)) break;
      if (order[i].kind == TaskKind::deliver && loads-- == 0) break;
      steps_.push_back({order[i], vehicle});
      cut(order, i + 1, vehicle + 1);
    }
    steps_.resize(before);
  }

  [[nodiscard]] TaskPath path_of(const Step& step) const {
    const CoupledVehicle& v = problem_.vehicles[step.vehicle];
    const Site& site = *site_of(problem_, step.task.site);
    switch (step.task.kind) {
      case TaskKind::deliver:
        return delivery_path(site, site.deliveries[step.task.index], v.final_approach_m);
      case TaskKind::survey:
        return arc_path(site, *site.survey.start_angle_rad, site.survey.dwell, v.sensor_radius_m,
                        v.speed_mps, 1);
      default:
        break;
    }
    const ArcRequirement& arc = site.assessments[step.task.index];
    return arc_path(site, *arc.start_angle_rad, arc.dwell, v.assess_radius_m, v.speed_mps, 1);
  }

  void time() {
    std::vector<double> time_s(steps_.size(), 0.0);
    std::vector<double> end_s(steps_.size(), 0.0);
    std::vector<double> reach_s(steps_.size());
    std::vector<double> after_s(steps_.size());
    std::vector<double> free_s(steps_.size(), 0.0);
    std::vector<std::optional<Gap>> gaps(steps_.size());
    CoupledPlan plan;
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      const CoupledVehicle& v = problem_.vehicles[steps_[k].vehicle];
      const TaskPath path = path_of(steps_[k]);
      Pose2 from = v.pose;
      if (k > 0 && steps_[k - 1].vehicle == steps_[k].vehicle) {
        const TaskPath last = path_of(steps_[k - 1]);
        from = advance(last.entry, last.run.curvature_per_m, last.run.length_m);
      }
      const bool deliver = steps_[k].task.kind == TaskKind::deliver;
      const double run_s = path.run.length_m / v.speed_mps;
      reach_s[k] = shortest_dubins_length(from, path.entry, v.planning_radius_m) / v.speed_mps +
                   (deliver ? run_s : 0.0);
      after_s[k] = deliver ? 0.0 : run_s;
      const auto gap = length_gap(from, path.entry, v.planning_radius_m);
      if (!gap || !problem_.flyable_waits) continue;
      const double before_s = deliver ? run_s : 0.0;
      gaps[k] = Gap{gap->low_m / v.speed_mps + before_s, gap->high_m / v.speed_mps + before_s};
    }
    // From the last pass to the next until nothing changes: orders that wait for each other in a
    // circle never settle.
    for (std::size_t pass = 0; pass <= steps_.size() + 1; ++pass) {
      std::vector<double> now_s(steps_.size(), 0.0);
      for (std::size_t k = 0; k < steps_.size(); ++k) {
        free_s[k] = is_first(k) ? 0.0 : end_s[k - 1];
        now_s[k] = free_s[k] + reach_s[k];
        for (std::size_t j = 0; j < steps_.size(); ++j) {
          now_s[k] = std::max(now_s[k], after(j, k, time_s[j], end_s[j]));
        }
        if (steps_[k].task.kind != TaskKind::deliver)
          now_s[k] = out_of(gaps[k], free_s[k], now_s[k]);
      }
      make_common(now_s, free_s, gaps);
      const bool settled = now_s == time_s;
      time_s = now_s;
      for (std::size_t k = 0; k < steps_.size(); ++k) end_s[k] = time_s[k] + after_s[k];
      if (settled) {
        keep(plan, time_s, end_s);
        return;
      }
    }
  }

  [[nodiscard]] bool is_first(std::size_t k) const {
    return k == 0 || steps_[k - 1].vehicle != steps_[k].vehicle;
  }

  struct Gap {
    double low_s = 0.0;
    double high_s = 0.0;
  };

  static double out_of(const std::optional<Gap>& gap, double free_s, double time_s) {
    const bool inside = gap && time_s > free_s + gap->low_s && time_s < free_s + gap->high_s;
    return inside ? free_s + gap->high_s : time_s;
  }

  /// The deliveries of a site, at the first common moment at which all can be there.
  void make_common(std::vector<double>& time_s, const std::vector<double>& free_s,
                   const std::vector<std::optional<Gap>>& gaps) const {
    for (const Site& site : problem_.sites) {
      double common_s = 0.0;
      for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t k = 0; k < steps_.size(); ++k) {
          if (steps_[k].task.site != site.id || steps_[k].task.kind != TaskKind::deliver) continue;
          const double offset_s = to_seconds(site.deliveries[steps_[k].task.index].offset);
          const double wanted_s = std::max(time_s[k], common_s + offset_s);
          const double flown_s = out_of(gaps[k], free_s[k], wanted_s);
          changed = changed || flown_s > common_s + offset_s + 1e-12;
          common_s = std::max(common_s, flown_s - offset_s);
        }
      }
      for (std::size_t k = 0; k < steps_.size(); ++k) {
        if (steps_[k].task.site != site.id || steps_[k].task.kind != TaskKind::deliver) continue;
        time_s[k] = common_s + to_seconds(site.deliveries[steps_[k].task.index].offset);
      }
    }
  }

  /// The earliest time of step k as step j demands it.
  [[nodiscard]] double after(std::size_t j, std::size_t k, double time_s, double end_s) const {
    const TaskId& a = steps_[j].task;
    const TaskId& b = steps_[k].task;
    if (a.site != b.site) return 0.0;
    const Site& site = *site_of(problem_, a.site);
    if (a.kind == TaskKind::survey && b.kind == TaskKind::deliver) {
      return end_s + to_seconds(problem_.decide_wait);
    }
    if (a.kind == TaskKind::survey && b.kind == TaskKind::assess) return end_s;
    if (a.kind == TaskKind::deliver && b.kind == TaskKind::assess) {
      return time_s + to_seconds(site.assess_wait);
    }
    return 0.0;
  }

  void keep(CoupledPlan& plan, const std::vector<double>& time_s,
            const std::vector<double>& end_s) {
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      const CoupledVehicle& v = problem_.vehicles[steps_[k].vehicle];
      if (end_s[k] * v.speed_mps > v.range_left_m) return;
      plan.tasks.push_back({steps_[k].task, v.id, time_s[k], end_s[k], {}, {}, 0.0, 0.0});
    }
    const double objective = objective_of(problem_, plan);
    const bool first = !best_.has_value();
    if (first ||
        (problem_.criterion == Criterion::value ? objective > *best_ : objective < *best_)) {
      best_ = objective;
    }
  }

  const CoupledProblem& problem_;
  std::vector<Step> steps_;
  std::optional<double> best_;
};

void expect_optimal(const CoupledProblem& problem) {
  const auto best = Exhaustive{problem}.best();
  const auto plan = branch_and_bound(problem, {});
  ASSERT_EQ(best.has_value(), plan.ok());
  if (!best) return;
  EXPECT_THAT(faults_of(problem, *plan), IsEmpty());
  EXPECT_TRUE(plan->proven);
  EXPECT_NEAR(plan->objective, *best, 1e-7 * std::abs(*best));
  EXPECT_EQ(plan->gap(), 0.0);
}

TEST(BranchAndBound, EqualsExhaustiveSearchOnTwoSites) {
  for (const Criterion criterion : kCriteria) {
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
      SCOPED_TRACE(testing::Message() << static_cast<int>(criterion) << " seed " << seed);
      Random random{seed};
      CoupledDraw draw;
      draw.sites = 2;
      draw.vehicles = 2 + seed % 2;
      draw.side_m = seed % 4 < 2 ? 6000.0 : 2500.0;
      CoupledProblem problem = draw_problem(random, draw);
      problem.criterion = criterion;
      problem.decide_wait = seconds{seed % 3 == 0 ? 8 : 0};
      problem.flyable_waits = seed % 2 == 0;
      // A load short, so that who delivers matters; a range short, so that orders are refused.
      problem.vehicles[0].loads = static_cast<std::uint8_t>(1 + seed % 2);
      if (seed % 4 == 3) problem.vehicles[0].range_left_m = 9000.0;
      expect_optimal(problem);
    }
  }
}

TEST(BranchAndBound, EqualsExhaustiveSearchWithDeliveriesTogether) {
  for (const double interval_s : {0.0, 5.0}) {
    for (std::uint64_t seed = 20; seed < 23; ++seed) {
      SCOPED_TRACE(testing::Message() << interval_s << " s, seed " << seed);
      Random random{seed};
      CoupledDraw draw;
      draw.sites = 2;
      draw.vehicles = 3;
      draw.deliveries = 2;
      draw.assessments = 1;
      draw.interval_s = interval_s;
      CoupledProblem problem = draw_problem(random, draw);
      problem.criterion = kCriteria[seed % 3];
      problem.open_tasks.erase(problem.open_tasks.begin());  // site 1 was surveyed before
      expect_optimal(problem);
    }
  }
}

TEST(BranchAndBound, EqualsExhaustiveSearchWhereLongAssessmentsAreFlownAtOnce) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random{seed};
    CoupledProblem problem =
        draw_makespan(random, {.sites = 2, .vehicles = 4, .assessments = 2, .side_m = 12000.0});
    std::erase_if(problem.open_tasks,
                  [](const TaskId& task) { return task.kind == TaskKind::survey; });
    for (Site& site : problem.sites) {
      for (ArcRequirement& arc : site.assessments) arc.dwell = seconds{200};
    }
    expect_optimal(problem);
  }
}

TEST(BranchAndBound, TwinsAreInterchangeable) {
  Random random{5};
  CoupledDraw draw;
  draw.sites = 2;
  draw.vehicles = 1;
  CoupledProblem problem = draw_problem(random, draw);
  problem.flyable_waits = false;
  for (std::uint16_t id = 2; id <= 3; ++id) {
    problem.vehicles.push_back(problem.vehicles.front());
    problem.vehicles.back().id = VehicleId{id};
  }
  for (const Criterion criterion : kCriteria) {
    problem.criterion = criterion;
    expect_optimal(problem);
  }
}

TEST(BranchAndBound, MoreStepsAreNeverWorseAndTheBoundHolds) {
  for (const Criterion criterion : kCriteria) {
    SCOPED_TRACE(static_cast<int>(criterion));
    Random random{31};
    CoupledProblem problem = draw_problem(random, {.sites = 5, .vehicles = 6});
    problem.criterion = criterion;
    problem.flyable_waits = false;
    const auto proven = branch_and_bound(problem, {});
    ASSERT_TRUE(proven.ok() && proven->proven);
    std::optional<CoupledPlan> before;
    for (std::uint64_t steps = 1; steps < proven->steps; steps *= 4) {
      PlanningBudget budget;
      budget.steps_max = steps;
      const auto plan = branch_and_bound(problem, budget);
      ASSERT_TRUE(plan.ok() && plan->bound.has_value());
      EXPECT_FALSE(better(problem, plan->objective, proven->objective));
      EXPECT_FALSE(better(problem, proven->objective, *plan->bound));
      if (before) {
        EXPECT_FALSE(better(problem, before->objective, plan->objective));
        EXPECT_FALSE(better(problem, *plan->bound, *before->bound));
      }
      before = *plan;
    }
    ASSERT_TRUE(before.has_value());  // or it was proven at once, and nothing is shown
  }
}

TEST(CoupledPlans, AreSoundForEveryMethod) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    for (const Criterion criterion : kCriteria) {
      SCOPED_TRACE(testing::Message() << static_cast<int>(criterion) << " seed " << seed);
      Random random{seed};
      CoupledDraw draw;
      draw.vehicles = 6;
      draw.deliveries = 1 + seed % 3;
      draw.assessments = 1 + seed % 2;
      draw.interval_s = seed % 2 == 0 ? 0.0 : 5.0;
      CoupledProblem problem = draw_problem(random, draw);
      problem.criterion = criterion;
      problem.decide_wait = seconds{5};
      if (const auto plan = greedy_awards(problem)) {
        EXPECT_THAT(faults_of(problem, *plan), IsEmpty());
      }
      PlanningBudget budget;
      budget.steps_max = 2000;
      const auto exact = branch_and_bound(problem, budget);
      ASSERT_TRUE(exact.ok()) << exact.error().message;
      EXPECT_THAT(faults_of(problem, *exact), IsEmpty());
      ASSERT_TRUE(exact->bound.has_value());
      EXPECT_FALSE(better(problem, exact->objective, *exact->bound));
      Random generator{3};
      budget.steps_max = 100;
      const auto found = ruin_and_recreate(problem, generator, budget);
      ASSERT_TRUE(found.ok()) << found.error().message;
      EXPECT_THAT(faults_of(problem, *found), IsEmpty());
    }
  }
}

TEST(RuinAndRecreate, MoreStepsAreNeverWorseAndASeedIsAPlan) {
  for (const Criterion criterion : kCriteria) {
    Random draw{11};
    CoupledProblem problem = draw_problem(draw, {.sites = 4, .vehicles = 6});
    problem.criterion = criterion;
    problem.flyable_waits = false;
    const auto proven = branch_and_bound(problem, {});
    ASSERT_TRUE(proven.ok() && proven->proven);
    std::optional<double> before;
    for (const std::uint64_t steps : {0U, 10U, 100U, 400U}) {
      Random one{2};
      Random same{2};
      PlanningBudget budget;
      budget.steps_max = steps;
      const auto plan = ruin_and_recreate(problem, one, budget);
      const auto again = ruin_and_recreate(problem, same, budget);
      ASSERT_TRUE(plan.ok() && again.ok());
      EXPECT_EQ(plan->objective, again->objective);
      EXPECT_FALSE(better(problem, plan->objective, proven->objective));
      if (before) {
        EXPECT_FALSE(better(problem, *before, plan->objective));
      }
      before = plan->objective;
    }
    EXPECT_NEAR(*before, proven->objective, 0.02 * proven->objective);
  }
}

/// Of twelve tasks the search leaves nothing to chance: it ends with the best plan, and says so.
TEST(RuinAndRecreate, ASmallMakespanIsProven) {
  for (std::uint64_t seed = 40; seed < 52; ++seed) {
    Random draws{seed};
    CoupledProblem problem = draw_makespan(draws, {.sites = 4, .vehicles = 6});
    const auto best = branch_and_bound(problem, {});
    Random random{1};
    const auto plan = ruin_and_recreate(problem, random, {.steps_max = 1000, .expired = {}});
    ASSERT_TRUE(best.ok() && plan.ok());
    ASSERT_TRUE(best->proven);
    EXPECT_TRUE(plan->proven) << seed;
    EXPECT_NEAR(plan->objective, best->objective, 1e-9 * best->objective) << seed;
    EXPECT_LT(plan->steps, 1000U) << seed;
  }
}

TEST(CoupledPlans, HoldATaskUntilItsWaitCanBeFlown) {
  // A delivery and the assessment of the site by one vehicle: near poses and a wait.
  bool held = false;
  for (std::uint64_t seed = 106; seed <= 111; ++seed) {
    SCOPED_TRACE(seed);
    Random random{seed};
    CoupledProblem problem = draw_problem(random, {});
    problem.criterion = Criterion::completion;
    problem.flyable_waits = false;
    const auto ideal = branch_and_bound(problem, {});
    problem.flyable_waits = true;
    const auto plan = branch_and_bound(problem, {});
    ASSERT_TRUE(ideal.ok() && plan.ok());
    EXPECT_THAT(faults_of(problem, *plan), IsEmpty());
    EXPECT_FALSE(better(problem, plan->objective, ideal->objective));
    EXPECT_TRUE(plan->proven);
    held = held || better(problem, ideal->objective, plan->objective);
  }
  EXPECT_TRUE(held);
}

TEST(CoupledPlans, GoRoundHazards) {
  Random random{4};
  CoupledProblem problem = draw_problem(random, {.sites = 2, .vehicles = 3});
  const auto free = branch_and_bound(problem, {});
  problem.hazards = {{HazardId{1}, {4000.0, 4000.0}, 500.0},
                     {HazardId{2}, {2500.0, 5000.0}, 300.0}};
  const auto plan = branch_and_bound(problem, {});
  ASSERT_TRUE(free.ok() && plan.ok());
  EXPECT_THAT(faults_of(problem, *plan), IsEmpty());
  EXPECT_FALSE(better(problem, plan->objective, *free->bound));
}

TEST(CoupledPlans, TakeTheLengthsThatTheyAreGiven) {
  Random random{6};
  CoupledProblem problem = draw_problem(random, {.sites = 2, .vehicles = 3});
  problem.criterion = Criterion::makespan;
  const auto plain = branch_and_bound(problem, {});
  problem.transit_length_m = [](const Pose2& from, const Pose2& to, double radius_m) {
    return 1.5 * shortest_dubins_length(from, to, radius_m);
  };
  const auto longer = branch_and_bound(problem, {});
  ASSERT_TRUE(plain.ok() && longer.ok());
  EXPECT_TRUE(longer->proven);
  EXPECT_GT(longer->objective, *plain->bound);
  EXPECT_LE(longer->objective, 1.5 * *plain->bound);
}

TEST(CoupledPlans, SayWhatIsMissing) {
  Random random{1};
  CoupledProblem problem = draw_problem(random, {});
  problem.vehicles.resize(2);
  problem.vehicles[0].loads = 0;
  problem.vehicles[1].loads = 0;
  const auto plan = branch_and_bound(problem, {});
  ASSERT_FALSE(plan.ok());
  EXPECT_THAT(plan.error().message, HasSubstr("site 1 deliver 1"));
  problem.vehicles.resize(1);
  problem.vehicles[0].loads = 2;
  EXPECT_THAT(branch_and_bound(problem, {}).error().message, HasSubstr("It is proven"));
  PlanningBudget none;
  none.steps_max = 0;
  EXPECT_THAT(branch_and_bound(problem, none).error().message,
              HasSubstr("within the planning budget"));
  problem.open_tasks.push_back({SiteId{9}, TaskKind::survey, 0});
  EXPECT_THAT(greedy_awards(problem).error().message, HasSubstr("site 9"));
}

}  // namespace
}  // namespace skein::planning
