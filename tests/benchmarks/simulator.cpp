// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <string>

#include "skein/base/time.hpp"
#include "skein/experiments/grid.hpp"
#include "skein/hil/judged_runs.hpp"
#include "skein/hil/team_mission.hpp"

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

/// The first minute of 1,000 vehicles in 28 km by 28 km that search around 16 sites, of which they
/// find some and form coalitions: with that range of the radio, and of the protocol.
void thousand(benchmark::State& state, double range_m, Duration duration) {
  constexpr double kHalf_m = 14000.0;
  constexpr double kStep_m = 7000.0;
  auto base = scenario("coalition-32");
  if (!base) return state.SkipWithError(base.error().message.c_str());
  const auto kinds = base->sites;
  base->sites.clear();
  base->operator_decisions.clear();
  for (std::uint16_t i = 0; i < 16; ++i) {
    skein::Site site = kinds[i % kinds.size()];
    site.id = skein::SiteId{static_cast<std::uint16_t>(i + 1)};
    const int row = i / 4;
    site.position = {kStep_m * (i % 4 - 1.5), kStep_m * (row - 1.5)};
    base->sites.push_back(site);
    base->operator_decisions.push_back({.site = site.id, .reaction = std::chrono::seconds{3}});
  }
  base->vehicles = skein::experiments::draw_team(
      {.west_m = -kHalf_m, .east_m = kHalf_m, .south_m = -kHalf_m, .north_m = kHalf_m}, *base, 1000,
      1);
  base->radio.range_m = base->protocol.radio_range_m = range_m;
  base->duration_max = duration;
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
