// SPDX-License-Identifier: Apache-2.0
// Missions in which the operator calls off landings: who came down climbs back through the layers
// of others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <set>
#include <string>
#include <vector>

#include "skein/base/random.hpp"
#include "skein/hil/judged_runs.hpp"
#include "skein/hil/team_mission.hpp"

namespace skein::hil {
namespace {

using mission::CommandKind;
using namespace std::chrono_literals;

constexpr double kAirborne_m = 20.0;

/// Up to four are ordered down, each once or twice, and soon told something else.
TeamMission with_landings_called_off(configuration::Scenario scenario, std::uint64_t seed) {
  Random random{seed};
  for (auto& decision : scenario.operator_decisions) {
    decision.not_before = Instant{} + 200s;  // the mission lasts
  }
  TeamMission mission = team_mission(scenario);
  mission.seed = seed;
  const std::size_t landings = 1 + random.index(4);
  for (std::size_t n = 0; n < landings; ++n) {
    const VehicleId whom = mission.vehicles[random.index(mission.vehicles.size())].spec.id;
    const Instant at = Instant{} + from_seconds(random.uniform(1.0, 150.0));
    const Instant down_at = at + from_seconds(random.uniform(20.0, 40.0));
    const Instant off_at = down_at + from_seconds(random.uniform(5.0, 80.0));
    static constexpr std::array kInstead{CommandKind::hold, CommandKind::return_home,
                                         CommandKind::resume};
    const CommandKind instead = kInstead.at(random.index(kInstead.size()));
    mission.faults.push_back({{.not_before = at}, {}, Ordered{whom, CommandKind::return_home}});
    mission.faults.push_back({{.not_before = down_at}, {}, Ordered{whom, CommandKind::land}});
    mission.faults.push_back({{.not_before = off_at}, {}, Ordered{whom, instead}});
  }
  return mission;
}

TEST(WaveOffRuns, WhoClimbsBackKeepsSeparate) {
  const auto scenario =
      configuration::load_scenario(std::string{SKEIN_SOURCE_DIR} + "/scenarios/faults-8.yaml");
  ASSERT_TRUE(scenario) << scenario.error().message;
  // Those broke while who was called off climbed straight back.
  std::vector<std::uint64_t> seeds{1440, 1702, 2430};
  for (std::uint64_t seed = 1; seed <= 20; ++seed) seeds.push_back(seed);
  int called_off = 0;
  for (const std::uint64_t seed : seeds) {
    std::set<VehicleId> landing;
    TeamObserver watcher;
    watcher.track = [&](VehicleId who, const VehicleState& state, const mission::FlightPlan& plan) {
      if (plan.lands) {
        landing.insert(who);
      } else if (landing.erase(who) > 0 && state.z_m > kAirborne_m) {
        ++called_off;
      }
    };
    const TeamMission mission = with_landings_called_off(*scenario, seed);
    const JudgedRun run = fly_judged(mission, limits_of(scenario->expect), watcher);
    for (const auto& check : run.broken) {
      if (check.name == "completion") continue;
      ADD_FAILURE() << seed << ": " << check.name << ": " << check.violations.front().sentence;
    }
  }
  EXPECT_GT(called_off, 5) << "or nothing is tried here";
}

}  // namespace
}  // namespace skein::hil
