// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/task_planning.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "skein/coupled/coupled.hpp"
#include "skein/planning/budget.hpp"

namespace skein::groundstation {
namespace {

using ::testing::HasSubstr;

configuration::Scenario coalition_6() {
  auto scenario = configuration::load_scenario(SKEIN_SOURCE_DIR "/scenarios/coalition-6.yaml");
  EXPECT_TRUE(scenario.ok()) << scenario.error().message;
  scenario->tasking.known = {SiteId{1}};
  EXPECT_TRUE(configuration::check(*scenario).ok());
  return *scenario;
}

TEST(TaskPlanning, PlansTheShippedMissionAndItsFileIsReadBackAndGiven) {
  const auto scenario = coalition_6();
  const auto planned = plan_tasks(scenario);
  ASSERT_TRUE(planned.ok()) << planned.error().message;
  EXPECT_TRUE(planned->plan.proven);
  EXPECT_EQ(planned->plan.tasks.size(), 6U);
  EXPECT_THAT(tasks_text(*planned), HasSubstr("proven the best"));

  const std::string text = to_yaml(planned->file);
  EXPECT_EQ(text, to_yaml(plan_tasks(scenario)->file)) << "the same bytes again";
  const auto read = configuration::parse_tasking_plan(text, "plan.yaml");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(to_yaml(*read), text);
  auto given = scenario;
  ASSERT_TRUE(configuration::give_tasks(*read, given).ok());
  const Site& site = scenario.sites.front();
  for (const auto& part : read->vehicles) {
    const auto vehicle = std::ranges::find_if(
        given.vehicles, [&](const auto& v) { return v.spec.id == part.vehicle; });
    ASSERT_EQ(vehicle->search.size(), 1U);
    const double away_m = (vehicle->search.front() - site.position).norm();
    if (part.tasks.front().task.kind == TaskKind::survey) {
      EXPECT_LT(away_m, vehicle->spec.sensor_radius_m) << "it finds the site there";
    } else {
      EXPECT_GT(away_m, vehicle->spec.planning_radius_m()) << "it waits before its task";
    }
  }
}

TEST(TaskPlanning, LeavesTheOperatorTimeToDecide) {
  auto scenario = coalition_6();
  const double soon_s = plan_tasks(scenario)->plan.makespan_s;
  scenario.protocol.authorisation_lead += std::chrono::seconds{60};
  EXPECT_GT(plan_tasks(scenario)->plan.makespan_s, soon_s + 30.0);
}

TEST(TaskPlanning, SaysWhyThereIsNoPlan) {
  auto scenario = coalition_6();
  scenario.tasking.known.clear();
  EXPECT_THAT(plan_tasks(scenario).error().message, HasSubstr("tasking.known"));
  scenario = coalition_6();
  for (auto& vehicle : scenario.vehicles) vehicle.spec.range_m = 100.0;
  EXPECT_THAT(plan_tasks(scenario).error().message, HasSubstr("within its range"));
}

TEST(TaskPlanning, LeavesNoSiteOutThatVehiclesCanDoAfterAnother) {
  auto scenario = coalition_6();
  Site second = scenario.sites.front();
  second.id = SiteId{2};
  second.position += Vec2{600.0, 0.0};
  scenario.sites = {scenario.sites.front(), second};
  scenario.tasking.known = scenario.tasking.optional = {SiteId{1}, SiteId{2}};
  scenario.tasking.criterion = planning::Criterion::value;
  for (auto& vehicle : scenario.vehicles) {
    vehicle.spec.loads = 2;
    vehicle.spec.range_m = 1e6;
  }
  const auto planned = plan_tasks(scenario);
  ASSERT_TRUE(planned.ok()) << planned.error().message;
  EXPECT_TRUE(planned->plan.left_out.empty());
}

TEST(TaskPlanning, NoTimeIsSpentOnOneTaskEachWhereVehiclesAreTooFew) {
  auto scenario = coalition_6();
  Site second = scenario.sites.front();
  second.id = SiteId{2};
  second.position += Vec2{600.0, 0.0};
  scenario.sites.push_back(second);
  scenario.tasking.known = {SiteId{1}, SiteId{2}};
  for (auto& vehicle : scenario.vehicles) {
    vehicle.spec.loads = 2;
    vehicle.spec.range_m = 1e6;
  }
  const auto search = [](int& asked) {
    return planning::PlanningBudget{1, [&asked] { return ++asked > 0; }};
  };
  int asked = 0;
  const auto planned = plan_tasks(scenario, search(asked));
  ASSERT_TRUE(planned.ok()) << planned.error().message;
  EXPECT_EQ(planned->problem.share, planning::TaskShare::one_a_site);
  int asked_by_one = 0;
  EXPECT_TRUE(planning::branch_and_bound(planned->problem, search(asked_by_one)).ok());
  EXPECT_EQ(asked, asked_by_one) << "searches";
}

TEST(TaskPlanning, APlanForOthersIsRefused) {
  auto scenario = coalition_6();
  auto plan = plan_tasks(scenario)->file;
  const auto good = plan;
  plan.vehicles.front().vehicle = VehicleId{77};
  auto given = scenario;
  EXPECT_THAT(configuration::give_tasks(plan, given).error().message,
              HasSubstr("vehicle 77 is not in the fleet"));
  given.sites.clear();
  EXPECT_THAT(configuration::give_tasks(good, given).error().message,
              HasSubstr("which the mission does not have"));
}

TEST(TaskPlanning, AMissionThatContradictsItselfIsRefused) {
  auto scenario = coalition_6();
  scenario.tasking.optional = {SiteId{1}};
  EXPECT_THAT(configuration::check(scenario).error().message, HasSubstr("criterion reward"));
  scenario.tasking.known = {SiteId{9}};
  EXPECT_THAT(configuration::check(scenario).error().message, HasSubstr("tasking.known"));
}

}  // namespace
}  // namespace skein::groundstation
