// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/formation_runs.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "skein/hil/team_mission.hpp"
#include "skein/mission/shown_state.hpp"
#include "skein/wording/wording.hpp"

namespace skein::hil {
namespace {

configuration::Scenario five() {
  auto scenario =
      configuration::load_scenario(std::string{SKEIN_SOURCE_DIR} + "/scenarios/formation-5.yaml");
  EXPECT_TRUE(scenario) << scenario.error().message;
  return *scenario;
}

std::string text_of(const FormationRun& run) {
  std::string text;
  for (const auto& v : run.violations) {
    text += fmt::format("seed {}: {:.2f} s, {}: {}\n", run.seed, to_seconds(v.time), v.check,
                        v.sentence);
  }
  return text;
}

TEST(FormationRuns, ThePapersFlightComesToItsEnd) {
  const auto mission = seeded_mission(five(), 1, "none");
  ASSERT_TRUE(mission) << mission.error().message;
  const auto run = fly_formation(*mission);
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_TRUE(run->held()) << text_of(*run);
  EXPECT_TRUE(run->script_done);
  EXPECT_GT(run->least_m, 2.0);
  EXPECT_LT(run->farthest_m, 0.5);
  EXPECT_GE(run->changes, 10U);
}

TEST(FormationRuns, ThePapersFieldComesToItsEndMoreSlowly) {
  configuration::Scenario scenario = five();
  const auto passage = fly_formation(*seeded_mission(scenario, 1, "none"));
  scenario.formation.avoidance = formation::Avoidance::field;
  const auto field = fly_formation(*seeded_mission(scenario, 1, "none"));
  ASSERT_TRUE(passage && field);
  EXPECT_TRUE(field->held()) << text_of(*field);
  EXPECT_TRUE(field->script_done);
  EXPECT_GT(field->ended_at, passage->ended_at);
}

TEST(FormationRuns, AHundredTeamsWithFaultsHold) {
  const auto runs = fly_formations(five(), {"mixed", 1, 100, 1});
  ASSERT_TRUE(runs) << runs.error().message;
  std::size_t done = 0;
  for (const FormationRun& run : *runs) {
    EXPECT_TRUE(run.held()) << text_of(run) << "  skein-hil simulate scenarios/formation-5.yaml"
                            << " --faults mixed --trace --seed " << run.seed;
    done += run.script_done ? 1 : 0;
  }
  EXPECT_GT(done, 80U);
}

TEST(FormationRuns, TheSameSeedGivesTheSameBytes) {
  const auto mission = seeded_mission(five(), 3, "mixed");
  ASSERT_TRUE(mission);
  const auto trace = [&] {
    std::string text;
    TeamObserver observer;
    observer.event = [&](const mission::MissionEvent& event) {
      text += fmt::format("{} {} {}\n", event.time.time_since_epoch().count(),
                          mission::to_string(event.kind()), wording::news_of(event));
    };
    observer.bodies = [&](Instant, const std::vector<SeenBody>& bodies) {
      for (const SeenBody& body : bodies) {
        const Vec3& p = body.position_m;
        text += fmt::format("{} {} {}\n", p.x(), p.y(), p.z());
      }
    };
    EXPECT_TRUE(fly_formation(*mission, observer));
    return text;
  };
  const std::string first = trace();
  EXPECT_GT(first.size(), 10'000U);
  EXPECT_TRUE(first == trace());
}

/// The programs end in that change; without `lasts_s` for good.
Fault fault(std::vector<VehicleId> who, double after_s, std::optional<double> lasts_s) {
  Fault fault{{.change = 2, .after = from_seconds(after_s)}, {}, ProgramsEnd{std::move(who)}};
  if (lasts_s) fault.lasts = from_seconds(*lasts_s);
  return fault;
}

FormationRun fly(const std::vector<Fault>& faults) {
  auto mission = seeded_mission(five(), 1, "none");
  EXPECT_TRUE(mission);
  mission->formation->script = {"take-off", "rally", "form column spacing 5 at 0 60 20", "rally",
                                "land"};
  mission->faults = faults;
  auto run = fly_formation(*mission);
  EXPECT_TRUE(run);
  EXPECT_TRUE(run->held()) << text_of(*run);
  return *run;
}

TEST(FormationRuns, WhoStartsAnewOnItsWayIsTakenAlong) {
  const auto run = fly({fault({VehicleId{3}}, 4.0, 1.0)});
  EXPECT_TRUE(run.script_done) << run.reason;
}

TEST(FormationRuns, WhoStartsAnewInItsPlaceIsTakenAlong) {
  const auto run = fly({fault({VehicleId{3}}, 25.0, 1.0)});
  EXPECT_TRUE(run.script_done) << run.reason;
}

TEST(FormationRuns, ANewGroundStationGoesOnOnceAllAreHeard) {
  const auto run = fly({fault({kGroundStation}, 4.0, 6.0)});
  EXPECT_TRUE(run.script_done) << run.reason;
}

TEST(FormationRuns, ANewGroundStationRecallsWhoMayBeInTheWay) {
  const auto run =
      fly({fault({kGroundStation}, 4.0, 6.0), fault({VehicleId{4}}, 5.0, std::nullopt)});
  EXPECT_TRUE(run.script_done) << run.reason;
  EXPECT_EQ(run.lost, 1U);
}

TEST(FormationRuns, WithoutGroundStationEverybodyComesToItsPlace) {
  const auto run = fly({fault({kGroundStation}, 4.0, std::nullopt)});
  EXPECT_EQ(run.reason, "the ground station is lost");
}

/// The scenario's own time line, as on the bench.
FormationRun fly_scenario_with(configuration::FaultKind kind, double at_s, double for_s,
                               const std::vector<VehicleId>& who) {
  auto scenario = five();
  configuration::Fault fault;
  fault.kind = kind;
  fault.at = at_seconds(at_s);
  fault.duration = from_seconds(for_s);
  if (!who.empty()) fault.vehicle = who.front();
  fault.groups = {who};
  fault.loss_ratio = 1.0;
  scenario.faults = {fault};
  const auto mission = seeded_mission(scenario, 1, "none");
  EXPECT_TRUE(mission);
  const auto run = fly_formation(*mission);
  EXPECT_TRUE(run);
  EXPECT_TRUE(run->held()) << text_of(*run);
  return *run;
}

TEST(FormationRuns, AScenariosFaultsAreDone) {
  using configuration::FaultKind;
  const auto undisturbed = fly_formation(*seeded_mission(five(), 1, "none"));
  ASSERT_TRUE(undisturbed);
  EXPECT_EQ(fly_scenario_with(FaultKind::kill_vehicle, 40.0, 0.0, {{2}}).lost, 1U);
  EXPECT_EQ(fly_scenario_with(FaultKind::kill_vehicle, 40.0, 0.0, {kGroundStation}).reason,
            "the ground station is lost");
  for (const auto& run : {fly_scenario_with(FaultKind::loss, 40.0, 20.0, {}),
                          fly_scenario_with(FaultKind::partition, 70.0, 20.0, {{3}})}) {
    EXPECT_TRUE(run.script_done) << run.reason;
    EXPECT_GT(run.ended_at, undisturbed->ended_at);
  }
}

TEST(FormationRuns, TheJudgeSeesWhoComesTooNear) {
  auto mission = seeded_mission(five(), 1, "none");
  ASSERT_TRUE(mission);
  // Two vehicles that no ground station asks to keep apart.
  mission->vehicles[1].start = mission->vehicles[0].start;
  mission->vehicles[1].start.x_m += 1.0;
  mission->formation->script = {"take-off"};
  mission->formation->separation = {0.5, 0.5};
  mission->formation->tracking_m = 0.1;
  mission->formation->reserve_m = 0.1;
  auto run = fly_formation(*mission);
  ASSERT_TRUE(run);
  EXPECT_NEAR(run->least_m, 1.0, 0.5);
  mission->formation->separation = {2.0, 2.0};
  run = fly_formation(*mission);
  ASSERT_TRUE(run);
  EXPECT_FALSE(run->script_done);
  EXPECT_NE(run->reason.find("of each other"), std::string::npos) << run->reason;
}

TEST(FormationRuns, BodiesOfSixDegreesOfFreedomFlyItToo) {
  auto mission = seeded_mission(five(), 1, "none");
  ASSERT_TRUE(mission);
  for (auto& vehicle : mission->vehicles) vehicle.body = Body::hexarotor;
  mission->formation->script = {"take-off", "form wedge spacing 5 at 0 40 20", "land"};
  const auto run = fly_formation(*mission);
  ASSERT_TRUE(run);
  EXPECT_TRUE(run->held()) << text_of(*run);
  EXPECT_TRUE(run->script_done) << run->reason;
}

TEST(FormationRuns, AShapeIsNotFlownFromTheGround) {
  auto mission = seeded_mission(five(), 1, "none");
  ASSERT_TRUE(mission);
  mission->formation->script = {"form wedge spacing 5 at 24 0 20"};
  mission->duration_max = std::chrono::seconds{60};
  std::string sentence;
  double highest_m = 0.0;
  std::set<std::string> states;
  TeamObserver watcher;
  watcher.ground_event = [&](const mission::MissionEvent& event) {
    const auto* waits = std::get_if<mission::event::OrderWaits>(&event.body);
    if (waits != nullptr) sentence = waits->detail;
  };
  watcher.bodies = [&](Instant, const std::vector<SeenBody>& bodies) {
    for (const SeenBody& body : bodies) highest_m = std::max(highest_m, body.position_m.z());
  };
  watcher.moment = [&](Instant, const mission::GroundNode& node, const std::vector<OwnWord>&) {
    for (const auto& [id, entry] : node.fleet().vehicles()) {
      if (!entry.telemetry) continue;
      states.insert(
          words_of(mission::shown_state(entry.telemetry->activity, entry.telemetry->detail)));
    }
  };
  (void)simulate_team(*mission, watcher);
  EXPECT_NE(sentence.find("nobody is flown to the side below 2.0 m; order 'take-off' first"),
            std::string::npos)
      << sentence;
  EXPECT_LT(highest_m, 0.5);
  EXPECT_EQ(states, std::set<std::string>{"on the ground"});
}

TEST(FormationRuns, PlanesInCoalitionsAndCoptersInFormationFlyInOneMission) {
  auto scenario =
      configuration::load_scenario(std::string{SKEIN_SOURCE_DIR} + "/scenarios/coalition-6.yaml");
  ASSERT_TRUE(scenario) << scenario.error().message;
  TeamMission mission = team_mission(*scenario);
  const auto formation = seeded_mission(five(), 1, "none");
  ASSERT_TRUE(formation);
  for (SimulatedVehicle copter : formation->vehicles) {
    copter.spec.id.value = static_cast<std::uint16_t>(copter.spec.id.value + 100);
    mission.vehicles.push_back(copter);
  }
  mission.formation = formation->formation;
  mission.formation->script = {"take-off", "form wedge spacing 5 at 0 40 20", "land"};
  std::size_t changes = 0;
  TeamObserver watcher;
  watcher.event = [&](const mission::MissionEvent& event) {
    if (event.kind() == mission::EventKind::change_begun && event.vehicle == kGroundStation) {
      ++changes;
    }
  };
  const auto run = fly_formation(mission, watcher);
  ASSERT_TRUE(run);
  EXPECT_TRUE(run->held()) << text_of(*run);
  EXPECT_TRUE(run->script_done) << run->reason;
  EXPECT_EQ(changes, 3U);
  EXPECT_EQ(simulate_team(mission, {}).sites_done, mission.sites.size());
}

TEST(FormationRuns, FaultsThatThereAreNotAreRefused) {
  EXPECT_FALSE(seeded_mission(five(), 1, "lossy"));
}

}  // namespace
}  // namespace skein::hil
