// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

#include "commands.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/hil/fault_profiles.hpp"
#include "skein/hil/judged_runs.hpp"
#include "skein/hil/team_mission.hpp"
#include "skein/hindsight/hindsight.hpp"
#include "skein/series/run_row.hpp"
#include "skein/series/summary.hpp"

namespace skein::hil {
namespace {

/// What a reader of a mission wants to see first.
bool of_interest(mission::EventKind kind) {
  using mission::EventKind;
  static constexpr std::array kKinds{EventKind::site_detected,
                                     EventKind::survey_done,
                                     EventKind::coalition_formed,
                                     EventKind::monitoring,
                                     EventKind::authorisation_late,
                                     EventKind::task_done,
                                     EventKind::task_failed,
                                     EventKind::conflict_yielded,
                                     EventKind::site_done,
                                     EventKind::authorisation_refused,
                                     EventKind::authorisation_withdrawn};
  return mission::is_warning(kind) || std::find(kKinds.begin(), kKinds.end(), kind) != kKinds.end();
}

int fly_one(const configuration::Scenario& scenario, const SimulateArguments& arguments) {
  const auto mission = seeded_mission(scenario, scenario.seed, arguments.faults);
  if (arguments.trace) fmt::print("{}", describe(*mission));
  TeamObserver watcher;
  watcher.event = [&](const mission::MissionEvent& event) {
    if (arguments.trace || of_interest(event.kind())) fmt::print("{}\n", trace_line(event));
  };
  watcher.fault = [](const FaultEvent& event) { fmt::print("{}\n", trace_line(event)); };
  const auto limits = limits_of(scenario.expect);
  checks::RunRecord record;
  const auto run = fly_judged(*mission, limits, watcher, &record);
  fmt::print(
      "{}: {} of {} sites done after {:.1f} s of mission time, {} messages, {} protocol errors\n",
      run.sites_done ? "DONE" : "NOT DONE", run.result.sites_done, scenario.sites.size(),
      to_seconds(run.result.ended_at), run.result.messages, run.result.protocol_errors);
  for (const auto& [task, why] : record.excused) {
    fmt::print("not to be done: {}: {}\n", to_string(task), why);
  }
  const auto hindsight = hindsight::look_back(record, limits, hindsight::kFewSteps);
  const std::string compared = hindsight::comparison_text(hindsight);
  fmt::print("{}", hindsight ? "\n" + compared + "\n" : compared);
  for (const auto& excused : run.excused) fmt::print("EXCUSED: {}\n", excused.sentence);
  if (!run.held()) fmt::print("VIOLATED:\n");
  fmt::print("{}", series::broken_lines(series::row_of(run), false));
  return run.held() ? kExitHeld : kExitViolated;
}

}  // namespace

int simulate(const SimulateArguments& arguments) {
  auto scenario = configuration::load_flyable_scenario(arguments.scenario);
  if (!scenario) {
    fmt::print(stderr, "{}\n", scenario.error().message);
    return kExitBadInput;
  }
  if (scenario->flies_routes()) {
    fmt::print(stderr, "planned routes are flown by `skein-hil run` only\n");
    return kExitBadInput;
  }
  if (arguments.seed) scenario->seed = *arguments.seed;
  if (const auto given = give_routes(*scenario, arguments.routes); !given) {
    return complain(given.error());
  }
  if (wants_an_operator(*scenario)) {
    fmt::print(stderr,
               "nobody is there to authorise deliveries, so none is flown: the scenario has no "
               "operator_decisions\n");
  }
  if (arguments.runs) return simulate_many(*scenario, arguments);
  if (scenario->flies_formation()) return simulate_formation(*scenario, arguments);
  if (const auto faults = fault_params(arguments.faults, scenario->seed); !faults) {
    fmt::print(stderr, "{}\n", faults.error().message);
    return kExitBadInput;
  }
  return fly_one(*scenario, arguments);
}

}  // namespace skein::hil
