// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/fault_profiles.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "skein/hil/judged_runs.hpp"
#include "skein/hil/team_mission.hpp"

namespace skein::hil {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

configuration::Scenario scenario(const std::string& name) {
  auto loaded =
      configuration::load_scenario(std::string{SKEIN_SOURCE_DIR} + "/scenarios/" + name + ".yaml");
  EXPECT_TRUE(loaded) << loaded.error().message;
  EXPECT_TRUE(configuration::check(*loaded));
  return *loaded;
}

TeamMission drawn(const std::string& faults, std::uint64_t seed) {
  auto mission = seeded_mission(scenario("faults-8"), seed, faults);
  EXPECT_TRUE(mission) << mission.error().message;
  return std::move(mission).value();
}

struct Flown {
  JudgedRun run;
  std::string trace;
  std::vector<mission::MissionEvent> events;
  std::vector<FaultEvent> faults;
};

Flown fly(const TeamMission& mission) {
  Flown flown;
  TeamObserver watcher;
  watcher.event = [&](const mission::MissionEvent& e) {
    flown.events.push_back(e);
    flown.trace += trace_line(e) + "\n";
  };
  watcher.fault = [&](const FaultEvent& e) {
    flown.faults.push_back(e);
    flown.trace += trace_line(e) + "\n";
  };
  flown.run = fly_judged(mission, limits_of(scenario("faults-8").expect), watcher);
  return flown;
}

TEST(Faults, AProfileThatThereIsNotIsRefusedWithThoseThatThereAre) {
  const auto params = fault_params("lossy,croash", 1);
  ASSERT_FALSE(params);
  EXPECT_THAT(params.error().message, HasSubstr("'croash'"));
  EXPECT_THAT(params.error().message, HasSubstr("crash, clocks"));
}

TEST(Faults, AProfileOfTheOtherKindOfMissionIsRefusedByItsKind) {
  const auto sites = fault_params("lossy,leader", 1);
  ASSERT_FALSE(sites);
  EXPECT_THAT(sites.error().message, HasSubstr("'leader' are of formations, and this mission has"));
  const auto formation = formation_faults("loss,hazards", {{1}, {2}}, 3, 1);
  ASSERT_FALSE(formation);
  EXPECT_THAT(formation.error().message, HasSubstr("'hazards' are of missions with sites, and"));
  EXPECT_THAT(formation.error().message, HasSubstr("none, vehicle, leader"));
}

TEST(Faults, ProfilesAreComposed) {
  const auto params = fault_params("lossy,crash", 1);
  ASSERT_TRUE(params);
  EXPECT_EQ(params->loss, 0.6);
  EXPECT_EQ(params->crashes, 2U);
  EXPECT_EQ(params->partitions, 0U);
  const auto none = fault_params("none", 1);
  ASSERT_TRUE(none);
  EXPECT_EQ(none->phase, Duration{});
}

TEST(Faults, MixedDrawsOtherProfilesForOtherSeeds) {
  std::set<std::string> mixes;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const auto p = fault_params("mixed", seed);
    ASSERT_TRUE(p);
    mixes.insert({p->loss > 0 ? 'l' : '-', p->partitions > 0 ? 'p' : '-',
                  p->crashes > 0 ? 'c' : '-', p->slow_operator ? 'o' : '-',
                  p->joiners > 0 ? 'j' : '-', p->planning > Duration{} ? 's' : '-'});
  }
  EXPECT_GT(mixes.size(), 10U);
}

TEST(Faults, TheScheduleIsTheSeedsAndOnlyTheSeeds) {
  EXPECT_EQ(describe(drawn("mixed", 7)), describe(drawn("mixed", 7)));
  EXPECT_NE(describe(drawn("mixed", 7)), describe(drawn("mixed", 8)));
  EXPECT_THAT(describe(drawn("none", 7)), IsEmpty());
}

TEST(Faults, WhoCrashesIsSilentAndWhoRestartsKnowsNothing) {
  auto mission = drawn("crash", 1);
  mission.faults = {
      {{.not_before = at_seconds(1), .role = Role::leader, .after = 3s}, 8s, ProgramsEnd{}},
      {{.not_before = at_seconds(90)}, {}, Healing{}}};
  const auto flown = fly(mission);
  ASSERT_GE(flown.faults.size(), 2U) << flown.trace;
  EXPECT_EQ(flown.faults[0].kind, FaultEvent::Kind::ended);
  EXPECT_EQ(flown.faults[1].kind, FaultEvent::Kind::restarted);
  EXPECT_EQ(flown.faults[1].time - flown.faults[0].time, std::chrono::seconds{8});
  const VehicleId victim = flown.faults[0].vehicle;
  bool spoke_after = false;
  for (const auto& e : flown.events) {
    if (e.vehicle != victim) continue;
    EXPECT_FALSE(e.time > flown.faults[0].time && e.time < flown.faults[1].time) << trace_line(e);
    spoke_after = spoke_after || e.time > flown.faults[1].time;
  }
  EXPECT_TRUE(spoke_after);
}

