// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include "skein/base/random.hpp"
#include "skein/hil/judged_runs.hpp"
#include "skein/hil/team_mission.hpp"

/// Aircraft that are not of the team fly past missions of it: the minima are kept, or whoever does
/// not keep them has told so before; and the members keep apart from each other all the while.
namespace skein::hil {
namespace {

using mission::EventKind;

/// Of one vehicle and one aircraft.
struct Encounter {
  bool told_no = false;  ///< that the minimum will not be kept
  double least_vertical_m = std::numeric_limits<double>::infinity();  ///< while near to the side
};

struct Flown {
  std::map<VehicleId, Encounter> met;
  std::map<VehicleId, double> lowest_m;
  std::map<VehicleId, double> last_m;
  int warnings = 0;
  int gave_way = 0;
  int cleared = 0;
  bool separated = true;
  std::string broken;
  std::string trace;
};

Flown fly(const TeamMission& team) {
  Flown flown;
  TeamObserver watcher;
  watcher.event = [&](const mission::MissionEvent& event) {
    flown.trace += trace_line(event) + "\n";
    if (const auto* warning = std::get_if<mission::event::TrafficWarning>(&event.body)) {
      ++flown.warnings;
      flown.gave_way += warning->gives_way ? 1 : 0;
      flown.met[event.vehicle].told_no |= !warning->gives_way;
    } else if (event.kind() == EventKind::traffic_clear) {
      ++flown.cleared;
    }
  };
  watcher.track = [&](VehicleId id, const VehicleState& state, const mission::FlightPlan&) {
    flown.last_m[id] = state.z_m;
    const auto lowest = flown.lowest_m.try_emplace(id, state.z_m).first;
    lowest->second = std::min(lowest->second, state.z_m);
    for (const auto& one : team.aircraft) {
      const auto there = place_of(one, state.time);
      if (!there) continue;
      const double side_m = (there->position - Vec2{state.x_m, state.y_m}).norm();
      const double above_m = std::abs(there->height_m - state.z_m);
      if (side_m >= team.traffic.horizontal_m) continue;
      Encounter& met = flown.met[id];
      met.least_vertical_m = std::min(met.least_vertical_m, above_m);
      if (above_m >= team.traffic.vertical_m || met.told_no) continue;
      ADD_FAILURE() << "vehicle " << id.value << " is " << side_m << " m beside and " << above_m
                    << " m from it in height at " << to_seconds(state.time.time_since_epoch());
      met.told_no = true;  // once
    }
  };
  checks::Limits limits;
  limits.separation_horizontal_m = 20.0;
  limits.separation_vertical_m = 5.0;
  const auto run = fly_judged(team, limits, watcher);
  for (const auto& check : run.broken) {
    flown.broken += check.name + " ";
    flown.separated = flown.separated && check.name != "separation";
  }
  return flown;
}

TeamMission mission_of(const std::string& name, std::uint64_t seed) {
  const auto scenario =
      configuration::load_scenario(std::string{SKEIN_SOURCE_DIR} + "/scenarios/" + name + ".yaml");
  EXPECT_TRUE(scenario.ok());
  auto team = seeded_mission(*scenario, seed, "none");
  EXPECT_TRUE(team.ok());
  team->protocol.separation_horizontal_m = 20.0;
  return *team;
}

/// Past where the team works, at some time, from anywhere.
configuration::PassingAircraft passing(Random& random, std::uint32_t address) {
  configuration::PassingAircraft one;
  one.address = address;
  one.speed_mps = random.uniform(30.0, 90.0);
  const Vec2 by{random.uniform(-1500.0, 1500.0), random.uniform(-1500.0, 1500.0)};
  const Vec2 way = unit_vector(random.uniform(-3.14, 3.14));
  one.from_m = by - one.speed_mps * random.uniform(30.0, 110.0) * way;
  one.to_m = by + 12'000.0 * way;
  one.height_m = random.uniform(50.0, 500.0);
  return one;
}

class PassingAircraftRuns : public ::testing::TestWithParam<int> {};

TEST_P(PassingAircraftRuns, TheMinimaAreKeptOrItIsToldAndTheTeamKeepsApart) {
  const auto seed = static_cast<std::uint64_t>(GetParam());
  Random random{seed};
  TeamMission team = mission_of(seed % 2 == 0 ? "coalition-6" : "mixed-6", seed);
  team.aircraft.push_back(passing(random, 0x4ca2d6));
  if (random.chance(0.3)) team.aircraft.push_back(passing(random, 0x40621d));
  const Flown flown = fly(team);
  EXPECT_TRUE(flown.separated) << flown.trace;
  for (const auto& [id, lowest_m] : flown.lowest_m) {
    const auto vehicle = std::ranges::find_if(
        team.vehicles, [id](const SimulatedVehicle& v) { return v.spec.id == id; });
    if (vehicle->spec.is_copter()) continue;  // from the ground up
    EXPECT_GE(lowest_m, team.traffic.floor_m - 1.0);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, PassingAircraftRuns, ::testing::Range(1, 17));

/// Six planes in layers of 10 m that circle one place, under an aircraft that takes their room.
TeamMission stacked(double aircraft_m) {
  TeamMission team;
  for (std::uint16_t i = 1; i <= 6; ++i) {
    SimulatedVehicle v;
    v.spec.id = VehicleId{i};
    v.spec.cruise_speed_mps = 25.0;
    v.spec.speed_min_mps = 19.0;
    v.spec.speed_max_mps = 31.0;
    v.spec.turn_radius_m = 60.0;
    v.spec.heading_gain_per_s = 1.5;
    v.spec.range_m = 30'000.0;
    v.spec.height_m = 90.0 + 10.0 * i;
    v.spec.sensor_radius_m = 100.0;
    v.start = {-300.0 + 40.0 * i, 20.0 * i, 0.3 * i};
    v.search = {{300.0, 0.0}};
    team.vehicles.push_back(v);
  }
  Site site;  // that nobody finds
  site.id = SiteId{1};
  site.position = {50'000.0, 0.0};
  team.sites = {site};
  team.radio.range_m = 5000.0;
  team.radio.ground_range_m = 20'000.0;
  team.duration_max = std::chrono::seconds{330};
  configuration::PassingAircraft one;
  one.address = 0x4ca2d6;
  one.from_m = {-12'000.0, 100.0};
  one.to_m = {12'000.0, 100.0};
  one.speed_mps = 60.0;
  one.height_m = aircraft_m;
  team.aircraft = {one};
  return team;
}

TEST(TrafficRuns, AStackComesDownWithoutMeetingAndGoesBackUp) {
  // All are to be at 80 m or lower: six layers of 10 m have no room between there and the floor,
  // but they need none where they do not pass near each other.
  const Flown flown = fly(stacked(240.0));
  EXPECT_TRUE(flown.separated) << flown.broken << flown.trace;
  EXPECT_GE(flown.gave_way, 6) << flown.trace;
  for (const auto& [id, last_m] : flown.last_m) {
    EXPECT_NEAR(last_m, 90.0 + 10.0 * id.value, 1.5) << "back in its layer";
    EXPECT_LT(flown.lowest_m.at(id), 85.0);
  }
  EXPECT_GE(flown.cleared, 6);
}

TEST(TrafficRuns, TheSameMissionIsTheSame) {
  EXPECT_EQ(fly(stacked(240.0)).trace, fly(stacked(240.0)).trace);
}

TEST(TrafficRuns, OfWhatPassesHighNobodyIsWarned) {
  const Flown flown = fly(stacked(600.0));
  EXPECT_EQ(flown.warnings, 0) << flown.trace;
}

}  // namespace
}  // namespace skein::hil
