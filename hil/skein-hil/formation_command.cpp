// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>

#include "commands.hpp"
#include "progress_line.hpp"
#include "skein/change_trials/change_trials.hpp"
#include "skein/hil/formation_runs.hpp"
#include "skein/hil/judged_runs.hpp"
#include "skein/hil/run_parallel.hpp"
#include "skein/series/run_row.hpp"
#include "skein/series/summary.hpp"
#include "skein/wording/wording.hpp"

namespace skein::hil {
namespace {

/// Failing seeds that are told of in full.
constexpr std::size_t kFailuresShown = 20;

std::string who(VehicleId vehicle) {
  return vehicle == kGroundStation ? "-" : fmt::format("U{}", vehicle.value);
}

}  // namespace

int simulate_formation(const configuration::Scenario& scenario,
                       const SimulateArguments& arguments) {
  const auto mission = seeded_mission(scenario, scenario.seed, arguments.faults);
  if (!mission) return complain(mission.error());
  if (arguments.trace) {
    for (const auto& line : mission->formation->script) fmt::print("script: {}\n", line);
    fmt::print("{}", describe(*mission));
  }
  TeamObserver watcher;
  watcher.event = [&](const mission::MissionEvent& event) {
    const bool news = event.vehicle == kGroundStation || mission::is_warning(event.kind());
    if (!arguments.trace && !news) return;
    fmt::print("{:8.2f} {:<4} {} {}\n", to_seconds(event.time), who(event.vehicle),
               mission::to_string(event.kind()), wording::news_of(event));
  };
  watcher.fault = [](const FaultEvent& event) {
    fmt::print("{:8.2f} {:<4} FAULT {}\n", to_seconds(event.time), who(event.vehicle),
               text_of(event));
  };
  const auto run = fly_formation(*mission, watcher);
  if (!run) return complain(run.error());
  fmt::print(
      "{} after {:.1f} s of mission time: {} changes, {:.2f} m between two vehicles at least, "
      "{} messages\n",
      run->script_done ? "DONE" : "HELD", to_seconds(run->ended_at), run->changes, run->least_m,
      run->messages);
  if (!run->script_done) fmt::print("why: {}\n", run->reason);
  if (!run->held()) fmt::print("VIOLATED:\n");
  fmt::print("{}", series::broken_lines(series::row_of(*run), true));
  return run->held() ? kExitHeld : kExitViolated;
}

int changes(const ChangesArguments& arguments) {
  ProgressLine line{arguments.runs};
  using change_trials::JudgedChange;
  const auto all = change_trials::try_changes(
      arguments.first_seed, arguments.runs, jobs_of(arguments.jobs),
      [&](const JudgedChange& change) { line.count(change.violation.empty()); });
  line.clear();
  std::map<std::string, std::size_t> ways;
  std::size_t violated = 0;
  std::size_t refused_exact = 0;
  std::size_t refused_random = 0;
  double least_beyond = 1e9;
  for (const JudgedChange& change : all) {
    if (!change.refused.empty()) {
      ++(change.random_assignment ? refused_random : refused_exact);
      continue;
    }
    ++ways[std::string{formation::to_string(change.way)}];
    least_beyond = std::min(least_beyond, change.least_m - change.wanted_m);
    if (change.violation.empty() || ++violated > kFailuresShown) continue;
    fmt::print("seed {} VIOLATED: {}\n  again: {} changes --first-seed {} --runs 1\n", change.seed,
               change.violation, arguments.program, change.seed);
  }
  fmt::print("changes    {}, seeds {} to {}\n", all.size(), all.front().seed, all.back().seed);
  for (const auto& [way, count] : ways) fmt::print("{:<10} {}\n", way, count);
  fmt::print("refused    {} with places given out at random, {} by least squares\n", refused_random,
             refused_exact);
  fmt::print("violated   {}\n", violated);
  fmt::print("separation and reserve: {:+.4f} m at least beyond them\n", least_beyond);
  fmt::print("{}\n", violated == 0 ? "PASS" : "FAIL");
  return violated == 0 ? kExitHeld : kExitViolated;
}

}  // namespace skein::hil
