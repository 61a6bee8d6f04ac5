// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/fault.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "skein/hil/fault_timeline.hpp"
#include "skein/hil/judged_runs.hpp"
#include "skein/hil/team_mission.hpp"

namespace skein::hil {
namespace {

using namespace std::chrono_literals;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

class Timeline : public testing::Test {
 protected:
  /// What begins by then.
  std::vector<std::string> play(FaultTimeline& timeline, double now_s) {
    std::vector<std::string> begun;
    timeline.play(
        at_seconds(now_s), [this](Role role) { return role == Role::leader ? leaders_ : team_; },
        [&](const Fault& fault, const std::vector<VehicleId>& who) {
          begun.push_back(who.empty() ? describe(fault) : names_of(who));
          return can_begin_;
        });
    return begun;
  }
  static bool apart(const FaultTimeline& timeline) { return !timeline.interference().cuts.empty(); }

  std::vector<VehicleId> team_{{1}, {2}, {3}};
  std::vector<VehicleId> leaders_;
  bool can_begin_ = true;
};

TEST_F(Timeline, APartitionLastsForItsTimeOnly) {
  FaultTimeline timeline{{{{.not_before = at_seconds(10)}, 10s, radio::cut_off({VehicleId{1}})}}};
  EXPECT_THAT(play(timeline, 9.9), IsEmpty());
  EXPECT_FALSE(apart(timeline));
  EXPECT_THAT(play(timeline, 10), ElementsAre("at 10.00 s: U1 apart for 10.00 s"));
  EXPECT_TRUE(apart(timeline));
  EXPECT_TRUE(timeline.radio_changed());
  EXPECT_THAT(play(timeline, 19.9), IsEmpty());
  EXPECT_TRUE(apart(timeline));
  EXPECT_FALSE(timeline.radio_changed());
  play(timeline, 20);
  EXPECT_FALSE(apart(timeline));
}

TEST_F(Timeline, DisturbancesAtOneTimeAreTheLargerOfEach) {
  FaultTimeline timeline{{{{}, 10s, radio::Disturbance{0.2, 30ms, {}, {}}},
                          {{.not_before = at_seconds(5)}, 10s, radio::Disturbance{0.5, 10ms}}}};
  play(timeline, 5);
  EXPECT_EQ(timeline.interference().disturbance.loss, 0.5);
  EXPECT_EQ(timeline.interference().disturbance.delay, 30ms);
  play(timeline, 10);
  EXPECT_EQ(timeline.interference().disturbance.delay, 10ms);
  play(timeline, 15);
  EXPECT_EQ(timeline.interference().disturbance.loss, 0.0);
}

TEST_F(Timeline, WhoHasTheRoleFirstIsTheOneAndIsWaitedFor) {
  FaultTimeline timeline{{{{.not_before = at_seconds(1),
                            .not_after = at_seconds(9),
                            .role = Role::leader,
                            .after = 2s},
                           {},
                           ProgramsEnd{{}, 4}}}};
  EXPECT_THAT(play(timeline, 2), IsEmpty()) << "nobody leads";
  leaders_ = {{2}, {3}, {1}};
  EXPECT_THAT(play(timeline, 4), IsEmpty());
  leaders_ = {{1}};
  can_begin_ = false;
  EXPECT_THAT(play(timeline, 6), ElementsAre("U3")) << "the fifth of three";
  can_begin_ = true;
  EXPECT_THAT(play(timeline, 7), ElementsAre("U3")) << "asked again";
  EXPECT_THAT(play(timeline, 8), IsEmpty()) << "once";
}

TEST_F(Timeline, WhatDoesNotBeginInTimeNeverDoes) {
  FaultTimeline timeline{{{{.not_after = at_seconds(9), .role = Role::leader}, {}, ProgramsEnd{}}}};
  play(timeline, 9);
  leaders_ = {{1}};
  EXPECT_THAT(play(timeline, 10), IsEmpty());
}

TEST_F(Timeline, AChangeOfTheFormationIsWaitedFor) {
  FaultTimeline timeline{{{{.change = 1, .after = 3s}, 5s, ProgramsEnd{{{2}}}}}};
  timeline.on_change_begun(at_seconds(10));
  EXPECT_THAT(play(timeline, 20), IsEmpty());
  timeline.on_change_begun(at_seconds(20));
  EXPECT_THAT(play(timeline, 22.9), IsEmpty());
  EXPECT_THAT(play(timeline, 23), ElementsAre("U2"));
  EXPECT_EQ(timeline.quiet_from(), at_seconds(28));
}

// --- a scenario's faults in virtual time ---

struct Flown {
  JudgedRun run;
  std::vector<mission::MissionEvent> events;
  std::vector<FaultEvent> faults;

