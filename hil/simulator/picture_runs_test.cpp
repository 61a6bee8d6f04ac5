// SPDX-License-Identifier: Apache-2.0
// What the operator is shown, held against what the vehicles themselves are about, at every moment
// of whole missions: the console's sections and the table of `status` may be late by the radio, and
// never wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "picture_watch_test.hpp"
#include "skein/hil/fault_profiles.hpp"
#include "skein/hil/run_parallel.hpp"
#include "skein/hil/team_mission.hpp"

namespace skein::hil {
namespace {

using mission::CommandKind;
using mission::EventKind;
using ::testing::IsEmpty;

TeamMission scenario(const std::string& name) {
  const auto loaded =
      configuration::load_scenario(std::string{SKEIN_SOURCE_DIR} + "/scenarios/" + name + ".yaml");
  if (!loaded) throw std::runtime_error(loaded.error().message);
  return team_mission(*loaded);
}

/// Its end is not waited for: somewhere is a site that nobody finds.
void goes_on_for(TeamMission& team, double seconds) {
  Site far;
  far.id = SiteId{99};
  far.position = {50'000.0, 0.0};
  team.sites.push_back(far);
  team.duration_max = from_seconds(seconds);
}

void order(TeamMission& team, double at_s, std::uint16_t vehicle, CommandKind kind) {
  team.faults.push_back({{.not_before = at_seconds(at_s)}, {}, Ordered{{vehicle}, kind}});
}

TEST(PictureRuns, AMissionIsShownAsItIs) {
  TeamMission team = scenario("coalition-6");
  PictureWatch watch{team};
  const TeamResult result = simulate_team(team, watch.observer());
  EXPECT_THAT(watch.differences(), IsEmpty());
  EXPECT_EQ(result.sites_done, team.sites.size());
  for (const char* state :
       {"searching", "surveying", "waiting_for_authorisation", "delivering", "assessing"}) {
    EXPECT_TRUE(watch.seen.contains(state)) << state;
  }
}

TEST(PictureRuns, WhatTheOperatorRefusesIsShownNoMore) {
  TeamMission team = scenario("coalition-6");
  for (auto& decision : team.decisions) decision.grant = false;
  goes_on_for(team, 110.0);
  PictureWatch watch{team};
  (void)simulate_team(team, watch.observer());
  EXPECT_THAT(watch.differences(), IsEmpty());
  ASSERT_TRUE(watch.refused_at);
  ASSERT_TRUE(watch.task_shown);
  EXPECT_LT(to_seconds(*watch.task_shown - *watch.refused_at), 0.5);
}

TEST(PictureRuns, OrdersAndTheirEndAreToldApart) {
  TeamMission team = scenario("coalition-6");
  order(team, 6.0, 1, CommandKind::hold);
  order(team, 14.0, 1, CommandKind::resume);
  order(team, 8.0, 2, CommandKind::return_home);
  goes_on_for(team, 110.0);
  PictureWatch watch{team};
  (void)simulate_team(team, watch.observer());
  EXPECT_THAT(watch.differences(), IsEmpty());
  EXPECT_TRUE(watch.seen_of[1].contains("holding_by_order"));
  EXPECT_TRUE(watch.seen_of[2].contains("returning"));
  EXPECT_TRUE(watch.seen_of[2].contains("at_home"));
  for (const char* state : {"holding", "holding_by_order"}) {
    EXPECT_FALSE(watch.seen_of[2].contains(state)) << "vehicle 2 was sent home: " << state;
  }
}

TEST(PictureRuns, WhoFliesHomeForItsRangeOrIsKilledIsShownSo) {
  TeamMission team = scenario("coalition-6");
  team.faults.push_back({{.not_before = at_seconds(12.0)}, {}, BatteryFalls{VehicleId{2}, 24.0}});
  team.faults.push_back({{.not_before = at_seconds(20.0)}, {}, ProgramsEnd{{VehicleId{3}}, {}}});
  goes_on_for(team, 110.0);
  PictureWatch watch{team};
  (void)simulate_team(team, watch.observer());
  EXPECT_THAT(watch.differences(), IsEmpty());
  EXPECT_TRUE(watch.seen_of[2].contains("range_reserve"));
  EXPECT_FALSE(watch.seen_of[2].contains("holding"));
  EXPECT_TRUE(watch.seen_of[3].contains("silent"));
}

TEST(PictureRuns, ACardMarksWhoIsKilledWhileItWaits) {
  TeamMission team = scenario("coalition-6");
  team.protocol.authorisation_lead = std::chrono::seconds{25};
  team.decisions.clear();  // nobody decides
  team.duration_max = std::chrono::seconds{70};
  PictureWatch whole{team};
  (void)simulate_team(team, whole.observer());
  EXPECT_THAT(whole.differences(), IsEmpty());
  ASSERT_GT(whole.cards, 0);
  EXPECT_EQ(whole.marked, 0);
  const auto formed = std::ranges::find_if(whole.events, [](const mission::MissionEvent& e) {
    return e.kind() == EventKind::coalition_formed;
  });
  ASSERT_NE(formed, whole.events.end());
  team.faults.push_back({{.not_before = formed->time + std::chrono::seconds{1}},
                         {},
                         ProgramsEnd{{VehicleId{3}}, {}}});
  PictureWatch watch{team};
  (void)simulate_team(team, watch.observer());
  EXPECT_THAT(watch.differences(), IsEmpty());
  EXPECT_GT(watch.marked, 0);
}

/// Its delivery stays a killed vehicle's until its lease runs out: what is asked for meanwhile
/// lacks it.
TEST(PictureRuns, ACardSaysWhatIsMissingAndWhy) {
  TeamMission team = scenario("coalition-6");
  team.protocol.authorisation_lead = std::chrono::seconds{10};
  team.decisions.clear();                 // nobody decides
  team.vehicles[5].spec.range_m = 900.0;  // vehicle 6: not enough for the site and the way home
  team.duration_max = std::chrono::seconds{60};
  PictureWatch whole{team};
  (void)simulate_team(team, whole.observer());
  EXPECT_THAT(whole.differences(), IsEmpty());
  const auto formed = std::ranges::find_if(whole.events, [](const mission::MissionEvent& e) {
    return e.kind() == EventKind::coalition_formed;
  });
  ASSERT_NE(formed, whole.events.end());
  EXPECT_TRUE(whole.reasons.empty());
  team.faults.push_back({{.not_before = formed->time + std::chrono::seconds{9}},
                         {},
                         ProgramsEnd{{VehicleId{3}}, {}}});
  PictureWatch watch{team};
  (void)simulate_team(team, watch.observer());
  EXPECT_THAT(watch.differences(), IsEmpty());
  ASSERT_FALSE(watch.reasons.empty());
  EXPECT_TRUE(std::ranges::any_of(watch.reasons, [](const std::string& why) {
    return why.starts_with("vehicle 3 has it still");
  })) << ::testing::PrintToString(watch.reasons);
  EXPECT_TRUE(watch.did_not_bid[6].contains("not enough range left"))
      << ::testing::PrintToString(watch.did_not_bid);
  EXPECT_FALSE(watch.did_not_bid[3].empty());
}

TEST(PictureRuns, AlsoWhereTheRadioLosesAThird) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    TeamMission team = scenario("coalition-6");
    team.seed = seed;
    team.faults.push_back({{}, {}, radio::Disturbance{.loss = 0.3}});
    order(team, 20.0, 5, CommandKind::hold);
    order(team, 30.0, 2, CommandKind::return_home);
    goes_on_for(team, 80.0);
    PictureWatch watch{team, {std::chrono::seconds{2}, std::chrono::seconds{4}}};
    (void)simulate_team(team, watch.observer());
    EXPECT_THAT(watch.differences(), IsEmpty());
    EXPECT_TRUE(watch.seen_of[2].contains("returning"));
    EXPECT_TRUE(watch.seen_of[5].contains("holding_by_order"));
  }
}

TEST(PictureRuns, FromTheGroundToTheGround) {
  TeamMission team = scenario("mixed-6");
  team.ends_landed = true;
  team.duration_max = std::chrono::seconds{900};
  for (SimulatedVehicle& v : team.vehicles) v.spec.range_m = 30e3;
  PictureWatch watch{team};
  const TeamResult result = simulate_team(team, watch.observer());
  EXPECT_THAT(watch.differences(), IsEmpty());
  for (const VehicleEnd& end : result.vehicles) EXPECT_TRUE(end.landed) << end.vehicle.value;
  for (const char* state :
       {"taking_off", "searching", "returning", "at_home", "landing", "landed"}) {
    EXPECT_TRUE(watch.seen.contains(state)) << state;
  }
}

// --- missions of all kinds, with faults ---

constexpr std::size_t kKinds = 4;

configuration::Scenario scenario_of(const std::string& name) {
  auto loaded =
      configuration::load_scenario(std::string{SKEIN_SOURCE_DIR} + "/scenarios/" + name + ".yaml");
  if (!loaded) throw std::runtime_error(loaded.error().message);
  return *std::move(loaded);
}

/// Three of them fly side by side to the north in the middle of their search.
void give_routes(TeamMission& team) {
  RoutesOrdered order;
  order.begin_in = std::chrono::seconds{60};
  double east_m = -600.0;
  for (const SimulatedVehicle& v : team.vehicles) {
    if (order.routes.size() == 3) break;
    TimedPath timed;
    timed.speed_mps = v.spec.cruise_speed_mps;
    timed.path.start = {east_m, -600.0, kPi / 2.0};
    (void)timed.path.append(Segment{0.0, 2000.0});
    order.routes.emplace(v.spec.id, timed);
    east_m += 400.0;
  }
  team.faults.push_back(
      {{.not_before = at_seconds(5.0), .not_after = at_seconds(60.0)}, {}, order});
}

/// Coalitions, landings, formations of both kinds, routes: in turn.
TeamMission drawn(std::uint64_t seed) {
  const auto make = [&](const char* name) {
    auto team = seeded_mission(scenario_of(name), seed, "mixed");
    if (!team) throw std::runtime_error(team.error().message);
    return *std::move(team);
  };
  switch (seed % kKinds) {
    case 0:
      return make("faults-8");
    case 1: {
      TeamMission team = make("mixed-6");
      team.ends_landed = true;
      return team;
    }
    case 2:
      return make(seed % (2 * kKinds) < kKinds ? "formation-5" : "formation-planes-5");
    default: {
      TeamMission team = make("coalition-6");
      give_routes(team);
      return team;
    }
  }
}

struct Shown {
  std::uint64_t seed = 0;
  std::vector<std::string> differences;
  std::map<std::string, std::size_t> judged;
  std::set<std::string> seen;
};

Result<Shown> fly(std::uint64_t seed) {
  const TeamMission team = drawn(seed);
  // The page is told five times in a second.
  PictureWatch watch{team, {.every = std::chrono::milliseconds{200}}};
  (void)simulate_team(team, watch.observer());
  return Shown{seed, watch.differences(), watch.judged, watch.seen};
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr std::size_t kRuns = 4;  ///< sanitizers are slow
#else
constexpr std::size_t kRuns = 28;
#endif

/// SKEIN_RUNS=1000 flies as many (docs/simulation.md).
TEST(PictureRuns, NothingOnThePageDiffersFromTheAgentsInSeededMissionsWithFaults) {
  // NOLINTNEXTLINE(concurrency-mt-unsafe): before there is another thread
  const char* const asked = std::getenv("SKEIN_RUNS");
  const std::size_t runs = asked == nullptr ? kRuns : std::strtoul(asked, nullptr, 10);
  const auto flown =
      run_parallel<Shown>(runs, jobs_of(0), [](std::size_t i) { return fly(i + 1); }, {});
  ASSERT_TRUE(flown);
  std::size_t differ = 0;
  std::map<std::string, std::size_t> judged;
  std::set<std::string> seen;
  for (const Shown& one : *flown) {
    differ += one.differences.empty() ? 0 : 1;
    for (const std::string& what : one.differences) {
      ADD_FAILURE() << "seed " << one.seed << ": " << what;
    }
    for (const auto& [kind, count] : one.judged) judged[kind] += count;
    seen.insert(one.seen.begin(), one.seen.end());
  }
  RecordProperty("runs", std::to_string(runs));
  RecordProperty("differ", std::to_string(differ));
  std::printf("%zu of %zu missions differ; held against each other:", differ, runs);
  for (const auto& [kind, count] : judged) std::printf(" %s %zu,", kind.c_str(), count);
  std::printf("\n");
  for (const char* kind :
       {"state", "task", "silence", "table", "facts", "site off", "site done", "owner",
        "owner is shown", "coalition's members", "card waits", "decision", "can be taken back",
        "deliveries of a card", "silent on a card", "marks", "hazards"}) {
    EXPECT_GT(judged[kind], 0U) << kind;
  }
  for (const char* state : {"searching", "surveying", "waiting_for_authorisation", "delivering",
                            "assessing", "en_route", "silent", "landing", "landed", "returning"}) {
    EXPECT_TRUE(seen.contains(state)) << state;
  }
}

}  // namespace
}  // namespace skein::hil
