// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/team_simulator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/codec/codec.hpp"
#include "skein/hil/fault_profiles.hpp"

namespace skein::hil {
namespace {

using mission::EventKind;
using mission::MissionEvent;

VehicleSpec spec(std::uint16_t id, std::initializer_list<TaskKind> kinds, std::uint8_t loads) {
  VehicleSpec v;
  v.id = VehicleId{id};
  v.cruise_speed_mps = 30.0;
  v.speed_min_mps = 24.0;
  v.speed_max_mps = 36.0;
  v.turn_radius_m = 60.0;
  v.heading_gain_per_s = 1.5;
  v.range_m = 20'000.0;
  for (const TaskKind kind : kinds) v.capabilities.add(kind);
  v.sensor_radius_m = 150.0;
  v.assess_radius_m = 150.0;
  v.loads = loads;
  v.final_approach_m = 100.0;
  v.height_m = 100.0 + 10.0 * id;
  return v;
}

/// A scout finds a site 600 m to its east; three carriers deliver at once, two vehicles assess.
TeamMission small_mission() {
  TeamMission team;
  team.vehicles = {
      {spec(1, {TaskKind::survey, TaskKind::assess}, 0), {-600, 0, 0}, {{0, 100}}},
      {spec(2, {TaskKind::deliver}, 1), {-300, -500, 1}, {{-300, -500}}},
      {spec(3, {TaskKind::deliver}, 1), {300, -500, 2}, {{300, -500}}},
      {spec(4, {TaskKind::deliver}, 1), {300, 500, 3}, {{300, 500}}},
      {spec(5, {TaskKind::assess}, 0), {-300, 500, -1}, {{-300, 500}}},
  };
  Site site;
  site.id = SiteId{1};
  site.survey.dwell = from_seconds(5);
  site.deliveries = {{radians(0), {}}, {radians(120), {}}, {radians(-120), {}}};
  site.assess_wait = from_seconds(5);
  site.assessments = {{radians(0), from_seconds(6)}, {radians(180), from_seconds(6)}};
  team.sites = {site};
  team.decisions = {{SiteId{1}, true, from_seconds(2), Instant{}}};
  team.wind.steady_mps = {2.0, 1.0};
  team.duration_max = from_seconds(200);
  return team;
}

struct Flown {
  TeamResult result;
  std::vector<MissionEvent> events;
  std::string trace;