  [[nodiscard]] std::vector<std::string> broken() const {
    std::vector<std::string> names;
    for (const auto& check : run.broken) names.push_back(check.name);
    return names;
  }
};

Flown fly(const std::vector<configuration::Fault>& faults) {
  auto scenario =
      configuration::load_scenario(std::string{SKEIN_SOURCE_DIR} + "/scenarios/coalition-6.yaml");
  EXPECT_TRUE(scenario) << scenario.error().message;
  scenario->faults = faults;
  EXPECT_TRUE(configuration::check(*scenario)) << configuration::check(*scenario).error().message;
  Flown flown;
  TeamObserver watcher;
  watcher.event = [&](const mission::MissionEvent& e) { flown.events.push_back(e); };
  watcher.fault = [&](const FaultEvent& e) { flown.faults.push_back(e); };
  flown.run = fly_judged(*seeded_mission(*scenario, scenario->seed, "none"),
                         limits_of(scenario->expect), watcher);
  return flown;
}

configuration::Fault scenario_fault(configuration::FaultKind kind, double at_s, double for_s) {
  configuration::Fault fault;
  fault.kind = kind;
  fault.at = at_seconds(at_s);
  fault.duration = from_seconds(for_s);
  return fault;
}

TEST(ScenarioFaults, WithoutThemTheMissionHolds) { EXPECT_THAT(fly({}).broken(), IsEmpty()); }

TEST(ScenarioFaults, WhoIsKilledSaysNothingMore) {
  std::vector<configuration::Fault> faults;
  for (std::uint16_t id = 1; id <= 6; ++id) {
    faults.push_back(scenario_fault(configuration::FaultKind::kill_vehicle, 20, 0));
    faults.back().vehicle = VehicleId{id};
  }
  const auto flown = fly(faults);
  for (const auto& e : flown.events) {
    EXPECT_TRUE(e.vehicle == kGroundStation || e.time <= at_seconds(20)) << trace_line(e);
  }
  EXPECT_EQ(flown.faults.size(), 6U);
  EXPECT_EQ(flown.faults.front().kind, FaultEvent::Kind::gone);
  EXPECT_THAT(flown.broken(), Contains("completion")) << "a scenario's faults excuse nothing";
}

TEST(ScenarioFaults, WithoutItsGroundStationNothingIsDelivered) {
  auto kill = scenario_fault(configuration::FaultKind::kill_vehicle, 1, 0);
  kill.vehicle = kGroundStation;
  const auto flown = fly({kill});
  EXPECT_TRUE(std::none_of(flown.events.begin(), flown.events.end(), [](const auto& e) {
    return e.vehicle == kGroundStation && e.time > at_seconds(1);
  }));
  EXPECT_THAT(flown.broken(), Contains("completion"));
}

TEST(ScenarioFaults, WhoIsCutOffFormsNoCoalition) {
  auto cut = scenario_fault(configuration::FaultKind::partition, 0, 290);
  cut.groups = {{{1}}, {{2}}, {{3}}, {{4}}, {{5}}, {{6}}};
  const auto flown = fly({cut});
  EXPECT_TRUE(std::none_of(flown.events.begin(), flown.events.end(), [](const auto& e) {
    return e.kind() == mission::EventKind::coalition_formed;
  }));
  EXPECT_THAT(flown.broken(), Contains("completion"));
}

TEST(ScenarioFaults, WhatIsLostIsNotHeard) {
  auto loss = scenario_fault(configuration::FaultKind::loss, 0, 290);
  loss.loss_ratio = 1.0;
  EXPECT_THAT(fly({loss}).broken(), Contains("completion"));
  loss.duration = 10s;
  EXPECT_THAT(fly({loss}).broken(), IsEmpty()) << "it ends, and the mission goes on";
}

}  // namespace
}  // namespace skein::hil