TEST(Faults, WhoIsLostWithItsAirframeFliesNoMoreAndIsMissed) {
  auto mission = drawn("airframe", 1);
  ProgramsEnd lost;
  lost.with_airframe = true;
  mission.faults = {{{.not_before = at_seconds(1), .role = Role::member, .after = 6s}, {}, lost},
                    {{.not_before = at_seconds(90)}, {}, Healing{}}};
  std::map<VehicleId, Instant> seen;
  TeamObserver watcher;
  std::optional<FaultEvent> gone;
  bool is_told = false;
  watcher.track = [&](VehicleId id, const VehicleState& state, const mission::FlightPlan&) {
    seen[id] = state.time;
  };
  watcher.fault = [&](const FaultEvent& e) {
    if (e.kind == FaultEvent::Kind::gone) gone = e;
  };
  watcher.event = [&](const mission::MissionEvent& e) {
    const auto* fleet = std::get_if<mission::event::FleetWarning>(&e.body);
    is_told = is_told || (fleet != nullptr && gone && fleet->vehicle == gone->vehicle &&
                          fleet->news == mission::event::FleetNews::silent);
  };
  const auto run = fly_judged(mission, limits_of(scenario("faults-8").expect), watcher);
  ASSERT_TRUE(gone);
  EXPECT_LE(seen[gone->vehicle], gone->time + 2s);
  EXPECT_TRUE(is_told) << "the operator";
  EXPECT_THAT(run.broken, IsEmpty());
  EXPECT_TRUE(run.sites_done) << "by the others";
}

TEST(Faults, WhoIsLostWhileItsProgramIsDownDoesNotStartAnew) {
  auto mission = seeded_mission(scenario("coalition-6"), 1, "none");
  ASSERT_TRUE(mission);
  const VehicleId victim = mission->vehicles.back().spec.id;
  mission->faults = {{{.not_before = at_seconds(5)}, 10s, ProgramsEnd{{victim}}},
                     {{.not_before = at_seconds(8)}, {}, ProgramsEnd{{victim}}},
                     {{.not_before = at_seconds(90)}, {}, Healing{}}};
  const auto flown = fly(*mission);
  std::vector<FaultEvent::Kind> kinds;
  for (const FaultEvent& e : flown.faults) {
    if (e.vehicle == victim) kinds.push_back(e.kind);
  }
  EXPECT_THAT(kinds, ElementsAre(FaultEvent::Kind::ended, FaultEvent::Kind::gone));
  EXPECT_THAT(flown.run.broken, IsEmpty());
}

TEST(Faults, WhoStandsStillSaysNothingAndHearsItAllAfterwards) {
  auto mission = drawn("stall", 1);
  mission.faults = {
      {{.not_before = at_seconds(1), .role = Role::leader, .after = 1s}, 3s, ProgramsStall{}},
      {{.not_before = at_seconds(90)}, {}, Healing{}}};
  const auto flown = fly(mission);
  ASSERT_GE(flown.faults.size(), 1U) << flown.trace;
  const FaultEvent& stood = flown.faults[0];
  EXPECT_EQ(stood.kind, FaultEvent::Kind::stands_still);
  bool goes_on = false;
  for (const auto& e : flown.events) {
    if (e.vehicle != stood.vehicle) continue;
    EXPECT_FALSE(e.time > stood.time && e.time < stood.time + 3s) << trace_line(e);
    goes_on = goes_on || (e.time >= stood.time + 3s && e.round.coalition.leader == stood.vehicle);
  }
  EXPECT_TRUE(goes_on);
  EXPECT_THAT(flown.run.broken, IsEmpty());
}

TEST(Faults, WhoStartsAnewAfterTheHealingIsToldOfWhatNobodyCouldBeToldOf) {
  auto mission = seeded_mission(scenario("coalition-6"), 1, "none");
  ASSERT_TRUE(mission);
  SimulatedVehicle& only_scout = mission->vehicles.front();
  only_scout.search = {{-400.0, 400.0}};  // far from the site
  mission->duration_max = 300s;
  mission->faults = {{{.not_before = at_seconds(20)}, 20s, ProgramsEnd{{only_scout.spec.id}}},
                     {{.not_before = at_seconds(30)}, {}, Healing{}}};
  EXPECT_TRUE(fly(*mission).run.sites_done);
}