  [[nodiscard]] std::vector<MissionEvent> of(EventKind kind) const {
    std::vector<MissionEvent> some;
    std::copy_if(events.begin(), events.end(), std::back_inserter(some),
                 [kind](const MissionEvent& e) { return e.kind() == kind; });
    return some;
  }
  [[nodiscard]] std::vector<MissionEvent> done(TaskKind kind) const {
    auto some = of(EventKind::task_done);
    std::erase_if(some, [kind](const MissionEvent& e) { return e.task.kind != kind; });
    return some;
  }
};

Flown fly(const TeamMission& team) {
  Flown flown;
  TeamObserver observer;
  observer.event = [&](const MissionEvent& e) {
    flown.events.push_back(e);
    flown.trace += trace_line(e) + "\n";
  };
  observer.track = [&](VehicleId id, const VehicleState& s, const mission::FlightPlan& plan) {
    flown.trace += std::to_string(id.value) + " " + std::to_string(s.x_m) + " " +
                   std::to_string(s.y_m) + " " + std::to_string(plan.number) + "\n";
  };
  flown.result = simulate_team(team, observer);
  return flown;
}

TEST(TeamSimulator, TheSmallMissionIsFlownToItsEnd) {
  const auto flown = fly(small_mission());
  EXPECT_EQ(flown.result.sites_done, 1U) << flown.trace.substr(0, 4000);
  EXPECT_EQ(flown.result.protocol_errors, 0U);
  const auto deliveries = flown.done(TaskKind::deliver);
  ASSERT_EQ(deliveries.size(), 3U);
  for (const auto& e : deliveries) {
    EXPECT_LT(std::abs(to_seconds(e.time - deliveries[0].time)), 0.05) << "simultaneous";
  }
  const auto assessments = flown.done(TaskKind::assess);
  ASSERT_EQ(assessments.size(), 2U);
  for (const auto& e : assessments) {
    const Instant planned = std::get<mission::event::TaskDone>(e.body).planned;
    EXPECT_NEAR(to_seconds(planned), to_seconds(deliveries[0].time) + 5.0, 0.05)
        << "start, after the wait";
  }
}

/// With a carrier more than the site needs.
TeamMission mission_with_spare_carrier() {
  auto team = small_mission();
  team.vehicles.push_back({spec(6, {TaskKind::deliver}, 1), {-900, -700, 0.5}, {{-900, -700}}});
  return team;
}

TEST(TeamSimulator, WhoseBatteryFallsGivesItsTaskBackAndIsHomeBeforeItsReserve) {
  constexpr VehicleId kLow{3};
  auto team = mission_with_spare_carrier();
  const auto whole = fly(team);
  ASSERT_EQ(whole.result.sites_done, 1U);
  EXPECT_TRUE(whole.of(EventKind::range_spent).empty());
  const auto formed = whole.of(EventKind::coalition_formed);
  ASSERT_EQ(formed.size(), 1U);

  // On its way to its delivery, with enough left for the way home and not for the task.
  team.faults = {{{formed[0].time + from_seconds(4.0)}, std::nullopt, BatteryFalls{kLow, 23.5}}};
  std::optional<int> percent_at_home;
  TeamObserver observer;
  Flown flown;
  observer.event = [&](const MissionEvent& e) { flown.events.push_back(e); };
  observer.track = [&](VehicleId id, const VehicleState& s, const mission::FlightPlan&) {
    const int percent{s.battery_percent};
    EXPECT_EQ(percent == kBatteryNotTold, id != kLow);
    const double from_home_m =
        (s.position().horizontal() - team.vehicles[2].start.position()).norm();
    const bool returns = id == kLow && !flown.of(EventKind::range_spent).empty();
    if (returns && from_home_m < 30.0 && !percent_at_home) percent_at_home = percent;
  };
  flown.result = simulate_team(team, observer);

  const auto spent = flown.of(EventKind::range_spent);
  ASSERT_EQ(spent.size(), 1U);
  EXPECT_EQ(spent[0].vehicle, kLow);
  const auto& told = std::get<mission::event::RangeSpent>(spent[0].body);
  EXPECT_TRUE(told.by_battery && told.comes_home);
  EXPECT_GT(told.range_left_m, told.home_m);
  EXPECT_EQ(flown.result.sites_done, 1U);
  EXPECT_EQ(flown.result.protocol_errors, 0U);
  // No task forgotten, none flown twice, and none by who flies home.
  const auto deliveries = flown.done(TaskKind::deliver);
  std::set<std::uint8_t> which;
  for (const auto& e : deliveries) {
    EXPECT_NE(e.vehicle, kLow);
    EXPECT_TRUE(which.insert(e.task.index).second);
  }
  EXPECT_EQ(which.size(), 3U);
  EXPECT_EQ(flown.done(TaskKind::assess).size(), 2U);
  // It has come home with its reserve, and lands there.
  ASSERT_TRUE(percent_at_home);
  EXPECT_GE(*percent_at_home, 20);
  for (const auto& end : flown.result.vehicles) {
    if (end.vehicle != kLow) continue;
    EXPECT_LT((end.position - team.vehicles[2].start.position()).norm(), 200.0);
  }
}

/// Whenever it falls, and to whatever that is still enough for the way home.
TEST(TeamSimulator, WhoTurnsHomeInTimeIsThereBeforeItsReserve) {
  int returned = 0;
  for (std::uint16_t run = 0; run < 24; ++run) {
    auto team = mission_with_spare_carrier();
    const VehicleId low{static_cast<std::uint16_t>(1 + run % 6)};
    const int lap = run / 6;
    team.faults = {{{at_seconds(3.0 + 5.0 * lap + 0.37 * run)},
                    std::nullopt,
                    BatteryFalls{low, 23.5 + 0.5 * (run % 8)}}};
    std::optional<mission::event::RangeSpent> told;
    std::optional<int> percent_at_home;
    TeamObserver observer;
    observer.event = [&](const MissionEvent& e) {
      const auto* spent = std::get_if<mission::event::RangeSpent>(&e.body);
      if (spent == nullptr) return;
      EXPECT_EQ(e.vehicle, low);
      told = *spent;
    };
    observer.track = [&](VehicleId id, const VehicleState& s, const mission::FlightPlan&) {
      if (id != low || !told || percent_at_home) return;
      const auto& home = team.vehicles[low.value - 1U].start;
      const double away_m = (s.position().horizontal() - home.position()).norm();
      if (away_m < 30.0) percent_at_home = s.battery_percent;
    };
    (void)simulate_team(team, observer);
    const bool in_time = told && told->range_left_m > told->home_m;
    if (!in_time) continue;
    ++returned;
    ASSERT_TRUE(percent_at_home) << run;
    EXPECT_GE(*percent_at_home, 20) << run;
  }
  EXPECT_GT(returned, 12);
}

TEST(TeamSimulator, ASuccessorGoesOnWithWhatWasGrantedAndAllThatIsSaidFitsTheWire) {
  auto team = small_mission();
  // From so far away that there is time for a successor.
  for (std::size_t i = 1; i <= 3; ++i) {
    auto& start = team.vehicles[i].start;
    start.x_m *= 3.0;
    start.y_m *= 2.0;
    team.vehicles[i].search = {start.position()};
  }
  team.sites[0].assessments.clear();
  team.faults = {{{.role = Role::leader, .after = from_seconds(7)}, {}, ProgramsEnd{}}};
  std::vector<MissionEvent> events;
  std::vector<Instant> granted_times;
  std::size_t unsendable = 0;
  TeamObserver observer;
  observer.event = [&](const MissionEvent& e) { events.push_back(e); };
  observer.message = [&](const mission::Message& m) {
    unsendable += codec::encode(m).has_value() ? 0 : 1;
  };
  (void)simulate_team(team, observer);
  EXPECT_EQ(unsendable, 0U);
  const auto count = [&](EventKind kind) {
    return std::ranges::count(events, kind, [](const MissionEvent& e) { return e.kind(); });
  };
  EXPECT_EQ(count(EventKind::leader_replaced), 1);
  EXPECT_EQ(count(EventKind::authorisation_late), 0) << "nobody waits at a gate";
  EXPECT_EQ(count(EventKind::awarded), 1) << "the plan is not made anew";
  const auto delivered = std::ranges::count_if(events, [](const MissionEvent& e) {
    return e.kind() == EventKind::task_done && e.task.kind == TaskKind::deliver;
  });
  EXPECT_EQ(delivered, 3);
}

TEST(TeamSimulator, WhateverGoesWrongAllThatIsSaidFitsTheWire) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    auto team = small_mission();
    team.seed = seed;
    add_faults(team, fault_params("mixed", seed).value());
    std::size_t unsendable = 0;
    TeamObserver observer;
    observer.message = [&](const mission::Message& m) {
      unsendable += codec::encode(m).has_value() ? 0 : 1;
    };
    (void)simulate_team(team, observer);
    EXPECT_EQ(unsendable, 0U) << "seed " << seed;
  }
}

