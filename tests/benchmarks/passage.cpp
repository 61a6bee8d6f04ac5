// SPDX-License-Identifier: Apache-2.0
//
// What keeping clear of each other costs on board: the antipodal swap, on the rim of its
// roundabout, where everybody is near others. Real time over agents and control periods; messages
// are taken in from those within reach of the radio.
#include "skein/formation/passage.hpp"

#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/formation/change_planner.hpp"

namespace skein::formation {
namespace {

constexpr Duration kPeriod = std::chrono::milliseconds{20};
constexpr int kTalkEvery = 3;

PlannedChange swap_of(std::size_t agents) {
  ChangeRequest request;
  request.limits = {3.0, 2.0, 4.0};
  request.reserve_m = 0.9;
  const double apart = request.separation.horizontal_m + request.reserve_m;
  const double radius = 1.1 * apart / (2.0 * std::sin(kPi / static_cast<double>(agents))) + 10.0;
  for (std::size_t i = 0; i < agents; ++i) {
    const Vec2 at =
        radius * unit_vector(2.0 * kPi * static_cast<double>(i) / static_cast<double>(agents));
    request.transfers.push_back(
        {{static_cast<std::uint16_t>(i + 1)}, {at.x(), at.y(), 20.0}, {-at.x(), -at.y(), 20.0}});
  }
  return plan_change(request).value();
}

void passage(benchmark::State& state) {
  const auto agents = static_cast<std::size_t>(state.range(0));
  PlannedChange planned = swap_of(agents);
  planned.change.number = 1;
  std::vector<std::unique_ptr<Passage>> team;
  for (std::size_t i = 0; i < agents; ++i) {
    team.push_back(std::make_unique<Passage>(planned.change, i, PassageParams{}, Instant{}));
  }
  Instant now{};
  double far = 0.0;
  int periods = 0;
  std::vector<Progress> said(agents);
  // One agent after the other takes in what it hears and has its period, as each would on a
  // computer of its own: only the period is timed.
  const auto period = [&] {
    now += kPeriod;
    const bool hears = periods++ % kTalkEvery == 0;
    for (std::size_t i = 0; i < agents && hears; ++i) said[i] = team[i]->progress();
    std::chrono::nanoseconds taken{};
    for (std::size_t i = 0; i < agents; ++i) {
      for (std::size_t j = 0; j < agents && hears; ++j) {
        if (i != j) team[i]->on_progress(j, said[j]);
      }
      const auto begin = std::chrono::steady_clock::now();
      team[i]->step(now);
      far += team[i]->reference(now).position_m.x();
      taken += std::chrono::steady_clock::now() - begin;
    }
    return std::chrono::duration<double>(taken).count();
  };
  const Instant on_rim = at_seconds(0.2 * to_seconds(planned.duration));
  while (now < on_rim) period();
  for (auto _ : state) state.SetIterationTime(period());
  benchmark::DoNotOptimize(far);
  state.counters["s_per_agent_and_period"] = benchmark::Counter(
      static_cast<double>(agents),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(passage)
    ->Name("passage/skein")
    ->Arg(32)
    ->Arg(250)
    ->Arg(1000)
    ->Iterations(250)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace skein::formation