TEST(Faults, TwoUnderOneNumberAreToldAndTakeUpNothing) {
  auto mission = drawn("double", 3);
  ASSERT_EQ(mission.vehicles.size(), 9U);
  const SimulatedVehicle& other = mission.vehicles.back();
  ASSERT_TRUE(other.flies_as);
  EXPECT_NE(other.spec.id, *other.flies_as);
  mission.faults = {{{.not_before = at_seconds(2)}, {}, LateStart{other.spec.id}},
                    {{.not_before = at_seconds(90)}, {}, Healing{}}};
  const auto flown = fly(mission);
  EXPECT_THAT(flown.run.broken, IsEmpty());
  EXPECT_TRUE(flown.run.sites_done) << "by the others";
  std::set<VehicleId> know;
  bool is_told = false;
  for (const auto& e : flown.events) {
    const auto* trouble = std::get_if<mission::event::VehicleTrouble>(&e.body);
    const auto* fleet = std::get_if<mission::event::FleetWarning>(&e.body);
    if (trouble != nullptr && trouble->trouble == mission::event::Trouble::id_in_use) {
      know.insert(e.vehicle);
    }
    is_told = is_told || (fleet != nullptr && fleet->news == mission::event::FleetNews::duplicate &&
                          fleet->vehicle == *other.flies_as);
    const bool bids = e.kind() == mission::EventKind::bid_sent && e.time > at_seconds(3);
    EXPECT_FALSE(bids && know.contains(e.vehicle)) << trace_line(e);
  }
  EXPECT_THAT(know, ::testing::UnorderedElementsAre(*other.flies_as, other.spec.id));
  EXPECT_TRUE(is_told) << "the operator";
}

TEST(Faults, WhomAPilotTakesGivesItsTaskBackAndWorksAgainAfterwards) {
  for (const Role role : {Role::leader, Role::member}) {
    auto mission = drawn("none", 1);
    mission.faults = {{{.not_before = at_seconds(1), .role = role, .after = 6s}, 30s, PilotsTake{}},
                      {{.not_before = at_seconds(90)}, {}, Healing{}}};
    const auto flown = fly(mission);
    ASSERT_GE(flown.faults.size(), 2U) << flown.trace;
    const FaultEvent& taken = flown.faults[0];
    EXPECT_EQ(taken.kind, FaultEvent::Kind::piloted);
    EXPECT_EQ(flown.faults[1].kind, FaultEvent::Kind::given_back);
    EXPECT_EQ(flown.faults[1].time, taken.time + 30s);
    bool is_told = false;
    bool works_again = false;
    for (const auto& e : flown.events) {
      if (e.vehicle != taken.vehicle) continue;
      using mission::EventKind;
      is_told = is_told || e.kind() == EventKind::flight_warning;
      const bool takes_up = e.kind() == EventKind::bid_sent || e.kind() == EventKind::confirmed ||
                            e.kind() == EventKind::task_started ||
                            e.kind() == EventKind::survey_started;
      const bool piloted = e.time >= taken.time && e.time < taken.time + 30s;
      EXPECT_FALSE(piloted && takes_up) << trace_line(e);
      works_again = works_again || (takes_up && e.time >= taken.time + 30s);
    }
    EXPECT_TRUE(is_told) << "the operator";
    EXPECT_TRUE(works_again) << flown.trace;
    EXPECT_THAT(flown.run.broken, IsEmpty());
    EXPECT_TRUE(flown.run.sites_done);
  }
}

TEST(Faults, TheOtherGroundStationTakesTheCommandAndDecides) {
  auto mission = drawn("none", 1);
  mission.faults = {{{.not_before = at_seconds(10)}, {}, CommandTaken{}},
                    {{.not_before = at_seconds(14)}, {}, ProgramsEnd{{kGroundStation}}},
                    {{.not_before = at_seconds(90)}, {}, Healing{}}};
  std::size_t decisions = 0;
  TeamObserver watcher;
  watcher.heard = [&](VehicleId, const mission::Message& message, Instant now) {
    if (!std::holds_alternative<mission::Authorisation>(message)) return;
    ++decisions;
    EXPECT_GT(now, at_seconds(14)) << "the first one has decided";
  };
  const auto run = fly_judged(mission, limits_of(scenario("faults-8").expect), watcher);
  EXPECT_THAT(run.broken, IsEmpty());
  EXPECT_TRUE(run.sites_done);
  EXPECT_GT(decisions, 0U);
}

TEST(Faults, AJoinerIsNotThereBefore) {
  auto mission = drawn("joining", 1);
  mission.faults = {{{.not_before = at_seconds(30)}, {}, LateStart{VehicleId{5}}}};
  const auto flown = fly(mission);
  ASSERT_FALSE(flown.faults.empty());
  for (const auto& e : flown.events) {
    EXPECT_FALSE(e.vehicle == VehicleId{5} && e.time < at_seconds(30)) << trace_line(e);
  }
}