TEST(TeamSimulator, TheSameSeedGivesTheSameMissionByteForByte) {
  auto team = small_mission();
  team.radio.loss = 0.1;
  team.wind.gust_mps = 1.0;
  const auto once = fly(team);
  EXPECT_EQ(once.trace, fly(team).trace);
  team.seed = 2;
  EXPECT_NE(once.trace, fly(team).trace);
}

/// Where clocks may differ a vehicle takes all telemetry that comes to it.
TEST(TeamSimulator, OfTheTelemetryOfOneStepTheFirstTellsAVehicleAll) {
  for (const char* faults : {"none", "lossy", "partition", "crash", "hazards", "orders", "sites"}) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      auto team = small_mission();
      team.seed = seed;
      add_faults(team, *fault_params(faults, seed));
      const auto first = fly(team);
      team.faults.push_back({{}, {}, ClockOff{VehicleId{1}, Duration{}}});
      EXPECT_TRUE(fly(team).trace == first.trace) << faults << ", seed " << seed;
    }
  }
}

/// Slower than the protocol's 0.5 s: the first plan comes too late, and later rounds wait for it.
TEST(TeamSimulator, APlannerThatIsSlowerThanItsTimeIsWaitedFor) {
  for (const double takes_s : {0.56, 1.5, 3.0}) {
    TeamMission team = small_mission();
    team.allocation_takes = from_seconds(takes_s);
    const Flown flown = fly(team);
    EXPECT_EQ(flown.result.sites_done, 1U) << takes_s;
    EXPECT_EQ(flown.done(TaskKind::deliver).size(), 3U) << takes_s;
    const auto allocated = flown.of(EventKind::allocation_done);
    ASSERT_GE(allocated.size(), 2U) << takes_s;
    EXPECT_EQ(std::get<mission::event::AllocationDone>(allocated[0].body).took,
              team.allocation_takes);
    EXPECT_EQ(flown.of(EventKind::coalition_formed).size(), 1U) << takes_s;
  }
}

