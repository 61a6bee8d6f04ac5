// SPDX-License-Identifier: Apache-2.0
// A grant that the operator takes back, in whole missions: what has not begun when its vehicle
// hears it is not flown, whatever the radio and the programs do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <thread>
#include <utility>

#include "skein/hil/fault_profiles.hpp"
#include "skein/hil/judged_runs.hpp"
#include "skein/hil/team_mission.hpp"

namespace skein::hil {
namespace {

using mission::EventKind;
using ::testing::IsEmpty;

configuration::Scenario scenario(const std::string& name) {
  auto loaded =
      configuration::load_scenario(std::string{SKEIN_SOURCE_DIR} + "/scenarios/" + name + ".yaml");
  if (!loaded) throw std::runtime_error(loaded.error().message);
  return *std::move(loaded);
}

struct Flown {
  JudgedRun run;
  int taken_back = 0;  ///< by the operator
  int begun = 0;       ///< deliveries at the site, before or after
  int held = 0;        ///< vehicles that have given a granted delivery up for it
};

Flown fly(const TeamMission& team, SiteId site) {
  Flown flown;
  TeamObserver watcher;
  watcher.event = [&](const mission::MissionEvent& e) {
    if (e.task.site != site) return;
    const bool ground = e.vehicle == kGroundStation;
    if (e.kind() == EventKind::authorisation_withdrawn) ++(ground ? flown.taken_back : flown.held);
    const bool delivery = e.task.kind == TaskKind::deliver;
    if (delivery && e.kind() == EventKind::task_started) ++flown.begun;
  };
  flown.run = fly_judged(team, limits_of(scenario("coalition-6").expect), watcher);
  return flown;
}

TEST(TakeBackRuns, OnlyWhatHasBegunByThenIsFlown) {
  TeamMission whole = team_mission(scenario("coalition-6"));
  Duration offset{};  // one after another: there is a time between their gates
  for (auto& delivery : whole.sites.front().deliveries) {
    delivery.offset = std::exchange(offset, offset + std::chrono::seconds{6});
  }
  const SiteId site = whole.sites.front().id;
  const auto wanted = static_cast<int>(whole.sites.front().deliveries.size());
  ASSERT_EQ(fly(whole, site).begun, wanted);
  bool some = false;
  bool none = false;
  bool all = false;
  for (double after_s = 0.0; after_s < 60.0; after_s += 2.5) {
    TeamMission team = whole;
    team.faults.push_back({{}, {}, GrantTakenBack{site, from_seconds(after_s)}});
    const Flown flown = fly(team, site);
    SCOPED_TRACE(after_s);
    EXPECT_THAT(flown.run.broken, IsEmpty());
    if (flown.taken_back == 0) {  // it is too late: all have begun
      EXPECT_EQ(flown.begun, wanted);
      all = true;
      continue;
    }
    EXPECT_EQ(flown.begun + flown.held, wanted);
    none = none || flown.begun == 0;
    some = some || flown.begun > 0;
  }
  EXPECT_TRUE(none);
  EXPECT_TRUE(all);
  EXPECT_TRUE(some || wanted < 2) << "none was taken back between two gates";
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr std::size_t kShare = 25;  ///< sanitizers are slow
#else
constexpr std::size_t kShare = 1;
#endif

class Disturbed : public testing::TestWithParam<const char*> {};

TEST_P(Disturbed, NoDeliveryBeginsOnceItsVehicleHasHeardIt) {
  RunSeries series;
  series.faults = std::string{"taken-back"} + GetParam();
  series.runs = std::max<std::size_t>(4, 40 / kShare);
  series.jobs = std::max(1U, std::thread::hardware_concurrency());
  std::string broken;
  for (const auto& run : fly_series(scenario("faults-8"), series)) {
    for (const auto& check : run.broken) {
      broken += "seed " + std::to_string(run.seed) + ", " + check.name + ": " +
                check.violations.front().sentence + "\n";
    }
  }
  EXPECT_EQ(broken, "");
}
INSTANTIATE_TEST_SUITE_P(TakeBackRuns, Disturbed,
                         testing::Values("", ",lossy", ",partition", ",crash", ",lossy,ground",
                                         ",clocks,orders", ",operator,partition,crash"));

/// Which are the seeds above worth? In some of them a grant is taken back in time.
TEST(TakeBackRuns, TheSeriesTakeGrantsBackBeforeAndAfterTheGate) {
  int taken_back = 0;
  int held = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const auto team = seeded_mission(scenario("faults-8"), seed, "taken-back,lossy");
    ASSERT_TRUE(team);
    for (const Fault& fault : team->faults) {
      const auto* back = std::get_if<GrantTakenBack>(&fault.what);
      if (back == nullptr) continue;
      const Flown flown = fly(*team, back->site);
      taken_back += flown.taken_back;
      held += flown.held;
    }
  }
  EXPECT_GE(taken_back, 4);
  EXPECT_GE(held, 4);
}

}  // namespace
}  // namespace skein::hil
