// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/judged_runs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "skein/checks/flown.hpp"
#include "skein/hil/team_mission.hpp"

namespace skein::hil {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Not;

configuration::Scenario small() {
  auto scenario =
      configuration::load_scenario(std::string{SKEIN_SOURCE_DIR} + "/scenarios/coalition-6.yaml");
  EXPECT_TRUE(scenario) << scenario.error().message;
  return *scenario;
}

JudgedRun fly(const configuration::Scenario& scenario, std::uint64_t seed,
              const std::string& faults = "none") {
  const auto mission = seeded_mission(scenario, seed, faults);
  EXPECT_TRUE(mission) << mission.error().message;
  return fly_judged(*mission, limits_of(scenario.expect));
}

std::vector<std::string> names(const JudgedRun& run) {
  std::vector<std::string> names;
  for (const auto& check : run.broken) names.push_back(check.name);
  return names;
}

TEST(JudgedRuns, TheSmallMissionHolds) {
  const auto run = fly(small(), 1);
  EXPECT_THAT(names(run), IsEmpty());
  EXPECT_TRUE(run.sites_done);
}

/// Missions with faults that broke something once: a hazard in the orbit of who waited, late; an
/// assessment before a delivery that another leader took for flown, perhaps; bids that came late; a
/// leader that was held, and replaced out of its reach; an assessment that a later round of the
/// deliveries had made too early; gusts beside a hazard that had just become known; a delivery
/// that the other ground station had granted.
TEST(JudgedRuns, WhatWasBrokenOnceHolds) {
  const auto scenario =
      configuration::load_scenario(std::string{SKEIN_SOURCE_DIR} + "/scenarios/faults-8.yaml");
  ASSERT_TRUE(scenario) << scenario.error().message;
  for (const std::uint64_t seed : {974579U, 976435U, 922946U, 954330U, 961985U, 1003067U, 1000151U,
                                   1000445U, 1101068U, 1109889U}) {
    EXPECT_THAT(names(fly(*scenario, seed, "mixed")), IsEmpty()) << seed;
  }
}

TEST(JudgedRuns, AMissionThatIsNotFinishedIsFound) {
  auto scenario = small();
  scenario.duration_max = std::chrono::seconds{20};
  const auto run = fly(scenario, 1);
  EXPECT_FALSE(run.sites_done);
  EXPECT_THAT(names(run), ElementsAre("completion"));
}

TEST(JudgedRuns, TheJudgesHoldAMissionToTheScenariosLimits) {
  auto scenario = small();
  scenario.expect.miss_distance_m = 0.0;
  EXPECT_THAT(names(fly(scenario, 1)), ElementsAre("deliveries"));
}

/// By a guard of clocks, and for no other missions.
TEST(JudgedRuns, TimesAreJudgedMoreKindlyWhereClocksDiffer) {
  const auto scenario = small();
  auto mission = seeded_mission(scenario, 1, "none");
  ASSERT_TRUE(mission);
  auto limits = limits_of(scenario.expect);
  checks::RunRecord record;
  (void)fly_judged(*mission, limits, {}, &record);
  double worst_s = 0.0;
  for (const auto& delivery : checks::deliveries_flown(record, limits)) {
    worst_s = std::max(worst_s, std::abs(delivery.time_error_s()));
  }
  ASSERT_GT(worst_s, 0.0);
  limits.arrival_s = 0.5 * worst_s;
  EXPECT_THAT(names(fly_judged(*mission, limits)), Contains("deliveries"));
  Fault& differs = mission->faults.emplace_back();
  differs.what =
      ClockOff{mission->vehicles.front().spec.id, {}};  // by nothing: it is flown as before
  EXPECT_THAT(names(fly_judged(*mission, limits)), Not(Contains("deliveries")));
}

TEST(JudgedRuns, MissionsOfOneAirspeedInWindHold) {
  for (const std::string name : {"coalition-6", "hil-planes-2"}) {
    auto scenario = configuration::load_scenario(std::string{SKEIN_SOURCE_DIR} + "/scenarios/" +
                                                 name + ".yaml");
    ASSERT_TRUE(scenario) << scenario.error().message;
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      SCOPED_TRACE(name + ", seed " + std::to_string(seed));
      auto mission = seeded_mission(*scenario, seed, "none");
      ASSERT_TRUE(mission) << mission.error().message;
      const double share = 0.04 * static_cast<double>(seed % 6);
      mission->wind.steady_mps = share * scenario->vehicles.front().spec.cruise_speed_mps *
                                 unit_vector(0.8 * static_cast<double>(seed));
      mission->heeds_wind = true;
      std::size_t windward = 0;
      TeamObserver observer;
      observer.plan = [&windward](VehicleId, const mission::FlightPlan& plan, Instant) {
        windward += plan.timed.has_wind() ? 1 : 0;
      };
      const JudgedRun run = fly_judged(*mission, limits_of(scenario->expect), observer);
      for (const auto& check : run.broken) {
        ADD_FAILURE() << check.name << ": " << check.violations.front().sentence;
      }
      EXPECT_GT(windward, 0U);
    }
  }
}

TEST(JudgedRuns, ASeriesIsTheSameForAnyNumberOfThreads) {
  auto scenario = small();
  scenario.wind.gust_mps = 1.0;
  scenario.radio.loss_ratio = 0.2;
  std::size_t told = 0;
  const auto alone = fly_series(scenario, {"none", 5, 6, 1}, [&](const JudgedRun&) { ++told; });
  const auto shared = fly_series(scenario, {"none", 5, 6, 3});
  EXPECT_EQ(told, 6U);
  ASSERT_EQ(alone.size(), 6U);
  ASSERT_EQ(shared.size(), 6U);
  for (std::size_t i = 0; i < alone.size(); ++i) {
    EXPECT_EQ(alone[i].seed, 5 + i);
    EXPECT_EQ(alone[i].seed, shared[i].seed);
    EXPECT_EQ(alone[i].result.ended_at, shared[i].result.ended_at);
    EXPECT_EQ(alone[i].result.messages, shared[i].result.messages);
    EXPECT_EQ(names(alone[i]), names(shared[i]));
  }
}

}  // namespace
}  // namespace skein::hil