TEST(TeamSimulator, NothingIsDeliveredWithoutAnAuthorisation) {
  auto team = small_mission();
  team.decisions.clear();
  const auto flown = fly(team);
  EXPECT_TRUE(flown.done(TaskKind::deliver).empty());
  EXPECT_GT(flown.of(EventKind::authorisation_late).size(), 2U)
      << "and the plan is timed anew, again and again";
  EXPECT_EQ(flown.result.sites_done, 0U);
}

TEST(TeamSimulator, ALateAuthorisationIsForAPlanThatIsTimedAnew) {
  auto team = small_mission();
  team.decisions[0].not_before = at_seconds(60);
  const auto flown = fly(team);
  EXPECT_EQ(flown.result.sites_done, 1U);
  const auto deliveries = flown.done(TaskKind::deliver);
  ASSERT_EQ(deliveries.size(), 3U);
  for (const auto& delivery : deliveries) {
    EXPECT_GT(delivery.time, at_seconds(60));
    // The operator granted that very round before the approach began.
    const auto granted = flown.of(EventKind::authorised);
    EXPECT_TRUE(std::any_of(granted.begin(), granted.end(), [&](const MissionEvent& e) {
      return e.vehicle == kGroundStation && e.round == delivery.round && e.time < delivery.time;
    }));
  }
}

TEST(TeamSimulator, ARefusalEndsTheCoalition) {
  auto team = small_mission();
  team.decisions[0].grant = false;
  const auto flown = fly(team);
  EXPECT_TRUE(flown.done(TaskKind::deliver).empty());
  EXPECT_EQ(flown.of(EventKind::authorisation_requested).size(), 1U);
  EXPECT_GE(flown.of(EventKind::released).size(), 4U);
}

/// Vehicles 2, 3 and 4 fly to the north side by side for 3 km, from 10 s + 60 s on.
TeamMission given_routes() {
  auto team = small_mission();
  team.sites.clear();
  team.decisions.clear();
  RoutesOrdered order;
  order.begin_in = from_seconds(60);
  for (const std::uint16_t id : {std::uint16_t{2}, std::uint16_t{3}, std::uint16_t{4}}) {
    TimedPath timed;
    timed.speed_mps = 30.0;
    timed.path.start = {-900.0 + 300.0 * id, -600.0, kPi / 2.0};
    EXPECT_TRUE(timed.path.append(Segment{0.0, 3000.0}));
    order.routes.emplace(VehicleId{id}, timed);
  }
  team.faults = {{{.not_before = at_seconds(10)}, {}, order}};
  return team;
}

/// What each vehicle said last of its route.
std::map<VehicleId, mission::event::RouteAnswered> answers(const Flown& flown) {
  std::map<VehicleId, mission::event::RouteAnswered> newest;
  for (const auto& event : flown.of(EventKind::route_answered)) {
    newest[event.vehicle] = std::get<mission::event::RouteAnswered>(event.body);
  }
  return newest;
}

std::size_t vehicles_that_flew(const Flown& flown) {
  const auto all = flown.of(EventKind::route_answered);
  return static_cast<std::size_t>(std::ranges::count_if(all, [](const MissionEvent& e) {
    return std::get<mission::event::RouteAnswered>(e.body).state == mission::RouteState::flies;
  }));
}

