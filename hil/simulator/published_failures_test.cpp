// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "skein/base/random.hpp"
#include "skein/hil/formation_runs.hpp"
#include "skein/hil/judged_runs.hpp"
#include "skein/hil/team_mission.hpp"

/// What went wrong in published planners of swarms, as missions of this one: docs/failures.md.
namespace skein::hil {
namespace {

using std::chrono::seconds;
using ::testing::Contains;
using ::testing::IsEmpty;
using ::testing::Not;

configuration::Scenario scenario(const std::string& name) {
  auto loaded =
      configuration::load_scenario(std::string{SKEIN_SOURCE_DIR} + "/scenarios/" + name + ".yaml");
  EXPECT_TRUE(loaded) << loaded.error().message;
  return *loaded;
}

/// Five multirotors whose ways cross in change 2.
TeamMission formation(std::vector<std::string> script, std::vector<Fault> faults) {
  auto mission = seeded_mission(scenario("formation-5"), 1, "none");
  EXPECT_TRUE(mission);
  mission->formation->script = std::move(script);
  mission->faults = std::move(faults);
  return *mission;
}

const std::vector<std::string> kCrossing{"take-off", "rally", "form column spacing 5 at 0 60 20",
                                         "rally", "land"};

/// Planes are in layers of 10 m.
std::vector<std::string> broken_in(const TeamMission& mission) {
  checks::Limits limits;
  limits.separation_horizontal_m = 20.0;
  limits.separation_vertical_m = 5.0;
  std::vector<std::string> names;
  for (const auto& check : fly_judged(mission, limits).broken) names.push_back(check.name);
  return names;
}

FormationRun fly(const TeamMission& mission) {
  auto run = fly_formation(mission);
  EXPECT_TRUE(run);
  for (const auto& v : run->violations) {
    ADD_FAILURE() << fmt::format("{:.2f} s, {}: {}", to_seconds(v.time), v.check, v.sentence);
  }
  return *run;
}

Fault ends(VehicleId node, double after_s, std::optional<Duration> lasts = std::nullopt) {
  return {{.change = 2, .after = from_seconds(after_s)}, lasts, ProgramsEnd{{node}}};
}

Fault silent(std::vector<VehicleId> who, double after_s) {
  return {{.change = 2, .after = from_seconds(after_s)},
          std::nullopt,
          radio::silence(std::move(who), radio::Cut::Kind::both_ways)};
}

const std::vector<VehicleId> kEverybody{kGroundStation, {1}, {2}, {3}, {4}, {5}};

/// EGO-Planner-v2, issue 59: a new plan is tried before it is asked whether there is time to brake.
TEST(PublishedFailures, BrakingWaitsForNoPlan) {
  for (double after_s = 0.5; after_s <= 9.0; after_s += 0.5) {
    const auto run = fly(formation(kCrossing, {ends({3}, after_s), ends(kGroundStation, after_s)}));
    EXPECT_GT(run.least_m, 2.0) << "lost after " << after_s << " s, and nobody plans any more";
  }
}

/// EGO-Planner-v2, issue 60: the last quarter of a plan is not looked at, since a new one comes
/// before it. Here none comes: nobody hears anybody any more.
TEST(PublishedFailures, APlanIsFlownToItsVeryEndAsItWasChecked) {
  for (double after_s = 0.0; after_s <= 9.0; after_s += 1.0) {
    EXPECT_GT(fly(formation(kCrossing, {silent(kEverybody, after_s)})).least_m, 2.0) << after_s;
  }
  const auto last = fly(formation(kCrossing, {ends(kGroundStation, 2.0)}));
  EXPECT_EQ(last.reason, "the ground station is lost") << "everybody is in its place";
}

/// EGO-Planner-v2, issue 65: two that stopped because of each other are an obstacle to each other's
/// plans for ever, since what watches lets them be nearer than what plans.
TEST(PublishedFailures, WhoStoppedBecauseOfEachOtherIsLedOn) {
  std::size_t done = 0;
  std::size_t refused = 0;
  for (const std::uint64_t seed : {14U, 20U, 23U, 40U, 41U, 53U, 63U, 84U, 117U, 122U}) {
    const auto mission = seeded_mission(scenario("formation-5"), seed, "mixed");
    ASSERT_TRUE(mission);
    const auto run = fly(*mission);
    done += run.script_done ? 1 : 0;
    refused += run.reason.find("come within") != std::string::npos ? 1 : 0;
  }
  EXPECT_GE(done, 7U) << "in all ten two rest so near to each other";
  EXPECT_LE(refused, 1U) << "for another reason";
}

/// Swarm-Formation, issue 34: a plan that fails after a stop takes the goal with it, and the
/// vehicle waits for a new order.
TEST(PublishedFailures, AnOrderOutlastsThePlansThatFail) {
  for (const double after_s : {1.0, 3.0, 5.0, 7.0}) {
    const auto run = fly(formation(kCrossing, {ends({3}, after_s, seconds{30})}));
    EXPECT_TRUE(run.script_done) << "back after 30 s: " << run.reason;
  }
}

/// Swarm-Formation, issue 36: a plan begins where the vehicle was when planning began, and its
/// reference jumps back there.
TEST(PublishedFailures, NoReferenceJumps) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    auto mission = seeded_mission(scenario("formation-5"), seed, "mixed");
    ASSERT_TRUE(mission);
    mission->gust_error_m = 0.0;
    EXPECT_LT(fly(*mission).farthest_m, 0.3) << "from its reference, seed " << seed;
  }
}

