// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "skein/base/random.hpp"
#include "skein/hil/judged_runs.hpp"
#include "skein/hil/team_mission.hpp"

/// Vehicles that were given one height by mistake watch their separation in flight; the check of
/// recordings judges it. And those in layers are never warned of.
namespace skein::hil {
namespace {

using mission::EventKind;

constexpr double kLayer_m = 80.0;

VehicleSpec spec(std::uint16_t id, Airframe airframe) {
  VehicleSpec v;
  v.id = VehicleId{id};
  v.airframe = airframe;
  const bool copter = airframe == Airframe::copter;
  v.cruise_speed_mps = copter ? 10.0 : 25.0;
  v.speed_min_mps = copter ? 0.0 : 19.0;
  v.speed_max_mps = copter ? 15.0 : 31.0;
  v.turn_radius_m = copter ? 40.0 : 60.0;
  v.heading_gain_per_s = 1.5;
  v.range_m = 30'000.0;
  v.height_m = kLayer_m;
  if (copter) v.capabilities.add(TaskKind::survey);
  v.sensor_radius_m = 100.0;
  return v;
}

SimulatedVehicle towards(std::uint16_t id, Airframe airframe, const Vec2& from, const Vec2& to) {
  const Vec2 way = to - from;
  SimulatedVehicle v;
  v.spec = spec(id, airframe);
  v.start = {from.x(), from.y(), std::atan2(way.y(), way.x())};
  v.search = {to};
  v.body = airframe == Airframe::copter ? Body::multirotor : Body::heading_dynamics;
  return v;
}

TeamMission mission_of(std::vector<SimulatedVehicle> vehicles, bool watched) {
  TeamMission team;
  team.vehicles = std::move(vehicles);
  Site site;  // that nobody finds
  site.id = SiteId{1};
  site.position = {50'000.0, 0.0};
  team.sites = {site};
  team.radio.range_m = 5000.0;
  team.wind.gust_mps = 0.5;
  team.duration_max = std::chrono::seconds{110};
  if (!watched) team.protocol.separation_look_ahead = {};
  return team;
}

struct Watched {
  bool separation_held = true;
  std::map<EventKind, int> events;
  std::map<VehicleId, double> highest_m;
  std::map<VehicleId, double> last_m;
  double off_m = 0.0;  ///< from where a plan has it, greatest
  std::string trace;
};

Watched fly(const TeamMission& team) {
  Watched seen;
  TeamObserver watcher;
  watcher.event = [&](const mission::MissionEvent& event) {
    ++seen.events[event.kind()];
    seen.trace += trace_line(event) + "\n";
  };
  watcher.track = [&](VehicleId id, const VehicleState& state, const mission::FlightPlan& plan) {
    seen.highest_m[id] = std::max(seen.highest_m[id], state.z_m);
    seen.last_m[id] = state.z_m;
    if (plan.number == 0 || state.time < at_seconds(60)) return;
    const Pose2 pose = plan.timed.pose_at(state.time);
    seen.off_m = std::max(seen.off_m, (Vec2{state.x_m, state.y_m} - pose.position()).norm());
  };
  checks::Limits limits;
  limits.separation_horizontal_m = 20.0;
  limits.separation_vertical_m = 5.0;
  const auto run = fly_judged(team, limits, watcher);
  seen.separation_held = std::ranges::none_of(
      run.broken, [](const checks::CheckResult& check) { return check.name == "separation"; });
  return seen;
}

class OneLayer : public ::testing::TestWithParam<Airframe> {
 protected:
  [[nodiscard]] static std::vector<SimulatedVehicle> crossing() {
    if (GetParam() == Airframe::copter) {  // they leave their take-off to the east
      return {towards(1, Airframe::copter, {-250.0, -40.0}, {600.0, 96.0}),
              towards(2, Airframe::copter, {-250.0, 40.0}, {600.0, -96.0})};
    }
    return {towards(1, Airframe::plane, {-800.0, 0.0}, {800.0, 0.0}),
            towards(2, Airframe::plane, {800.0, 3.0}, {-800.0, 3.0})};
  }
};

TEST_P(OneLayer, TheWatchKeepsWhatIsBrokenWithoutIt) {
  const Watched without = fly(mission_of(crossing(), false));
  EXPECT_FALSE(without.separation_held);
  EXPECT_EQ(without.events.count(EventKind::separation_warning), 0U);

  const Watched with = fly(mission_of(crossing(), true));
  EXPECT_TRUE(with.separation_held) << with.trace;
  EXPECT_GE(with.events.at(EventKind::separation_warning), 2) << "each tells of the other";
  EXPECT_EQ(with.events.at(EventKind::separation_restored),
            with.events.at(EventKind::separation_warning));
  EXPECT_LT(with.highest_m.at(VehicleId{1}), kLayer_m + 2.0);
  EXPECT_GT(with.highest_m.at(VehicleId{2}), kLayer_m + 6.0);
  EXPECT_NEAR(with.last_m.at(VehicleId{2}), kLayer_m, 1.0);
  EXPECT_LT(with.off_m, 15.0) << "path and times stay";
}

TEST_P(OneLayer, TheSameMissionIsTheSame) {
  EXPECT_EQ(fly(mission_of(crossing(), true)).trace, fly(mission_of(crossing(), true)).trace);
}

INSTANTIATE_TEST_SUITE_P(Airframes, OneLayer, ::testing::Values(Airframe::plane, Airframe::copter));

TEST(SeparationRuns, PlanesThatCrossInOneLayerAreKeptApart) {
  Random random{7};
  int broken_without = 0;
  for (int i = 0; i < 12; ++i) {
    SCOPED_TRACE(i);
    const auto from = [&] { return Vec2{900.0 * unit_vector(random.uniform(-3.1, 3.1))}; };
    const Vec2 first = from();
    Vec2 second = from();
    while ((first - second).norm() < 300.0) second = from();
    const Vec2 off{random.uniform(-10.0, 10.0), random.uniform(-10.0, 10.0)};
    const std::vector<SimulatedVehicle> both{towards(1, Airframe::plane, first, -1.2 * first + off),
                                             towards(2, Airframe::plane, second, -1.2 * second)};
    const Watched without = fly(mission_of(both, false));
    broken_without += without.separation_held ? 0 : 1;
    const Watched with = fly(mission_of(both, true));
    EXPECT_TRUE(with.separation_held) << with.trace;
  }
  EXPECT_GT(broken_without, 6);
}

TEST(SeparationRuns, InShippedScenariosNobodyIsWarned) {
  for (const char* const name : {"coalition-6", "coalition-32", "mixed-6", "hil-planes-2"}) {
    const auto scenario = configuration::load_scenario(std::string{SKEIN_SOURCE_DIR} +
                                                       "/scenarios/" + name + ".yaml");
    ASSERT_TRUE(scenario) << scenario.error().message;
    const auto team = seeded_mission(*scenario, 1, "none");
    ASSERT_TRUE(team) << team.error().message;
    const Watched seen = fly(*team);
    EXPECT_TRUE(seen.events.contains(EventKind::coalition_formed)) << name;
    EXPECT_FALSE(seen.events.contains(EventKind::separation_warning)) << name << seen.trace;
  }
}

}  // namespace
}  // namespace skein::hil