TEST(TeamSimulator, RoutesOverTheAirSurviveLossAndNewStartsOfVehicleAndGroundStation) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    auto team = given_routes();
    team.seed = seed;
    team.radio.loss = 0.3;
    // One before the routes begin, one on its way; the ground station between the two.
    team.faults.push_back(
        {{.not_before = at_seconds(30)}, from_seconds(2), ProgramsEnd{.who = {VehicleId{2}}}});
    team.faults.push_back(
        {{.not_before = at_seconds(50)}, from_seconds(4), ProgramsEnd{.who = {kGroundStation}}});
    team.faults.push_back(
        {{.not_before = at_seconds(85)}, from_seconds(1), ProgramsEnd{.who = {VehicleId{3}}}});
    const auto flown = fly(team);
    const auto newest = answers(flown);
    ASSERT_EQ(newest.size(), 3U) << "seed " << seed;
    for (const auto& [id, answer] : newest) {
      EXPECT_EQ(answer.state, mission::RouteState::flown)
          << "seed " << seed << ", " << id.value << ", " << to_string(answer.why);
    }
    EXPECT_TRUE(flown.of(EventKind::routes_called_off).empty());
    for (const auto& event : flown.of(EventKind::route_answered)) {
      const auto& body = std::get<mission::event::RouteAnswered>(event.body);
      if (body.state != mission::RouteState::flown) continue;
      // 3 km, and twice the planning radius beyond.
      EXPECT_NEAR(to_seconds(event.time), 70.0 + (3000.0 + 2.0 * 66.0) / 30.0, 0.2);
    }
    EXPECT_EQ(flown.trace, fly(team).trace) << "seed " << seed;
  }
}

TEST(TeamSimulator, WhoCannotGoOnWithItsRouteAfterANewStartSaysSoAndTheOthersFlyOn) {
  auto team = given_routes();
  team.faults.push_back(
      {{.not_before = at_seconds(80)}, from_seconds(30), ProgramsEnd{.who = {VehicleId{3}}}});
  const auto newest = answers(fly(team));
  EXPECT_EQ(newest.at({2}).state, mission::RouteState::flown);
  EXPECT_EQ(newest.at({3}).state, mission::RouteState::left);
  EXPECT_EQ(newest.at({3}).why, mission::RouteObstacle::out_of_reach);
  EXPECT_EQ(newest.at({4}).state, mission::RouteState::flown);
}

TEST(TeamSimulator, RoutesThatNotAllHaveTakenNobodyFlies) {
  auto team = given_routes();
  team.faults.push_back(
      {{.not_before = at_seconds(9)}, from_seconds(70), radio::cut_off({VehicleId{4}})});
  const auto flown = fly(team);
  EXPECT_EQ(vehicles_that_flew(flown), 0U);
  const auto off = flown.of(EventKind::routes_called_off);
  ASSERT_EQ(off.size(), 1U);
  EXPECT_EQ(std::get<mission::event::RoutesCalledOff>(off[0].body).vehicle, VehicleId{4});
  EXPECT_EQ(answers(flown).at({2}).state, mission::RouteState::called_off);
}

/// The leader is lost in the moment of the refusal; who could relieve it, and the ground station,
/// start anew afterwards.
TEST(TeamSimulator, ARefusalOutlivesItsLeaderAndNewStarts) {
  auto team = small_mission();
  team.decisions[0].grant = false;
  team.protocol.cut_max = from_seconds(15);
  team.vehicles[4].spec.capabilities.add(TaskKind::survey);
  // Nobody is done before this one is reported.
  Site later = team.sites[0];
  later.id = SiteId{2};
  later.position = {5000.0, 5000.0};
  team.sites.push_back(later);
  team.reported[SiteId{2}] = at_seconds(195);
  const auto refusals = fly(team).of(EventKind::authorisation_refused);
  ASSERT_FALSE(refusals.empty());
  const Instant refused_at = refusals[0].time;
  team.faults = {{{.not_before = refused_at}, {}, ProgramsEnd{.who = {VehicleId{1}}}},
                 {{.not_before = refused_at + from_seconds(8)},
                  from_seconds(3),
                  ProgramsEnd{.who = {kGroundStation}}},
                 {{.not_before = refused_at + from_seconds(12)},
                  from_seconds(3),
                  ProgramsEnd{.who = {VehicleId{5}}}}};
  const auto flown = fly(team);
  for (const EventKind kind : {EventKind::relief_begun, EventKind::announced,
                               EventKind::authorisation_requested, EventKind::task_started}) {
    for (const auto& event : flown.of(kind)) {
      const bool again = event.task.site == SiteId{1} && event.time > refused_at + from_seconds(7);
      EXPECT_FALSE(again) << trace_line(event);
    }
  }
}

