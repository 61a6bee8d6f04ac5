// SPDX-License-Identifier: Apache-2.0
// The operator recalls the team in the middle of its mission: judged as any mission is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/hil/judged_runs.hpp"
#include "skein/hil/team_mission.hpp"

namespace skein::hil {
namespace {

using mission::EventKind;
using ::testing::ElementsAre;

struct Recalled {
  JudgedRun run;
  std::vector<mission::MissionEvent> events;
  std::map<VehicleId, TimedPath> flown_last;

  [[nodiscard]] std::size_t count(EventKind kind) const {
    return static_cast<std::size_t>(std::ranges::count_if(
        events, [kind](const mission::MissionEvent& e) { return e.kind() == kind; }));
  }
  [[nodiscard]] std::vector<std::string> broken() const {
    std::vector<std::string> names;
    for (const auto& check : run.broken) names.push_back(check.name);
    return names;
  }
};

Recalled recall(TeamMission team, Instant at) {
  team.faults.push_back(
      {{.not_before = at}, {}, Ordered{kGroundStation, mission::CommandKind::return_home}});
  Recalled recalled;
  TeamObserver observer;
  observer.event = [&](const mission::MissionEvent& e) { recalled.events.push_back(e); };
  observer.plan = [&](VehicleId id, const mission::FlightPlan& plan, Instant /*at*/) {
    recalled.flown_last[id] = plan.timed;
  };
  checks::Limits limits;
  limits.separation_horizontal_m = 20.0;
  limits.separation_vertical_m = 5.0;
  recalled.run = fly_judged(team, limits, observer);
  return recalled;
}

void lose(TeamMission& team, double share) {
  team.faults.push_back({{}, {}, radio::Disturbance{.loss = share}});
}

/// Home, and those of one runway 15 s apart.
void expect_home_one_after_another(const Recalled& recalled, const TeamMission& team) {
  for (std::size_t i = 0; i < team.vehicles.size(); ++i) {
    const SimulatedVehicle& v = team.vehicles[i];
    const Instant arrival = recalled.flown_last.at(v.spec.id).end_time();
    EXPECT_LT(arrival, recalled.run.result.ended_at) << "it was seen to orbit";
    const Vec2 end = recalled.run.result.vehicles[i].position;
    EXPECT_LT((end - v.start.position()).norm(), 1000.0) << v.spec.id.value;
    for (std::size_t j = 0; j < i; ++j) {
      const SimulatedVehicle& other = team.vehicles[j];
      if ((v.start.position() - other.start.position()).norm() > 295.0) continue;
      const Duration apart = arrival - recalled.flown_last.at(other.spec.id).end_time();
      EXPECT_GE(std::abs(to_seconds(apart)), 15.0 - 1e-3)
          << v.spec.id.value << " and " << other.spec.id.value;
    }
  }
}

TEST(ReturnRuns, ATeamThatIsRecalledInItsMissionComesHomeApartAlsoWithLoss) {
  const auto scenario =
      configuration::load_scenario(std::string{SKEIN_SOURCE_DIR} + "/scenarios/coalition-6.yaml");
  ASSERT_TRUE(scenario) << scenario.error().message;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    auto team = seeded_mission(*scenario, seed, "none");
    ASSERT_TRUE(team) << team.error().message;
    team->duration_max = std::chrono::seconds{185};
    if (seed % 2 == 0) lose(*team, 0.3);
    const auto recalled = recall(*team, at_seconds(15.0 + 5.0 * static_cast<double>(seed)));
    EXPECT_THAT(recalled.broken(), ElementsAre("completion")) << "it was recalled";
    EXPECT_GE(recalled.count(EventKind::return_planned), 1U);
    EXPECT_EQ(recalled.count(EventKind::return_alone), 0U);
    expect_home_one_after_another(recalled, *team);
  }
}

TEST(ReturnRuns, AMissionThatEndsLandedEndsWithAllOnTheGround) {
  for (const std::string name : {"hil-planes-2", "mixed-6"}) {
    SCOPED_TRACE(name);
    const auto scenario = configuration::load_scenario(std::string{SKEIN_SOURCE_DIR} +
                                                       "/scenarios/" + name + ".yaml");
    ASSERT_TRUE(scenario) << scenario.error().message;
    TeamMission team = team_mission(*scenario);
    team.ends_landed = true;
    team.duration_max = std::chrono::seconds{900};
    for (SimulatedVehicle& v : team.vehicles) v.spec.range_m = 30e3;  // the last waits for all
    const JudgedRun run = fly_judged(team, limits_of(scenario->expect));
    for (const auto& check : run.broken) {
      ADD_FAILURE() << check.name << ": " << check.violations.front().sentence;
    }
    for (const VehicleEnd& end : run.result.vehicles) EXPECT_TRUE(end.landed) << end.vehicle.value;
    EXPECT_LT(run.result.ended_at, at_seconds(700.0));
  }
}

/// In a fan from a row of homes, all at one height: on their own ways home they would meet, and
/// their orbits there overlap.
TeamMission fan(std::uint64_t seed) {
  TeamMission team;
  constexpr std::uint16_t kCount = 8;
  for (std::uint16_t n = 1; n <= kCount; ++n) {
    VehicleSpec v;
    v.id = VehicleId{n};
    v.cruise_speed_mps = 25.0;
    v.speed_min_mps = 19.0;
    v.speed_max_mps = 31.0;
    v.turn_radius_m = 60.0;
    v.heading_gain_per_s = 1.5;
    v.range_m = 30'000.0;
    v.height_m = 100.0;
    const double out_rad = radians(20.0 * n - 90.0);
    const Vec2 far = 2500.0 * unit_vector(out_rad);
    team.vehicles.push_back(
        {v, {0.0, 60.0 * n - 270.0, out_rad}, {{far.x(), far.y() + 60.0 * n - 270.0}}});
  }
  Site site;  // that nobody finds
  site.id = SiteId{1};
  site.position = {50'000.0, 0.0};
  team.sites = {site};
  team.wind.steady_mps = {3.0, -2.0};
  team.wind.gust_mps = 0.5;
  team.wind.seed = seed;
  team.radio.range_m = 20'000.0;
  team.protocol.separation_look_ahead = {};  // nobody helps the planned ways by a change of height
  team.duration_max = std::chrono::seconds{420};
  team.seed = seed;
  return team;
}

TEST(ReturnRuns, PlanesOfOneHeightAreKeptApart) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    auto team = fan(seed);
    if (seed > 1) lose(team, 0.3);
    const auto recalled = recall(team, at_seconds(60.0));
    EXPECT_THAT(recalled.broken(), ElementsAre("completion"));
    EXPECT_EQ(recalled.count(EventKind::return_alone), 0U);
    expect_home_one_after_another(recalled, team);
  }
}

}  // namespace
}  // namespace skein::hil
