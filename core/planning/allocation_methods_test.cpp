// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"
#include "skein/planning/allocation.hpp"
#include "skein/planning/arrival.hpp"
#include "skein/planning/task_path.hpp"

namespace skein::planning {
namespace {

using ::testing::HasSubstr;

using std::chrono::seconds;

constexpr std::array kMethods{AllocationMethod::best,       AllocationMethod::exact,
                              AllocationMethod::earliest,   AllocationMethod::colony,
                              AllocationMethod::polynomial, AllocationMethod::greedy};

struct Shape {
  std::size_t deliveries = 2;
  std::size_t assessments = 1;
  std::size_t vehicles = 5;
  std::size_t hazards = 0;
  seconds interval{0};
  bool free_angles = false;
  double extent_m = 5000.0;
};

AllocationProblem random_problem(Random& random, const Shape& shape) {
  AllocationProblem problem;
  Site& site = problem.site;
  site.id = SiteId{3};
  site.position = {shape.extent_m / 2.0, shape.extent_m / 2.0};
  site.reward = 10.0;
  site.reward_decay_per_s = 0.005;
  site.assess_wait = seconds{random.index(20)};
  for (std::size_t i = 0; i < shape.deliveries; ++i) {
    site.deliveries.push_back({random.uniform(-kPi, kPi), shape.interval * i});
  }
  for (std::size_t i = 0; i < shape.assessments; ++i) {
    site.assessments.push_back({std::nullopt, seconds{20}});
    if (!shape.free_angles) site.assessments.back().start_angle_rad = random.uniform(-kPi, kPi);
  }
  problem.open_tasks = tasks_after_survey(site);
  problem.start = at_seconds(40.0);
  problem.seed = random.next();
  for (std::size_t i = 0; i < shape.vehicles; ++i) {
    Candidate c;
    c.id = VehicleId{static_cast<std::uint16_t>(i + 1)};
    c.pose = {random.uniform(0.0, shape.extent_m), random.uniform(0.0, shape.extent_m),
              random.uniform(-kPi, kPi)};
    c.speed_mps = 45.0 + 5.0 * static_cast<double>(random.index(4));
    c.planning_radius_m = 165.0;
    c.range_left_m = random.chance(0.1) ? 3000.0 : 18000.0;
    c.final_approach_m = 300.0;
    c.assess_radius_m = 300.0;
    const double lot = random.uniform();
    if (lot < 0.7) c.capabilities.add(TaskKind::deliver);
    if (lot > 0.4) c.capabilities.add(TaskKind::assess);
    c.loads = 2;
    problem.candidates.push_back(c);
  }
  for (std::size_t i = 0; i < shape.hazards; ++i) {
    const Vec2 centre =
        site.position + random.uniform(600.0, 2000.0) * unit_vector(random.uniform(-kPi, kPi));
    problem.hazards.push_back(
        {HazardId{static_cast<std::uint16_t>(i + 1)}, centre, random.uniform(50.0, 200.0)});
  }
  return problem;
}

AllocationParams with(AllocationMethod method) {
  AllocationParams params;
  params.method = method;
  return params;
}

const Candidate& candidate_of(const AllocationProblem& problem, VehicleId id) {
  return *std::find_if(problem.candidates.begin(), problem.candidates.end(),
                       [id](const Candidate& c) { return c.id == id; });
}

/// J from the flown paths alone.
double flown_value(const AllocationProblem& problem, const Allocation& allocation,
                   const ValueWeights& weights) {
  double reward = 0.0;
  double flown_m = 0.0;
  double range_m = 0.0;
  double late_s = 0.0;
  Instant last = problem.deliveries_done;
  for (const auto& a : allocation.assignments) {
    if (a.task.kind == TaskKind::deliver) last = std::max(last, a.time);
  }
  for (const auto& c : problem.candidates) range_m += c.range_left_m;
  for (const auto& a : allocation.assignments) {
    const auto plan = plan_task({}, candidate_of(problem, a.vehicle), problem.start, problem.site,
                                a, problem.hazards);
    EXPECT_TRUE(plan.ok()) << plan.error().message;
    if (!plan.ok()) return NAN;
    flown_m += plan->timed.path.length_m();
    reward += std::exp(-problem.site.reward_decay_per_s *
                       to_seconds(plan->timed.end_time() - problem.start));
    if (a.task.kind == TaskKind::assess) {
      late_s += to_seconds(a.time - std::max(problem.start, last + problem.site.assess_wait));
    }
  }
  const auto tasks = static_cast<double>(allocation.assignments.size());
  return weights.reward * reward / tasks + weights.range * (range_m - flown_m) / range_m -
         weights.timing * late_s / (to_seconds(weights.timing_reference) * tasks);
}

/// What every plan promises, whoever made it.
void expect_feasible(const AllocationProblem& problem, const Allocation& allocation) {
  std::set<VehicleId> vehicles;
  std::set<TaskId> tasks;
  Instant last = problem.deliveries_done;
  for (const auto& a : allocation.assignments) {
    vehicles.insert(a.vehicle);
    tasks.insert(a.task);
    if (a.task.kind != TaskKind::deliver) continue;
    last = std::max(last, a.time);
    EXPECT_GE(a.time, problem.earliest_delivery);
    EXPECT_NEAR(
        to_seconds(a.time - problem.start),
        allocation.first_delivery_s + to_seconds(problem.site.deliveries[a.task.index].offset),
        1e-6);
  }
  EXPECT_EQ(vehicles.size(), problem.open_tasks.size());
  EXPECT_EQ(tasks, std::set<TaskId>(problem.open_tasks.begin(), problem.open_tasks.end()));
  for (const auto& a : allocation.assignments) {
    const Candidate& c = candidate_of(problem, a.vehicle);
    EXPECT_TRUE(c.capabilities.has(a.task.kind));
    if (a.task.kind == TaskKind::assess) {
      EXPECT_GE(a.time, last + problem.site.assess_wait);
    } else {
      EXPECT_GE(c.loads, 1);
    }
    const auto plan = plan_task({}, c, problem.start, problem.site, a, problem.hazards);
    ASSERT_TRUE(plan.ok()) << plan.error().message;
    EXPECT_LE(plan->timed.path.length_m(), c.range_left_m + 1e-3);
    // Who starts inside a hazard leaves it first.
    const bool outside = is_clear(Path{.start = c.pose, .segments = {}}, problem.hazards);
    EXPECT_TRUE(!outside || is_clear(plan->timed.path, problem.hazards));
  }
}

/// Every choice of vehicles at every pair of moments at which one of them becomes possible, found
/// with path_of_length's own least lengths. Small problems only.
class BruteForce {
 public:
  BruteForce(const AllocationProblem& problem, const AllocationParams& params)
      : problem_{problem}, params_{params}, tasks_{problem.open_tasks} {
    std::sort(tasks_.begin(), tasks_.end());
  }

