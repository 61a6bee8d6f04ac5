// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>

#include "commands.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/hil/team_mission.hpp"

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
                                     EventKind::warning};
  return std::find(kKinds.begin(), kKinds.end(), kind) != kKinds.end();
}

}  // namespace

int simulate(const SimulateArguments& arguments) {
  auto scenario = configuration::load_scenario(arguments.scenario);
  if (!scenario) {
    fmt::print(stderr, "{}\n", scenario.error().message);
    return kExitBadInput;
  }
  if (const auto flyable = configuration::check(*scenario); !flyable) {
    fmt::print(stderr, "{}\n", flyable.error().message);
    return kExitBadInput;
  }
  if (arguments.seed) scenario->seed = *arguments.seed;
  TeamObserver observer;
  observer.event = [&](const mission::MissionEvent& event) {
    if (arguments.trace || of_interest(event.kind)) fmt::print("{}\n", trace_line(event));
  };
  const auto result = simulate_team(team_mission(*scenario), observer);
  const bool done = result.sites_done == scenario->sites.size();
  fmt::print(
      "{}: {} of {} sites done after {:.1f} s of mission time, {} messages, {} protocol errors\n",
      done ? "DONE" : "NOT DONE", result.sites_done, scenario->sites.size(),
      to_seconds(result.ended_at), result.messages, result.protocol_errors);
  return done && result.protocol_errors == 0 ? kExitHeld : kExitViolated;
}

}  // namespace skein::hil
