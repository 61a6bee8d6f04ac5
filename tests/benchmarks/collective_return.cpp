// SPDX-License-Identifier: Apache-2.0
//
// Ways home of a whole team, planned together: vehicles all over 5 by 8 km, homes 20 m apart in a
// row. At one height every pair can meet; at heights of their own only the arrivals' spacing is
// left to plan.
#include "skein/planning/collective_return.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"

namespace skein::planning {
namespace {

std::vector<ReturningVehicle> team(std::size_t count, bool one_height, std::uint64_t seed) {
  Random random{seed};
  std::vector<ReturningVehicle> all;
  while (all.size() < count) {
    ReturningVehicle v;
    v.id = VehicleId{static_cast<std::uint16_t>(all.size() + 1)};
    v.start = {random.uniform(500.0, 5500.0), random.uniform(-4000.0, 4000.0),
               random.uniform(-kPi, kPi)};
    v.height_m = one_height ? 100.0 : 40.0 + 10.0 * static_cast<double>(all.size());
    v.speed_mps = 22.0;
    v.speed_min_mps = 20.0;
    v.turn_radius_m = 60.0;
    v.range_left_m = 40'000.0;
    v.home = {0.0, 20.0 * static_cast<double>(all.size())};
    const bool alone = std::ranges::all_of(all, [&](const ReturningVehicle& other) {
      const double apart_m = (other.start.position() - v.start.position()).norm();
      return other.height_m != v.height_m || apart_m > 300.0;
    });
    if (alone) all.push_back(v);
  }
  return all;
}

void collective_return(benchmark::State& state, bool one_height) {
  const auto count = static_cast<std::size_t>(state.range(0));
  ReturnParams params;
  params.arrival_spacing = std::chrono::seconds{10};
  const std::vector<Hazard> hazards{Hazard{{1}, {200.0, -1800.0}, 300.0},
                                    Hazard{{2}, {250.0, 2500.0}, 250.0}};
  std::vector<std::vector<ReturningVehicle>> teams;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) teams.push_back(team(count, one_height, seed));
  std::size_t n = 0;
  double failures = 0.0;
  double last_s = 0.0;
  for (auto _ : state) {
    const auto plan = plan_return(params, teams[n++ % teams.size()], hazards);
    failures += static_cast<double>(plan.failures.size());
    last_s += to_seconds(plan.last_arrival);
  }
  state.counters["without_a_way"] =
      benchmark::Counter(failures, benchmark::Counter::kAvgIterations);
  state.counters["last_arrival_s"] = benchmark::Counter(last_s, benchmark::Counter::kAvgIterations);
}
BENCHMARK_CAPTURE(collective_return, skein / one_height, true)
    ->Name("collective_return/skein/one_height")
    ->Arg(10)
    ->Arg(50)
    ->Iterations(5)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(collective_return, skein / own_heights, false)
    ->Name("collective_return/skein/own_heights")
    ->Arg(50)
    ->Arg(200)
    ->Iterations(5)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace skein::planning