  double best() {
    choose(0);
    return best_;
  }

 private:
  struct Leg {
    double shortest_m;
    Transit transit;
    double timed_m;
    double run_m;
  };

  std::optional<Leg> leg(const Candidate& c, const TaskId& task) const {
    if (!c.capabilities.has(task.kind)) return std::nullopt;
    std::optional<Leg> best;
    const auto consider = [&](const TaskPath& path) {
      Path run{.start = path.entry, .segments = {}};
      if (!run.append(path.run) || !is_clear(run, problem_.hazards)) return;
      const auto way =
          shortest_clear_path({}, c.pose, path.entry, c.planning_radius_m, problem_.hazards);
      if (!way || (best && way->length_m() >= best->shortest_m)) return;
      best = Leg{way->length_m(),
                 {c.pose, path.entry, c.planning_radius_m, c.range_left_m - path.run.length_m,
                  problem_.hazards},
                 task.kind == TaskKind::deliver ? path.run.length_m : 0.0,
                 path.run.length_m};
    };
    if (task.kind == TaskKind::deliver) {
      consider(
          delivery_path(problem_.site, problem_.site.deliveries[task.index], c.final_approach_m));
      return best;
    }
    const auto& arc = problem_.site.assessments[task.index];
    const auto consider_start = [&](double start_rad) {
      const double before_m = best ? best->shortest_m : INFINITY;
      consider(arc_path(problem_.site, start_rad, arc.dwell, c.assess_radius_m, c.speed_mps, 1));
      return best && best->shortest_m < before_m;
    };
    if (arc.start_angle_rad) {
      consider_start(*arc.start_angle_rad);
      return best;
    }
    // Every degree, then ever nearer to the best.
    double at_rad = 0.0;
    for (int i = 0; i < 360; ++i) {
      if (consider_start(radians(i))) at_rad = radians(i);
    }
    for (double step = radians(0.5); step > 1e-7; step *= 0.7) {
      for (const double next : {at_rad - step, at_rad + step}) {
        if (consider_start(next)) at_rad = next;
      }
    }
    return best;
  }

