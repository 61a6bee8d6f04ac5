// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <string>

#include "skein/hil/judged_runs.hpp"
#include "skein/hil/team_mission.hpp"

namespace {

/// A whole mission of 32 vehicles, from take-off to the last assessment: the simulated team alone,
/// and with the judges that read its record.
void mission(benchmark::State& state, const char* scenario_name, const char* faults, bool judged) {
  using namespace skein::hil;  // NOLINT(google-build-using-namespace)
  const auto scenario = skein::configuration::load_scenario(std::string{SKEIN_SCENARIOS} + "/" +
                                                            scenario_name + ".yaml");
  if (!scenario) return state.SkipWithError(scenario.error().message.c_str());
  const auto mission = seeded_mission(*scenario, 1, faults);
  if (!mission) return state.SkipWithError(mission.error().message.c_str());
  while (state.KeepRunning()) {
    if (judged) {
      const JudgedRun run = fly_judged(*mission, limits_of(scenario->expect));
      if (!run.sites_done || !run.held()) return state.SkipWithError("the mission did not hold");
    } else {
      benchmark::DoNotOptimize(simulate_team(*mission, {}));
    }
  }
}

BENCHMARK_CAPTURE(mission, alone, "coalition-32", "none", false)
    ->Name("mission_32/skein/alone")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(mission, judged, "coalition-32", "none", true)
    ->Name("mission_32/skein/judged")
    ->Unit(benchmark::kMillisecond);

}  // namespace
