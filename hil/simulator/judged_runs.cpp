// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/judged_runs.hpp"

#include <algorithm>
#include <utility>

#include "skein/base/assert.hpp"
#include "skein/hil/run_parallel.hpp"
#include "skein/hil/team_mission.hpp"
#include "skein/hil/team_record.hpp"

namespace skein::hil {
namespace {

checks::CheckResult protocol_errors(const TeamResult& result) {
  checks::CheckResult check{"protocol errors",
                            "no input without an entry in a state machine's table",
                            1,
                            "mission",
                            "",
                            {}};
  if (result.protocol_errors > 0) {
    check.violations.push_back({kGroundStation, result.ended_at,
                                std::to_string(result.protocol_errors) +
                                    " inputs met a state that has no entry for them"});
  }
  return check;
}

}  // namespace

JudgedRun fly_judged(const TeamMission& mission, const checks::Limits& limits,
                     const TeamObserver& watcher, checks::RunRecord* record) {
  TeamRecorder recorder{mission, watcher};
  const TeamObserver observer = recorder.observer();
  JudgedRun run;
  run.seed = mission.seed;
  run.result = simulate_team(mission, observer);
  run.sites_done = run.result.sites_done == mission.sites.size();

  checks::Limits held_to = limits;
  const auto off = [](const Fault& fault) { return std::holds_alternative<ClockOff>(fault.what); };
  if (std::any_of(mission.faults.begin(), mission.faults.end(), off)) {
    allow_for_clocks(held_to, mission.protocol);
  }
  const checks::RunRecord& recorded = recorder.finish(run.result);
  run.broken = checks::judge(recorded, held_to);
  if (record != nullptr) *record = recorded;
  run.broken.push_back(protocol_errors(run.result));
  for (const auto& check : run.broken) {
    run.excused.insert(run.excused.end(), check.excused.begin(), check.excused.end());
  }
  std::erase_if(run.broken, [](const auto& check) { return check.held(); });
  return run;
}

std::vector<JudgedRun> fly_series(const configuration::Scenario& scenario, const RunSeries& series,
                                  const std::function<void(const JudgedRun&)>& on_done) {
  const checks::Limits limits = limits_of(scenario.expect);
  const auto fly = [&](std::size_t i) -> Result<JudgedRun> {
    const auto mission = seeded_mission(scenario, series.first_seed + i, series.faults);
    if (!mission) return mission.error();
    return fly_judged(*mission, limits);
  };
  auto runs = run_parallel<JudgedRun>(series.runs, series.jobs, fly, on_done);
  SKEIN_ASSERT(runs.ok());
  return std::move(*runs);
}

}  // namespace skein::hil