  const std::optional<Leg>& known_leg(std::size_t candidate, std::size_t task) {
    const auto [known, fresh] = legs_of_.try_emplace({candidate, task});
    if (fresh) known->second = leg(problem_.candidates[candidate], tasks_[task]);
    return known->second;
  }

  void choose(std::size_t task) {
    if (task == tasks_.size()) {
      time();
      return;
    }
    for (std::size_t c = 0; c < problem_.candidates.size(); ++c) {
      if (std::find(chosen_.begin(), chosen_.end(), c) != chosen_.end()) continue;
      const auto& found = known_leg(c, task);
      if (!found) continue;
      chosen_.push_back(c);
      legs_.push_back(*found);
      choose(task + 1);
      chosen_.pop_back();
      legs_.pop_back();
    }
  }

  [[nodiscard]] double offset_s(std::size_t i) const {
    return tasks_[i].kind == TaskKind::deliver
               ? to_seconds(problem_.site.deliveries[tasks_[i].index].offset)
               : 0.0;
  }
  /// The least moment >= from_s at which all tasks of the kind can be flown.
  [[nodiscard]] std::optional<double> least_moment(TaskKind kind, double from_s) const {
    double moment_s = from_s;
    for (int round = 0; round < 50; ++round) {
      double next_s = moment_s;
      for (std::size_t i = 0; i < tasks_.size(); ++i) {
        if (tasks_[i].kind != kind) continue;
        const Candidate& c = problem_.candidates[chosen_[i]];
        const double least_s =
            (legs_[i].shortest_m + legs_[i].timed_m) * params_.time_margin / c.speed_mps;
        const double wanted_s = std::max(least_s, moment_s + offset_s(i));
        const auto length =
            least_length_from({}, legs_[i].transit, wanted_s * c.speed_mps - legs_[i].timed_m);
        if (!length) return std::nullopt;
        const double reached_s = (*length + legs_[i].timed_m) / c.speed_mps;
        next_s = std::max(next_s, reached_s - offset_s(i));
      }
      if (next_s <= moment_s + 1e-8) return next_s;
      moment_s = next_s;
    }
    return std::nullopt;
  }
  /// J of the least moments without the lateness of assessments: more cannot come of this choice.
  [[nodiscard]] double hope() const {
    double first_s = std::max(0.0, to_seconds(problem_.earliest_delivery - problem_.start));
    double last_s = 0.0;
    double assess_s = 0.0;
    for (std::size_t i = 0; i < tasks_.size(); ++i) {
      const double least_s = (legs_[i].shortest_m + legs_[i].timed_m) * params_.time_margin /
                             problem_.candidates[chosen_[i]].speed_mps;
      const bool deliver = tasks_[i].kind == TaskKind::deliver;
      (deliver ? first_s : assess_s) =
          std::max(deliver ? first_s : assess_s, least_s - offset_s(i));
    }
    for (std::size_t i = 0; i < tasks_.size(); ++i) {
      last_s = std::max(last_s, first_s + offset_s(i));
    }
    assess_s = std::max(assess_s, last_s + to_seconds(problem_.site.assess_wait));
    ValueWeights weights = params_.weights;
    weights.timing = 0.0;
    return value_of(weights, problem_, plan(first_s, assess_s)).total;
  }
  void time() {
    if (hope() + 1e-9 < best_) return;
    const double first_s = std::max(0.0, to_seconds(problem_.earliest_delivery - problem_.start));
    const auto delivery_s = least_moment(TaskKind::deliver, first_s);
    if (!delivery_s) return;
    double last_s = *delivery_s;
    for (std::size_t i = 0; i < tasks_.size(); ++i) {
      last_s = std::max(last_s, *delivery_s + offset_s(i));
    }
    const double after_s = last_s + to_seconds(problem_.site.assess_wait);
    const auto assess_s = least_moment(TaskKind::assess, after_s);
    if (!assess_s) return;
    judge(*delivery_s, *assess_s);
    // Or deliveries that wait for the assessments, as long as they may.
    for (int i = 1; i <= 4; ++i) {
      const double later_s = *delivery_s + (*assess_s - after_s) * i / 4.0;
      const auto flyable = least_moment(TaskKind::deliver, later_s);
      if (flyable && *flyable <= later_s + 1e-8) judge(later_s, *assess_s);
    }
  }
  [[nodiscard]] std::vector<TaskAssignment> plan(double delivery_s, double assess_s) const {
    std::vector<TaskAssignment> all;
    for (std::size_t i = 0; i < tasks_.size(); ++i) {
      const double common_s = tasks_[i].kind == TaskKind::deliver ? delivery_s : assess_s;
      all.push_back({tasks_[i], problem_.candidates[chosen_[i]].id,
                     problem_.start + from_seconds(common_s + offset_s(i))});
    }
    return all;
  }
  void judge(double delivery_s, double assess_s) {
    const double value = value_of(params_.weights, problem_, plan(delivery_s, assess_s)).total;
    best_ = std::max(best_, value);
  }

