// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/checks/checks.hpp"
#include "skein/checks/run_record.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/hil/team_mission.hpp"
#include "skein/hil/team_simulator.hpp"

namespace skein::hil {

/// A simulated mission and what the independent judges say about it.
struct JudgedRun {
  std::uint64_t seed = 0;
  TeamResult result;
  bool sites_done = false;                  ///< all of them
  std::vector<checks::CheckResult> broken;  ///< the checks that did not hold, all violations
  std::vector<checks::Violation> excused;   ///< of all checks: proven to be unavoidable
  [[nodiscard]] bool held() const { return broken.empty(); }
};

/// Flies the mission once, in the calling thread, and judges it. `watcher` sees the run; what the
/// judges read is copied to `record` where one is wanted.
[[nodiscard]] JudgedRun fly_judged(const TeamMission& mission, const checks::Limits& limits,
                                   const TeamObserver& watcher = {},
                                   checks::RunRecord* record = nullptr);

struct RunSeries {
  std::string faults = "none";
  std::uint64_t first_seed = 1;
  std::size_t runs = 1;
  std::size_t jobs = 1;  ///< threads, each flying one mission at a time; >= 1
};

/// Flies the seeds first_seed .. first_seed + runs - 1. The result is in the order of seeds and
/// does not depend on `jobs`. `on_done` is called after every run, from one thread at a time.
/// Precondition: the fault profiles exist.
[[nodiscard]] std::vector<JudgedRun> fly_series(
    const configuration::Scenario& scenario, const RunSeries& series,
    const std::function<void(const JudgedRun&)>& on_done = {});

}  // namespace skein::hil
