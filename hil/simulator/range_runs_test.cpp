// SPDX-License-Identifier: Apache-2.0
// Missions that outlast the ranges of their vehicles.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"
#include "skein/hil/judged_runs.hpp"
#include "skein/hil/team_mission.hpp"

namespace skein::hil {
namespace {

/// Each vehicle with a range of its own; some are recovered anywhere.
TeamMission short_of_range(configuration::Scenario scenario, std::uint64_t seed) {
  Random random{seed};
  scenario.wind.speed_mps = random.uniform(0.0, 5.0);
  scenario.wind.from_rad = random.uniform(-kPi, kPi);
  scenario.wind.gust_mps = random.uniform(0.0, 1.0);
  scenario.radio.loss_ratio = random.uniform(0.0, 0.1);
  TeamMission mission = team_mission(scenario);
  mission.seed = seed;
  mission.heeds_wind = true;
  for (SimulatedVehicle& v : mission.vehicles) {
    v.spec.range_m = random.uniform(1500.0, 6000.0);
    if (random.chance(0.3)) v.spec.recovery = Recovery::anywhere;
  }
  return mission;
}

TEST(RangeRuns, WhoseRangeEndsHasLandedByThen) {
  const auto scenario =
      configuration::load_scenario(std::string{SKEIN_SOURCE_DIR} + "/scenarios/faults-8.yaml");
  ASSERT_TRUE(scenario) << scenario.error().message;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    const TeamMission mission = short_of_range(*scenario, seed);
    const JudgedRun run = fly_judged(mission, limits_of(scenario->expect));
    for (const auto& check : run.broken) {
      EXPECT_EQ(check.name, "completion") << seed << ": " << check.violations.front().sentence;
    }
    if (run.sites_done) continue;
    EXPECT_LT(run.result.ended_at, Instant{} + mission.duration_max) << seed;
    for (const VehicleEnd& end : run.result.vehicles) {
      EXPECT_TRUE(end.landed) << seed << ": U" << end.vehicle.value;
      EXPECT_GT(end.range_left_m, -2000.0) << seed << ": U" << end.vehicle.value;
    }
  }
}

}  // namespace
}  // namespace skein::hil
