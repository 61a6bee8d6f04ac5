// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "skein/hil/judged_runs.hpp"
#include "skein/hil/team_mission.hpp"

/// Planes and copters in one coalition.
namespace skein::hil {
namespace {

using mission::EventKind;

configuration::Scenario mixed() {
  auto scenario =
      configuration::load_scenario(std::string{SKEIN_SOURCE_DIR} + "/scenarios/mixed-6.yaml");
  EXPECT_TRUE(scenario) << scenario.error().message;
  return *scenario;
}

TeamMission mission_of(const configuration::Scenario& scenario, std::uint64_t seed,
                       const std::string& faults = "none") {
  const auto mission = seeded_mission(scenario, seed, faults);
  EXPECT_TRUE(mission) << mission.error().message;
  return *mission;
}

std::string told(const JudgedRun& run) {
  std::string text = "seed " + std::to_string(run.seed) + "\n";
  for (const auto& check : run.broken) {
    text += check.name + "\n";
    for (const auto& violation : check.violations) text += "  " + violation.sentence + "\n";
  }
  return text;
}

TEST(MixedTeam, CoptersTakeOffSurveyAndAssessWhatPlanesDeliver) {
  const auto scenario = mixed();
  const TeamMission mission = mission_of(scenario, 1);
  std::set<VehicleId> copters;
  for (const auto& v : mission.vehicles) {
    if (v.spec.is_copter()) copters.insert(v.spec.id);
  }
  ASSERT_EQ(copters.size(), 2U);
  std::map<EventKind, std::set<VehicleId>> who;
  std::map<VehicleId, double> off_m;  // greatest, once they have gathered speed
  std::map<VehicleId, double> lowest_m;
  TeamObserver watcher;
  watcher.event = [&](const mission::MissionEvent& event) {
    if (event.kind() == EventKind::task_done && event.task.kind == TaskKind::assess) {
      EXPECT_TRUE(copters.contains(event.vehicle)) << event.vehicle.value;
    }
    who[event.kind()].insert(event.vehicle);
  };
  watcher.track = [&](VehicleId id, const VehicleState& state, const mission::FlightPlan& plan) {
    if (!copters.contains(id)) return;
    if (plan.number == 0) {
      lowest_m.try_emplace(id, state.z_m);
      return;
    }
    const Pose2 pose = plan.timed.pose_at(state.time);
    const double off = (Vec2{state.x_m, state.y_m} - pose.position()).norm();
    if (state.time > at_seconds(40)) off_m[id] = std::max(off_m[id], off);
  };
  const auto run = fly_judged(mission, limits_of(scenario.expect), watcher);
  EXPECT_TRUE(run.held()) << told(run);
  EXPECT_TRUE(run.sites_done);
  EXPECT_TRUE(copters.contains(*who[EventKind::survey_done].begin()));
  for (const VehicleId id : copters) {
    EXPECT_TRUE(who[EventKind::task_done].contains(id)) << "both assess";
    EXPECT_NEAR(lowest_m.at(id), 0.0, 0.5) << "from the ground";
    EXPECT_LT(off_m.at(id), 1.0);
  }
}

TEST(MixedTeam, AHundredSeedsHold) {
  const auto runs = fly_series(mixed(), {"none", 1, 100, 2});
  ASSERT_EQ(runs.size(), 100U);
  for (const JudgedRun& run : runs) {
    EXPECT_TRUE(run.held()) << told(run);
    EXPECT_TRUE(run.sites_done) << run.seed;
  }
}

TEST(MixedTeam, FaultsBreakNoRule) {
  for (const auto& run : fly_series(mixed(), {"mixed", 1, 100, 2})) {
    EXPECT_TRUE(run.held()) << told(run);
  }
}

/// A copter delivers where its configuration says that it can.
TEST(MixedTeam, ACopterThatCanDelivers) {
  auto scenario = mixed();
  for (auto& v : scenario.vehicles) {
    if (!v.spec.is_copter()) continue;
    v.spec.capabilities.add(TaskKind::deliver);
    v.spec.loads = 1;
    v.spec.final_approach_m = 40.0;
  }
  std::erase_if(scenario.vehicles, [](const auto& v) { return v.spec.id == VehicleId{1}; });
  std::erase_if(scenario.vehicles, [](const auto& v) { return v.spec.id == VehicleId{4}; });
  scenario.sites[0].assessments.resize(1);
  scenario.duration_max = std::chrono::minutes{5};
  ASSERT_TRUE(configuration::check(scenario)) << configuration::check(scenario).error().message;
  const TeamMission mission = mission_of(scenario, 1);
  std::size_t delivered = 0;
  TeamObserver watcher;
  watcher.event = [&](const mission::MissionEvent& event) {
    if (event.kind() == EventKind::task_done && event.task.kind == TaskKind::deliver &&
        event.vehicle.value >= 5) {
      ++delivered;
    }
  };
  const auto run = fly_judged(mission, limits_of(scenario.expect), watcher);
  EXPECT_TRUE(run.held()) << told(run);
  EXPECT_TRUE(run.sites_done);
  EXPECT_EQ(delivered, 1U);
}

/// In six degrees of freedom, under the loops of hal, in wind with gusts.
TEST(MixedTeam, HexarotorsFlyTheSameMission) {
  auto scenario = mixed();
  scenario.wind.gust_mps = 0.3;
  TeamMission mission = mission_of(scenario, 1);
  for (auto& v : mission.vehicles) {
    if (v.body == Body::multirotor) v.body = Body::hexarotor;
  }
  const auto run = fly_judged(mission, limits_of(scenario.expect));
  EXPECT_TRUE(run.held()) << told(run);
  EXPECT_TRUE(run.sites_done);
}

}  // namespace
}  // namespace skein::hil