TEST(TeamSimulator, MessagesThatAreLostDelayTheMissionAndBreakNothing) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    auto team = small_mission();
    team.seed = seed;
    team.radio.loss = 0.3;
    const auto flown = fly(team);
    EXPECT_EQ(flown.result.sites_done, 1U) << "seed " << seed;
    EXPECT_EQ(flown.done(TaskKind::deliver).size(), 3U) << "seed " << seed;
  }
}

TEST(TeamSimulator, TooFewVehiclesInRangeMakeTheLeaderMonitor) {
  auto team = small_mission();
  team.vehicles[3].search = {{3000, 3000}};
  team.vehicles[3].start = {3000, 3000, 0};
  const auto flown = fly(team);
  EXPECT_EQ(flown.result.sites_done, 0U);
  EXPECT_GT(flown.of(EventKind::monitoring).size(), 5U);
  EXPECT_TRUE(flown.done(TaskKind::deliver).empty());
}

TEST(TeamSimulator, RelayOrbitsGatherThoseWhoFlyByOneAfterTheOther) {
  auto team = small_mission();
  team.duration_max = from_seconds(400);
  team.radio.range_m = team.protocol.radio_range_m = 1'000.0;
  // Those who deliver cross the leader's reach, and are never within it together.
  team.vehicles[1].start = {-1400, -300, 0};
  team.vehicles[1].search = {{0, -300}, {4000, -300}};
  team.vehicles[2].start = {0, -3700, kPi / 2};
  team.vehicles[2].search = {{300, -500}, {300, 4000}};
  team.vehicles[3].start = {6500, 300, kPi};
  team.vehicles[3].search = {{300, 500}, {-4000, 300}};
  const auto without = fly(team);
  EXPECT_EQ(without.result.sites_done, 0U);
  EXPECT_GT(without.of(EventKind::monitoring).size(), 20U);

  team.protocol.relay_orbit_m = 500.0;
  const auto with = fly(team);
  EXPECT_EQ(with.result.sites_done, 1U);
  EXPECT_EQ(with.done(TaskKind::deliver).size(), 3U);
  EXPECT_EQ(with.result.protocol_errors, 0U);
}

TEST(TeamSimulator, AReportedSiteIsToldAtItsTimeToTheNearestWhoCanSurvey) {
  TeamMission mission = small_mission();
  mission.vehicles.push_back(
      {spec(6, {TaskKind::survey, TaskKind::assess}, 0), {900, 700, 0}, {{900, 700}}});
  // The scout passes the site before anybody is told of it, and is the nearest then.
  mission.reported[SiteId{1}] = at_seconds(30.0);
  std::vector<MissionEvent> found;
  TeamObserver observer;
  observer.event = [&](const MissionEvent& event) {
    if (event.kind() == EventKind::site_detected) found.push_back(event);
  };
  const TeamResult result = simulate_team(mission, observer);
  EXPECT_EQ(result.sites_done, 1U);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found.front().vehicle, VehicleId{1});
  EXPECT_NEAR(to_seconds(found.front().time), 30.0, 0.15);

  found.clear();
  mission.vehicles.back().start = {50, 150, 0};
  mission.vehicles.back().search = {{50, 150}};
  mission.reported[SiteId{1}] = at_seconds(1.0);
  simulate_team(mission, observer);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found.front().vehicle, VehicleId{6});
}

}  // namespace
}  // namespace skein::hil
