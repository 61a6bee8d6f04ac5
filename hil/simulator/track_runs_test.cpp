// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "skein/hil/formation_runs.hpp"
#include "skein/hil/team_mission.hpp"
#include "skein/wording/wording.hpp"

namespace skein::hil {
namespace {

configuration::Scenario planes() {
  auto scenario = configuration::load_scenario(std::string{SKEIN_SOURCE_DIR} +
                                               "/scenarios/formation-planes-5.yaml");
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

TEST(TrackRuns, PlanesFlyALapAndChangeTheirShape) {
  const auto runs = fly_formations(planes(), {"none", 1, 5, 1});
  ASSERT_TRUE(runs) << runs.error().message;
  for (const FormationRun& run : *runs) {
    EXPECT_TRUE(run.held()) << text_of(run);
    EXPECT_TRUE(run.script_done) << run.reason;
    EXPECT_EQ(run.changes, 2U);
    EXPECT_GT(run.worst_rms_m, 0.1);  // it was judged
  }
}

/// The judge sees what planes do: with places that they cannot keep, it tells.
TEST(TrackRuns, PlacesThatAreNotKeptAreTold) {
  configuration::Scenario scenario = planes();
  scenario.expect.place_rms_m = 0.1;
  const auto run = fly_formation(*seeded_mission(scenario, 1, "none"));
  ASSERT_TRUE(run) << run.error().message;
  ASSERT_FALSE(run->held());
  EXPECT_EQ(run->violations.front().check, "place");
}

TEST(TrackRuns, TeamsWithFaultsKeepApart) {
  const auto runs = fly_formations(planes(), {"mixed", 1, 20, 1});
  ASSERT_TRUE(runs) << runs.error().message;
  std::size_t done = 0;
  for (const FormationRun& run : *runs) {
    EXPECT_TRUE(run.held()) << text_of(run)
                            << "  skein-hil simulate scenarios/formation-planes-5.yaml"
                            << " --faults mixed --trace --seed " << run.seed;
    done += run.script_done ? 1 : 0;
  }
  EXPECT_GT(done, 8U);
}

struct Flown {
  FormationRun run;
  std::vector<mission::event::FormationNews> news;
};

Flown fly_with(Fault fault) {
  auto mission = seeded_mission(planes(), 1, "none");
  EXPECT_TRUE(mission);
  mission->faults = {std::move(fault)};
  Flown flown;
  TeamObserver observer;
  observer.event = [&](const mission::MissionEvent& event) {
    const auto* warning = std::get_if<mission::event::FormationWarning>(&event.body);
    if (warning != nullptr) flown.news.push_back(warning->news);
  };
  auto run = fly_formation(*mission, observer);
  EXPECT_TRUE(run);
  EXPECT_TRUE(run->held()) << text_of(*run);
  flown.run = *std::move(run);
  return flown;
}

Fault program_ends(VehicleId who, double after_s, std::optional<double> lasts_s) {
  Fault fault{{.change = 0, .after = from_seconds(after_s)}, {}, ProgramsEnd{{who}}};
  if (lasts_s) fault.lasts = from_seconds(*lasts_s);
  return fault;
}

TEST(TrackRuns, ALostPlaneIsToldOfAndTheOthersFlyOn) {
  const Flown flown = fly_with(program_ends({3}, 20.0, std::nullopt));
  ASSERT_FALSE(flown.news.empty());
  EXPECT_EQ(flown.news.front(), mission::event::FormationNews::lost_on_track);
  EXPECT_TRUE(flown.run.script_done) << flown.run.reason;
}

TEST(TrackRuns, WithoutGroundStationPlanesFlyTheirTrackToItsEnd) {
  const Flown flown = fly_with(program_ends(kGroundStation, 8.0, std::nullopt));
  EXPECT_EQ(flown.run.reason, "the ground station is lost");
  EXPECT_GT(flown.run.ended_at, at_seconds(200.0));
}

TEST(TrackRuns, WithoutRadioPlanesFlyWhatTheyHaveTakenUp) {
  Fault silence{{.change = 0, .after = from_seconds(8.0)},
                from_seconds(15.0),
                radio::Disturbance{.loss = 1.0}};
  const Flown flown = fly_with(silence);
  EXPECT_FALSE(flown.news.empty());
  EXPECT_TRUE(flown.run.script_done) << flown.run.reason;
}

}  // namespace
}  // namespace skein::hil