TEST(Faults, ClocksThatDifferAreSeenByTheAgentsOnly) {
  auto mission = drawn("none", 1);
  mission.faults = {{{.not_before = at_seconds(1)}, {}, Healing{}}};
  const auto straight = fly(mission);
  for (const auto& v : mission.vehicles) {
    Fault off;
    off.what = ClockOff{v.spec.id, 200ms};
    mission.faults.push_back(off);
  }
  const auto shifted = fly(mission);
  // All clocks are fast by the same: what is flown at which true time stays nearly the same.
  EXPECT_THAT(shifted.run.broken, IsEmpty());
  EXPECT_TRUE(shifted.run.sites_done);
  EXPECT_NEAR(to_seconds(shifted.run.result.ended_at), to_seconds(straight.run.result.ended_at),
              3.0);
  const auto first = [](const Flown& f) {
    for (const auto& e : f.events) {
      if (e.kind() == mission::EventKind::survey_done) return e;
    }
    return mission::MissionEvent{};
  };
  EXPECT_NEAR(to_seconds(first(shifted).time), to_seconds(first(straight).time), 0.25);
  const auto begun = [&](const Flown& f) {
    return to_seconds(std::get<mission::event::SurveyDone>(first(f).body).begun);
  };
  EXPECT_NEAR(begun(shifted), begun(straight), 0.25) << "a moment, in true time too";
}

TEST(Faults, TheSameSeedIsFlownByteForByte) {
  for (const std::uint64_t seed : {3U, 4U}) {
    const auto once = fly(drawn("mixed", seed));
    EXPECT_EQ(once.trace, fly(drawn("mixed", seed)).trace);
    EXPECT_THAT(once.trace, HasSubstr("FAULT"));
  }
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr std::size_t kShare = 25;  ///< sanitizers are slow
#else
constexpr std::size_t kShare = 1;
#endif

/// Broken checks of seeds 1 to `runs`.
std::string broken(const std::string& faults, std::size_t runs) {
  RunSeries series;
  series.faults = faults;
  series.runs = std::max<std::size_t>(5, runs / kShare);
  series.jobs = std::max(1U, std::thread::hardware_concurrency());
  std::string text;
  for (const auto& run : fly_series(scenario("faults-8"), series)) {
    for (const auto& check : run.broken) {
      text += "seed " + std::to_string(run.seed) + ", " + check.name + ": " +
              check.violations.front().sentence + "\n";
    }
  }
  return text;
}

class Series : public testing::TestWithParam<const char*> {};

TEST_P(Series, HoldsAndIsFinished) { EXPECT_EQ(broken(GetParam(), 30), ""); }
INSTANTIATE_TEST_SUITE_P(Faults, Series,
                         testing::Values("airframe", "battery", "clocks", "covered", "crash",
                                         "double", "hazards", "joining", "lossy", "narrow",
                                         "operator", "partition", "pilot", "sites", "stall",
                                         "stations", "wind"));

TEST(Faults, WhoCannotMissAHazardLeavesItForGood) {
  auto mission = drawn("none", 1);
  const checks::Limits limits = limits_of(scenario("faults-8").expect);
  const auto enters = [](const JudgedRun& run) {
    return std::any_of(run.broken.begin(), run.broken.end(),
                       [](const auto& check) { return check.name == "hazards"; });
  };
  const auto goes_straight = [](const mission::FlightPlan& plan, Instant at) {
    const double flown_m = plan.timed.distance_at(at);
    const double heading = plan.timed.pose_at_distance(flown_m - 100.0).heading_rad;
    return plan.timed.pose_at_distance(flown_m + 200.0).heading_rad == heading;
  };
  for (const VehicleId vehicle : {VehicleId{2}, VehicleId{5}}) {
    std::optional<VehicleState> there;
    TeamObserver watcher;
    watcher.track = [&](VehicleId id, const VehicleState& state, const mission::FlightPlan& plan) {
      const bool early = state.time < at_seconds(5);
      if (id == vehicle && !there && !early && goes_straight(plan, state.time)) there = state;
    };
    ASSERT_TRUE(fly_judged(mission, limits, watcher).held());
    ASSERT_TRUE(there.has_value());
    // Its edge is 30 m ahead, and the tightest turn is of 70 m.
    const Hazard hazard{HazardId{1001},
                        Vec2{there->x_m, there->y_m} + 70.0 * unit_vector(there->course_rad), 40.0};
    auto surprised = mission;
    surprised.hazards.push_back({hazard, there->time});
    const auto run = fly(surprised).run;
    EXPECT_FALSE(enters(run)) << "vehicle " << vehicle.value;
    EXPECT_EQ(run.excused.size(), 1U) << "vehicle " << vehicle.value;
  }
}

TEST(Faults, FiveHundredMixedMissionsAreSafeAndFinished) { EXPECT_EQ(broken("mixed", 500), ""); }

}  // namespace
}  // namespace skein::hil