  const AllocationProblem& problem_;
  const AllocationParams& params_;
  std::vector<TaskId> tasks_;
  std::vector<std::size_t> chosen_;
  std::vector<Leg> legs_;
  std::map<std::pair<std::size_t, std::size_t>, std::optional<Leg>> legs_of_;
  double best_ = -INFINITY;
};

TEST(AllocationMethods, HaveNames) {
  for (const auto method : kMethods) EXPECT_EQ(allocation_method(to_string(method)), method);
  EXPECT_FALSE(allocation_method("count"));
  EXPECT_FALSE(allocation_method(""));
}

void expect_exact(const Shape& shape, std::uint64_t seed, int problems, double timing_weight,
                  int expected) {
  Random random{seed};
  int solved = 0;
  for (int i = 0; i < problems; ++i) {
    const AllocationProblem problem = random_problem(random, shape);
    AllocationParams params = with(AllocationMethod::exact);
    params.weights.timing = timing_weight;
    const auto exact = allocate(params, problem);
    const double best = BruteForce{problem, params}.best();
    ASSERT_EQ(exact.ok(), std::isfinite(best)) << i;
    if (!exact) continue;
    ++solved;
    expect_feasible(problem, *exact);
    EXPECT_GE(exact->value_bound, best - 1e-7) << i;
    EXPECT_GE(exact->value.total, exact->value_bound - exact->gap() - 1e-12);
    if (exact->proven) {
      EXPECT_NEAR(exact->value.total, best, 2.0 * kValueTolerance) << i;
    } else {
      EXPECT_LE(best, exact->value_bound + 1e-9) << i;
    }
  }
  EXPECT_GE(solved, expected);
}

TEST(ExactAllocation, IsTheBestOfAllAssignments) {
  expect_exact({.deliveries = 3, .assessments = 1, .vehicles = 6}, 61, 20, 0.2, 12);
}
TEST(ExactAllocation, WithOffsetsAndFreeAngles) {
  expect_exact({.deliveries = 2,
                .assessments = 1,
                .vehicles = 5,
                .interval = seconds{5},
                .free_angles = true},
               62, 20, 0.2, 12);
}
TEST(ExactAllocation, AmongHazards) {
  expect_exact({.deliveries = 2, .assessments = 1, .vehicles = 5, .hazards = 4}, 63, 20, 0.2, 12);
}
/// Nothing is proven there but what is said: no start of an arc, tried or not, gives more.
TEST(ExactAllocation, FreeAnglesAmongHazardsAndNearTheSite) {
  expect_exact({.deliveries = 2,
                .assessments = 1,
                .vehicles = 5,
                .hazards = 4,
                .free_angles = true,
                .extent_m = 3000.0},
               73, 12, 0.2, 6);
  expect_exact(
      {.deliveries = 2, .assessments = 2, .vehicles = 6, .free_angles = true, .extent_m = 1500.0},
      74, 12, 0.2, 3);
}
TEST(ExactAllocation, NearTheSiteWhereLengthsHaveGaps) {
  expect_exact({.deliveries = 2, .assessments = 1, .vehicles = 5, .extent_m = 1500.0}, 64, 20, 0.2,
               5);
}
TEST(ExactAllocation, DeliveriesWaitForAssessmentsWhereTimingWeighsMore) {
  expect_exact({.deliveries = 2, .assessments = 2, .vehicles = 6}, 65, 20, 3.0, 12);
}

TEST(AllocationMethods, EveryPlanIsFeasibleAndNoneIsBetterThanBest) {
  Random random{66};
  for (int i = 0; i < 12; ++i) {
    const Shape shape{.deliveries = 4,
                      .assessments = 2,
                      .vehicles = 16,
                      .hazards = i % 3 == 0 ? 3U : 0U,
                      .interval = seconds{i % 2 == 0 ? 0 : 5},
                      .free_angles = i % 4 == 3};
    const AllocationProblem problem = random_problem(random, shape);
    const auto best = allocate(with(AllocationMethod::best), problem);
    ASSERT_TRUE(best.ok()) << best.error().message;
    EXPECT_TRUE(best->proven);
    for (const auto method : kMethods) {
      const auto plan = allocate(with(method), problem);
      ASSERT_TRUE(plan.ok()) << to_string(method) << ": " << plan.error().message;
      expect_feasible(problem, *plan);
      EXPECT_LE(plan->value.total, best->value.total + kValueTolerance) << to_string(method);
      EXPECT_LE(best->value.total, plan->value_bound + 1e-9) << to_string(method);
      EXPECT_GE(plan->gap(), 0.0);
      EXPECT_EQ(plan->method, method == AllocationMethod::best ? best->method : method);
      EXPECT_NEAR(plan->value.total, flown_value(problem, *plan, {}), 1e-6) << to_string(method);
    }
  }
}

TEST(AllocationMethods, TheEarliestIsNeverLaterThanAnyOther) {
  Random random{67};
  for (int i = 0; i < 10; ++i) {
    const AllocationProblem problem =
        random_problem(random, {.deliveries = 4, .assessments = 2, .vehicles = 16});
    const auto earliest = allocate(with(AllocationMethod::earliest), problem);
    ASSERT_TRUE(earliest.ok());
    for (const auto method : kMethods) {
      const auto plan = allocate(with(method), problem);
      ASSERT_TRUE(plan.ok());
      EXPECT_LE(earliest->first_delivery_s, plan->first_delivery_s + 1e-9) << to_string(method);
    }
  }
}

TEST(PlanValue, AddsUpByHand) {
  AllocationProblem problem;
  problem.site.id = SiteId{1};
  problem.site.deliveries = {{0.0, seconds{0}}, {1.0, seconds{4}}};
  problem.site.assessments = {{0.0, seconds{20}}};
  problem.site.assess_wait = seconds{10};
  problem.site.reward = 5.0;
  problem.site.reward_decay_per_s = 0.01;
  problem.open_tasks = tasks_after_survey(problem.site);
  problem.start = at_seconds(100.0);
  for (std::uint16_t i = 1; i <= 4; ++i) {
    Candidate c;
    c.id = VehicleId{i};
    c.speed_mps = 40.0 + i;
    c.range_left_m = 10000.0;
    c.assess_radius_m = 300.0;
    problem.candidates.push_back(c);
  }
  // The second delivery is a second late, so that the common time is 131 s: the first is a second
  // early. The assessment is 5 s late.
  const std::vector<TaskAssignment> plan{{problem.open_tasks[0], VehicleId{1}, at_seconds(130.0)},
                                         {problem.open_tasks[1], VehicleId{2}, at_seconds(135.0)},
                                         {problem.open_tasks[2], VehicleId{3}, at_seconds(150.0)}};
  const PlanValue value = value_of(
      {.reward = 2.0, .range = 3.0, .timing = 0.5, .timing_reference = seconds{10}}, problem, plan);
  // The arc is flown for 5 % longer than its 20 s.
  const double reward = 5.0 * (std::exp(-0.3) + std::exp(-0.35) + std::exp(-0.71));
  const double range = 40000.0 - 41.0 * 30.0 - 42.0 * 35.0 - 43.0 * 71.0;
  EXPECT_NEAR(value.reward, reward, 1e-9);
  EXPECT_NEAR(value.range_left_m, range, 1e-6);
  EXPECT_NEAR(value.timing_error_s, 1.0 + 0.0 + 5.0, 1e-9);
  EXPECT_NEAR(value.total, 2.0 * reward / 15.0 + 3.0 * range / 40000.0 - 0.5 * 6.0 / 30.0, 1e-9);
}

TEST(AllocationBudget, MoreIsNeverWorseAndBestAlwaysHasAPlan) {
  Random random{68};
  for (int i = 0; i < 6; ++i) {
    const AllocationProblem problem =
        random_problem(random, {.deliveries = 6, .assessments = 2, .vehicles = 24});
    for (const auto method :
         {AllocationMethod::best, AllocationMethod::exact, AllocationMethod::colony}) {
      double before = -INFINITY;
      for (const std::uint64_t steps : {0U, 1U, 4U, 16U, 64U, 256U, 1024U}) {
        const auto plan = allocate(with(method), problem, {.steps_max = steps, .expired = {}});
        if (!plan.ok()) {
          EXPECT_NE(method, AllocationMethod::best) << plan.error().message;
          EXPECT_EQ(before, -INFINITY) << "a plan was lost: " << to_string(method);
          EXPECT_LT(steps, 256U) << to_string(method);
          // The colony may have built plans that cannot be flown.
          if (method == AllocationMethod::exact || steps == 0) {
            EXPECT_THAT(plan.error().message, HasSubstr("within the planning budget"));
          }
          continue;
        }
        EXPECT_GE(plan->value.total, before) << to_string(method) << " with " << steps;
        EXPECT_GE(plan->value_bound, plan->value.total);
        before = plan->value.total;
      }
    }
  }
}

TEST(AllocationBudget, ExpiryEndsEveryMethodBeforeItHasAPlan) {
  Random random{72};
  const AllocationProblem problem =
      random_problem(random, {.deliveries = 6, .assessments = 2, .vehicles = 24});
  PlanningBudget spent;
  spent.expired = [] { return true; };
  for (const auto method :
       {AllocationMethod::exact, AllocationMethod::earliest, AllocationMethod::colony}) {
    const auto plan = allocate(with(method), problem, spent);
    ASSERT_FALSE(plan.ok()) << to_string(method);
    EXPECT_THAT(plan.error().message, HasSubstr("within the planning budget"));
  }
  EXPECT_TRUE(allocate(with(AllocationMethod::best), problem, spent).ok());
}

TEST(AllocationBudget, ExpiryEndsTheColony) {
  Random random{69};
  const AllocationProblem problem =
      random_problem(random, {.deliveries = 6, .assessments = 2, .vehicles = 24});
  int asked = 0;
  PlanningBudget budget;
  budget.expired = [&asked] { return ++asked > 3; };
  const auto plan = allocate(with(AllocationMethod::colony), problem, budget);
  ASSERT_TRUE(plan.ok());
  expect_feasible(problem, *plan);
  EXPECT_EQ(asked, 5) << "once more by the loop over generations";
}

TEST(AntColony, IsDeterminedByItsSeed) {
  Random random{70};
  AllocationProblem problem =
      random_problem(random, {.deliveries = 6, .assessments = 2, .vehicles = 24});
  AllocationParams params = with(AllocationMethod::colony);
  params.colony.generations = 1;
  const auto plan_of = [&](std::uint64_t seed) {
    problem.seed = seed;
    const auto plan = allocate(params, problem);
    std::vector<VehicleId> vehicles;
    for (const auto& a : plan.value().assignments) vehicles.push_back(a.vehicle);
    return vehicles;
  };
  EXPECT_EQ(plan_of(1), plan_of(1));
  EXPECT_NE(plan_of(1), plan_of(2));
}

TEST(AntColony, ComesWithinOnePercentOfExact) {
  Random random{71};
  for (int i = 0; i < 8; ++i) {
    const AllocationProblem problem =
        random_problem(random, {.deliveries = 8, .assessments = 2, .vehicles = 32});
    const auto exact = allocate(with(AllocationMethod::exact), problem);
    const auto colony = allocate(with(AllocationMethod::colony), problem);
    ASSERT_TRUE(exact.ok() && colony.ok());
    EXPECT_GE(colony->value.total, 0.99 * exact->value.total) << i;
  }
}

/// The last needed bidder by time of arrival fixes the coalition; nobody is in it without need.
TEST(Polynomial, TakesTheFirstToArrive) {
  AllocationProblem problem;
  problem.site.id = SiteId{1};
  problem.site.position = {3000.0, 0.0};
  problem.site.deliveries = {{0.0, {}}, {0.0, {}}};
  problem.site.assessments = {{0.0, seconds{20}}};
  problem.open_tasks = tasks_after_survey(problem.site);
  const auto add = [&](std::uint16_t id, double x_m, bool deliver, bool assess) {
    Candidate c;
    c.id = VehicleId{id};
    c.pose = {x_m, 0.0, 0.0};
    c.speed_mps = 50.0;
    c.planning_radius_m = 165.0;
    c.range_left_m = 18000.0;
    c.final_approach_m = 300.0;
    c.assess_radius_m = 300.0;
    if (deliver) c.capabilities.add(TaskKind::deliver);
    if (assess) c.capabilities.add(TaskKind::assess);
    c.loads = 1;
    problem.candidates.push_back(c);
  };
  add(1, 0.0, true, false);
  add(2, -500.0, false, true);
  add(3, -1000.0, true, true);
  add(4, -1500.0, true, false);
  add(5, -2000.0, true, true);
  const auto plan = allocate(with(AllocationMethod::polynomial), problem);
  ASSERT_TRUE(plan.ok()) << plan.error().message;
  std::set<std::uint16_t> members;
  for (const auto& a : plan->assignments) members.insert(a.vehicle.value);
  EXPECT_EQ(members, (std::set<std::uint16_t>{1, 2, 3}));
}

}  // namespace
}  // namespace skein::planning
