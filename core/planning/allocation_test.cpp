// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/allocation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"
#include "skein/planning/dubins.hpp"
#include "skein/planning/task_path.hpp"

namespace skein::planning {
namespace {

using std::chrono::seconds;

Candidate candidate(std::uint16_t id, const Pose2& pose) {
  Candidate c;
  c.id = VehicleId{id};
  c.pose = pose;
  c.speed_mps = 50.0;
  c.planning_radius_m = 165.0;
  c.range_left_m = 18000.0;
  c.final_approach_m = 400.0;
  c.assess_radius_m = 250.0;
  c.capabilities.add(TaskKind::survey).add(TaskKind::deliver).add(TaskKind::assess);
  c.loads = 2;
  return c;
}

Site site_with(std::size_t deliveries, seconds interval, std::size_t assessments) {
  Site site;
  site.id = SiteId{2};
  site.position = {3000.0, 3000.0};
  for (std::size_t i = 0; i < deliveries; ++i) {
    const double bearing = kTwoPi * static_cast<double>(i) / static_cast<double>(deliveries);
    site.deliveries.push_back({interval.count() == 0 ? bearing : 1.0, interval * i});
  }
  site.assess_wait = seconds{10};
  for (std::size_t i = 0; i < assessments; ++i) {
    site.assessments.push_back(
        {kTwoPi * static_cast<double>(i) / static_cast<double>(assessments), seconds{20}});
  }
  return site;
}

AllocationProblem random_problem(Random& random, const Site& site, std::size_t vehicles) {
  AllocationProblem problem;
  problem.site = site;
  problem.open_tasks = tasks_after_survey(site);
  problem.start = at_seconds(40.0);
  for (std::size_t i = 0; i < vehicles; ++i) {
    Candidate c =
        candidate(static_cast<std::uint16_t>(i + 1),
                  {random.uniform(0, 6000), random.uniform(0, 6000), random.uniform(-kPi, kPi)});
    if (i % 3 == 1) {
      c.speed_mps = 60.0;
      c.capabilities = Capabilities{}.add(TaskKind::deliver);
    }
    if (i % 3 == 2) {
      c.capabilities = Capabilities{}.add(TaskKind::survey).add(TaskKind::assess);
      c.loads = 0;
    }
    problem.candidates.push_back(c);
  }
  return problem;
}

const Candidate& find(const AllocationProblem& problem, VehicleId id) {
  return *std::find_if(problem.candidates.begin(), problem.candidates.end(),
                       [id](const Candidate& c) { return c.id == id; });
}

/// Everything that an allocation promises, flown.
void expect_sound(const AllocationProblem& problem, const Allocation& allocation) {
  const Site& site = problem.site;
  ASSERT_EQ(allocation.assignments.size(), problem.open_tasks.size());
  std::set<VehicleId> used;
  std::set<TaskId> done;
  Instant last = problem.deliveries_done;
  for (const auto& a : allocation.assignments) {
    used.insert(a.vehicle);
    done.insert(a.task);
    if (a.task.kind == TaskKind::deliver) last = std::max(last, a.time);
  }
  EXPECT_EQ(used.size(), allocation.assignments.size());
  EXPECT_EQ(done, std::set<TaskId>(problem.open_tasks.begin(), problem.open_tasks.end()));
  std::optional<Instant> assess_time;
  for (const auto& a : allocation.assignments) {
    const Candidate& c = find(problem, a.vehicle);
    EXPECT_TRUE(c.capabilities.has(a.task.kind));
    const auto plan = plan_task({}, c, problem.start, site, a, problem.hazards);
    ASSERT_TRUE(plan.ok()) << plan.error().message;
    const Path& path = plan->timed.path;
    EXPECT_LE(path.length_m(), c.range_left_m + 1e-3);
    EXPECT_LE(path.curvature_max_per_m(), 1.0 / c.planning_radius_m + 1e-12);
    // Who starts inside a hazard leaves it first.
    const bool outside = is_clear(Path{.start = c.pose, .segments = {}}, problem.hazards);
    EXPECT_TRUE(!outside || is_clear(path, problem.hazards));
    EXPECT_NEAR((path.start.position() - c.pose.position()).norm(), 0.0, 1e-9);
    EXPECT_EQ(plan->timed.start_time, problem.start);
    EXPECT_NEAR(plan->timed.tail_curvature_per_m, 1.0 / c.planning_radius_m, 1e-12);
    if (a.task.kind == TaskKind::deliver) {
      EXPECT_GE(c.loads, 1);
      const auto& wanted = site.deliveries[a.task.index];
      EXPECT_NEAR((plan->timed.pose_at(a.time).position() - site.position).norm(), 0.0, 1e-5);
      EXPECT_NEAR(wrap_pi(plan->timed.pose_at(a.time).heading_rad - wanted.bearing_rad), 0.0, 1e-7);
      EXPECT_NEAR(plan->gate_m, path.length_m() - c.final_approach_m, 1e-9);
      EXPECT_GE(a.time, problem.earliest_delivery);
      EXPECT_NEAR(to_seconds(a.time - problem.start),
                  allocation.first_delivery_s + to_seconds(wanted.offset), 1e-6);
    } else {
      if (!assess_time) assess_time = a.time;
      EXPECT_EQ(a.time, *assess_time) << "all assessments start together";
      EXPECT_GE(a.time, last + site.assess_wait);
      const Pose2 at = plan->timed.pose_at(a.time);
      EXPECT_NEAR((at.position() - site.position).norm(), c.assess_radius_m, 1e-5);
      EXPECT_NEAR(plan->gate_m, plan->timed.distance_at(a.time), 1e-5);
      const Pose2 later = plan->timed.pose_at(a.time + seconds{20});
      EXPECT_NEAR((later.position() - site.position).norm(), c.assess_radius_m, 1e-5);
    }
  }
}

TEST(Allocation, SimultaneousDeliveriesAreSoundInRandomTeams) {
  Random random{51};
  for (int i = 0; i < 20; ++i) {
    AllocationProblem problem = random_problem(random, site_with(6, seconds{0}, 3), 24);
    const auto allocation = allocate({}, problem);
    ASSERT_TRUE(allocation.ok()) << allocation.error().message;
    expect_sound(problem, *allocation);
  }
}

TEST(Allocation, SequentialDeliveriesKeepTheirInterval) {
  Random random{52};
  for (int i = 0; i < 20; ++i) {
    AllocationProblem problem = random_problem(random, site_with(6, seconds{5}, 3), 24);
    problem.earliest_delivery = at_seconds(110.0);
    const auto allocation = allocate({}, problem);
    ASSERT_TRUE(allocation.ok()) << allocation.error().message;
    expect_sound(problem, *allocation);
  }
}

TEST(Allocation, AmongHazards) {
  Random random{53};
  int found = 0;
  for (int i = 0; i < 10; ++i) {
    AllocationProblem problem = random_problem(random, site_with(4, seconds{0}, 2), 18);
    for (std::uint16_t h = 0; h < 4; ++h) {
      const double angle = random.uniform(-kPi, kPi);
      const Vec2 centre = problem.site.position + random.uniform(1000, 2500) * unit_vector(angle);
      problem.hazards.push_back({HazardId{h}, centre, random.uniform(50, 250)});
    }
    const auto allocation = allocate({}, problem);
    if (!allocation) continue;
    ++found;
    expect_sound(problem, *allocation);
  }
  EXPECT_GE(found, 9);
}

/// One bearing, everybody far off on a ray: the least common time is the n-th arrival.
TEST(Allocation, TheFirstDeliveryIsTheBottleneck) {
  AllocationProblem problem;
  problem.site = site_with(2, seconds{0}, 0);
  for (auto& d : problem.site.deliveries) d.bearing_rad = 0.0;
  problem.open_tasks = tasks_after_survey(problem.site);
  for (std::uint16_t i = 0; i < 4; ++i) {
    problem.candidates.push_back(
        candidate(static_cast<std::uint16_t>(9 - i), {1000.0 - 500.0 * i, 3000.0, 0.0}));
  }
  const auto allocation = allocate({}, problem);
  ASSERT_TRUE(allocation.ok()) << allocation.error().message;
  // 2500 m for the second, raised by the margin for wind.
  EXPECT_NEAR(allocation->first_delivery_s, 2500.0 * 1.01 / 50.0, 1e-6);
  std::set<VehicleId> used;
  for (const auto& a : allocation->assignments) used.insert(a.vehicle);
  EXPECT_EQ(used, (std::set<VehicleId>{VehicleId{9}, VehicleId{8}}));
  expect_sound(problem, *allocation);
}

/// The least time against every choice of vehicles, without gaps in the way.
TEST(Allocation, NoOtherChoiceDeliversSooner) {
  Random random{54};
  for (int i = 0; i < 20; ++i) {
    AllocationProblem problem = random_problem(random, site_with(3, seconds{0}, 0), 7);
    for (Candidate& c : problem.candidates) {
      c.capabilities.add(TaskKind::deliver);
      c.loads = 1;
    }
    const auto allocation = allocate({}, problem);
    ASSERT_TRUE(allocation.ok());
    double least = INFINITY;
    const auto seconds_of = [&](std::size_t c, std::size_t d) {
      const Candidate& v = problem.candidates[c];
      const auto entry =
          delivery_path(problem.site, problem.site.deliveries[d], v.final_approach_m).entry;
      return (shortest_dubins_length(v.pose, entry, v.planning_radius_m) + v.final_approach_m) *
             1.01 / v.speed_mps;
    };
    for (std::size_t a = 0; a < 7; ++a) {
      for (std::size_t b = 0; b < 7; ++b) {
        for (std::size_t c = 0; c < 7; ++c) {
          if (a == b || b == c || a == c) continue;
          least = std::min(least, std::max({seconds_of(a, 0), seconds_of(b, 1), seconds_of(c, 2)}));
        }
      }
    }
    EXPECT_GE(allocation->first_delivery_s, least - 1e-6);
    // A gap of the lengths may cost up to one loop.
    EXPECT_LE(allocation->first_delivery_s, least + kTwoPi * 165.0 / 50.0);
  }
}

TEST(Allocation, WhoAloneCanAssessIsLeftForIt) {
  AllocationProblem problem;
  problem.site = site_with(2, seconds{0}, 1);
  problem.open_tasks = tasks_after_survey(problem.site);
  problem.candidates = {candidate(1, {2000, 3000, 0}), candidate(2, {-3000, 3000, 0}),
                        candidate(3, {-3500, 3000, 0})};
  for (std::size_t i = 1; i < 3; ++i) {
    problem.candidates[i].capabilities = Capabilities{}.add(TaskKind::deliver);
  }
  const auto allocation = allocate({}, problem);
  ASSERT_TRUE(allocation.ok()) << allocation.error().message;
  expect_sound(problem, *allocation);
  EXPECT_EQ(allocation->assignments.back().task.kind, TaskKind::assess);
  EXPECT_EQ(allocation->assignments.back().vehicle, VehicleId{1});
}

TEST(Allocation, AssessmentsMoveLaterOnlyAsFarAsNeeded) {
  AllocationProblem problem;
  problem.site = site_with(1, seconds{0}, 1);
  problem.open_tasks = tasks_after_survey(problem.site);
  problem.candidates = {candidate(1, {2000, 3000, 0}), candidate(2, {-6000, 3000, 0})};
  problem.candidates[0].capabilities = Capabilities{}.add(TaskKind::deliver);
  problem.site.assessments[0].start_angle_rad = -kPi / 2.0;  // entered from the west, eastwards
  const auto allocation = allocate({}, problem);
  ASSERT_TRUE(allocation.ok()) << allocation.error().message;
  expect_sound(problem, *allocation);
  const Pose2 entry{3000, 2750, 0};
  const double soonest =
      shortest_dubins_length(problem.candidates[1].pose, entry, 165.0) * 1.01 / 50.0;
  EXPECT_NEAR(to_seconds(allocation->assignments[1].time), soonest, 1e-6);
}

TEST(Allocation, AssessmentsWaitForDeliveriesOfOthers) {
  AllocationProblem problem;
  problem.site = site_with(2, seconds{0}, 2);
  for (std::uint8_t i = 0; i < 2; ++i) {
    problem.open_tasks.push_back({problem.site.id, TaskKind::assess, i});
  }
  problem.start = at_seconds(50.0);
  problem.deliveries_done = at_seconds(200.0);
  problem.candidates = {candidate(1, {2000, 3000, 0}), candidate(2, {3000, 1000, 0})};
  const auto allocation = allocate({}, problem);
  ASSERT_TRUE(allocation.ok()) << allocation.error().message;
  expect_sound(problem, *allocation);
  EXPECT_EQ(allocation->assignments[0].time, at_seconds(210.0));
  EXPECT_EQ(allocation->first_delivery_s, 0.0);
}

TEST(Allocation, AnArcWithoutAnAngleStartsWhereItIsReachedSoonest) {
  AllocationProblem problem;
  problem.site = site_with(0, seconds{0}, 1);
  problem.site.assessments[0].start_angle_rad.reset();
  problem.open_tasks = tasks_after_survey(problem.site);
  problem.candidates = {candidate(1, {0, 2750, 0})};
  const auto allocation = allocate({}, problem);
  ASSERT_TRUE(allocation.ok()) << allocation.error().message;
  expect_sound(problem, *allocation);
  EXPECT_LT(to_seconds(allocation->assignments[0].time), 3010.0 * 1.01 / 50.0);
}

TEST(Allocation, OrderOfCandidatesDoesNotMatter) {
  Random random{55};
  AllocationProblem problem = random_problem(random, site_with(6, seconds{5}, 3), 24);
  const auto first = allocate({}, problem);
  std::reverse(problem.candidates.begin(), problem.candidates.end());
  std::reverse(problem.open_tasks.begin(), problem.open_tasks.end());
  const auto second = allocate({}, problem);
  ASSERT_TRUE(first.ok() && second.ok());
  ASSERT_EQ(first->assignments.size(), second->assignments.size());
  for (std::size_t i = 0; i < first->assignments.size(); ++i) {
    EXPECT_EQ(first->assignments[i].task, second->assignments[i].task);
    EXPECT_EQ(first->assignments[i].vehicle, second->assignments[i].vehicle);
    EXPECT_EQ(first->assignments[i].time, second->assignments[i].time);
  }
}

TEST(Allocation, SaysWhatIsMissing) {
  Random random{56};
  AllocationProblem problem = random_problem(random, site_with(6, seconds{0}, 1), 9);
  for (Candidate& c : problem.candidates) {
    if (c.id.value > 4) c.loads = 0;
    c.capabilities.add(TaskKind::deliver);
  }
  const auto few = allocate({}, problem);
  ASSERT_FALSE(few.ok());
  EXPECT_EQ(few.error().message, "site 2 needs 6 deliveries: 3 of 9 candidates can deliver");
  for (Candidate& c : problem.candidates) c.range_left_m = 10.0;
  const auto far = allocate({}, problem);
  ASSERT_FALSE(far.ok());
  EXPECT_NE(far.error().message.find("0 of 9"), std::string::npos) << far.error().message;
}

TEST(Allocation, RangeIsRespectedBeforeSpeed) {
  AllocationProblem problem;
  problem.site = site_with(1, seconds{0}, 0);
  problem.open_tasks = tasks_after_survey(problem.site);
  problem.candidates = {candidate(1, {2000, 3000, 0}), candidate(2, {-2000, 3000, 0})};
  problem.candidates[0].range_left_m = 900.0;
  const auto allocation = allocate({}, problem);
  ASSERT_TRUE(allocation.ok());
  EXPECT_EQ(allocation->assignments[0].vehicle, VehicleId{2});
}

TEST(PlanSurvey, FliesTheRequiredArcAtOnce) {
  VehicleSpec v;
  v.id = VehicleId{1};
  v.cruise_speed_mps = 50.0;
  v.turn_radius_m = 150.0;
  v.sensor_radius_m = 300.0;
  Site site = site_with(0, seconds{0}, 0);
  site.survey = {kPi / 2.0, seconds{20}};
  const Pose2 from{1000, 1000, 0.0};
  const auto plan = plan_survey({}, v, from, at_seconds(5.0), site, {});
  ASSERT_TRUE(plan.ok()) << plan.error().message;
  // It comes from the west: clockwise, heading east at the north point, is the shorter way.
  const Pose2 entry{3000, 3300, 0.0};
  EXPECT_NEAR(plan->gate_m, shortest_dubins_length(from, entry, 165.0), 1e-6);
  EXPECT_LT(plan->gate_m, shortest_dubins_length(from, {3000, 3300, kPi}, 165.0));
  EXPECT_GE(plan->timed.path.length_m() - plan->gate_m, 20.0 * 50.0);
  EXPECT_NEAR(plan->timed.tail_curvature_per_m, -1.0 / 300.0, 1e-12) << "and circles on";
  const double arc_m = plan->timed.path.length_m() - plan->gate_m;
  for (int i = 0; i <= 100; ++i) {
    const double s = plan->gate_m + arc_m * i / 100.0;
    EXPECT_NEAR((plan->timed.path.pose_at(s).position() - site.position).norm(), 300.0, 1e-6);
  }
  site.survey.start_angle_rad.reset();
  const auto sooner = plan_survey({}, v, from, at_seconds(5.0), site, {});
  ASSERT_TRUE(sooner.ok());
  EXPECT_LE(sooner->gate_m, plan->gate_m);
  v.sensor_radius_m = 100.0;
  EXPECT_FALSE(plan_survey({}, v, from, at_seconds(5.0), site, {}).ok());
}

}  // namespace
}  // namespace skein::planning
