// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <string>

#include "skein/base/time.hpp"
#include "skein/hil/judged_runs.hpp"
#include "skein/hil/team_mission.hpp"
#include "thousand.hpp"

namespace {

using namespace skein::hil;  // NOLINT(google-build-using-namespace)
using skein::Duration;
using skein::Result;
using skein::configuration::Scenario;

Result<Scenario> scenario(const char* name) {
  return skein::configuration::load_scenario(std::string{SKEIN_SCENARIOS} + "/" + name + ".yaml");
}

/// Mission seconds in one of the processor's.
void count_speed(benchmark::State& state, const TeamResult& result) {
  state.counters["times_real_time"] = benchmark::Counter{
      skein::to_seconds(result.ended_at), benchmark::Counter::kIsIterationInvariantRate};
}

/// A whole mission of 32 vehicles, from take-off to the last assessment: the simulated team alone,
/// and with the judges that read its record.
void mission(benchmark::State& state, const char* scenario_name, const char* faults, bool judged) {
  const auto base = scenario(scenario_name);
  if (!base) return state.SkipWithError(base.error().message.c_str());
  const auto mission = seeded_mission(*base, 1, faults);
  if (!mission) return state.SkipWithError(mission.error().message.c_str());
  TeamResult result;
  while (state.KeepRunning()) {
    if (judged) {
      const JudgedRun run = fly_judged(*mission, limits_of(base->expect));
      if (!run.sites_done || !run.held()) return state.SkipWithError("the mission did not hold");
      result = run.result;
    } else {
      result = simulate_team(*mission, {});
    }
  }
  count_speed(state, result);
}

BENCHMARK_CAPTURE(mission, alone, "coalition-32", "none", false)
    ->Name("mission_32/skein/alone")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(mission, judged, "coalition-32", "none", true)
    ->Name("mission_32/skein/judged")
    ->Unit(benchmark::kMillisecond);

/// The first minute of 1,000 vehicles, or less.
void thousand(benchmark::State& state, double range_m, Duration duration) {
  const auto base = thousand_vehicles(range_m, duration);
  if (!base) return state.SkipWithError(base.error().message.c_str());
  const TeamMission mission = team_mission(*base);
  TeamResult result;
  while (state.KeepRunning()) result = simulate_team(mission, {});
  count_speed(state, result);
}

BENCHMARK_CAPTURE(thousand, usual_range, 1500.0, std::chrono::seconds{60})
    ->Name("mission_1000/skein/usual_range")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(thousand, all_in_range, 100000.0, std::chrono::seconds{20})
    ->Name("mission_1000/skein/all_in_range")
    ->Unit(benchmark::kMillisecond);

}  // namespace