/// RACER, issue 45: who hovers flies no plan, and is no obstacle to the plans of others.
TEST(PublishedFailures, WhoRestsIsKeptClearOf) {
  // Two stay at the rally, in the middle of the others' ways from one side of it to the other.
  const std::vector<std::string> across{"take-off",
                                        "rally",
                                        "form line_abreast spacing 5 at 0 30 20 places 3",
                                        "form line_abreast spacing 5 at 0 -30 20 places 3",
                                        "rally",
                                        "land"};
  EXPECT_TRUE(fly(formation(across, {})).script_done);
  EXPECT_GT(fly(formation(across, {silent({{4}, {5}}, 20.0)})).least_m, 2.0);
}

/// RACER, issue 49: while a new plan is made, the old one is flown on that is known to be unsafe.
/// Here plans take up to three seconds, and hazards appear on the ways.
TEST(PublishedFailures, APlanThatIsBarredIsNotFlownOnWhileTheNextIsMade) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto mission = seeded_mission(scenario("coalition-6"), seed, "planner,hazards");
    ASSERT_TRUE(mission) << mission.error().message;
    EXPECT_THAT(broken_in(*mission), IsEmpty()) << "seed " << seed;
  }
}

/// adaptive_swarm, issue 5: who dodges a stranger at its place in the formation dodges into the way
/// of another, since what dodges knows of no plan.
TEST(PublishedFailures, WhoGivesWayToAStrangerKeepsApartFromItsTeam) {
  Random random{5};
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    auto mission = seeded_mission(scenario("coalition-6"), seed, "none");
    ASSERT_TRUE(mission);
    // Over the very place that the coalition arrives at, and at its heights.
    configuration::PassingAircraft stranger;
    stranger.address = 0x4ca2d6;
    stranger.speed_mps = random.uniform(30.0, 80.0);
    const Vec2 way = unit_vector(random.uniform(-3.0, 3.0));
    stranger.from_m = mission->sites.front().position - random.uniform(1200.0, 2400.0) * way;
    stranger.to_m = mission->sites.front().position + 6000.0 * way;
    stranger.height_m = random.uniform(100.0, 160.0);
    mission->aircraft = {stranger};
    EXPECT_THAT(broken_in(*mission), Not(Contains("separation"))) << "seed " << seed;
  }
}

/// adaptive_swarm, issue 8: between the distance at which others are heeded and the one at which
/// they collide there is less than messages take. Here they take seconds, and half are lost.
TEST(PublishedFailures, NoDelayMakesABreach) {
  for (const double delay_s : {0.5, 1.0, 2.0}) {
    const Fault late{{.change = 2},
                     seconds{60},
                     radio::Disturbance{0.5, from_seconds(delay_s), from_seconds(delay_s)}};
    const auto run = fly(formation(kCrossing, {late}));
    EXPECT_GT(run.least_m, 2.0) << delay_s;
    EXPECT_TRUE(run.script_done) << run.reason;
  }
}

}  // namespace
}  // namespace skein::hil
