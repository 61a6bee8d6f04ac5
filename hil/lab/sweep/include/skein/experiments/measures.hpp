// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/checks/run_record.hpp"
#include "skein/hil/judged_runs.hpp"
#include "skein/hil/team_simulator.hpp"
#include "skein/planning/plan_value.hpp"

namespace skein::experiments {

/// What one mission came to, as flown.
struct Measures {
  /// Of the whole mission: all sites' tasks with their surveys, all vehicles, times from the
  /// mission's start. A task that was not done has no reward and no timing error; so the shares are
  /// of what could be had. Required is a delivery at the site's first one (less its offset) plus
  /// its offset, and the start of an assessment at the last delivery before it plus the wait.
  planning::PlanValue value;
  double tasks_done = 0.0;
  double tasks = 0.0;
  double sites_done = 0.0;
  double coalitions = 0.0;       ///< formed; more than sites where one had to be formed anew
  double attempts_failed = 0.0;  ///< of a leader to form one
  double messages = 0.0;
  std::optional<double> last_done_s;  ///< when the last task was done of those that were
  std::optional<double> mission_s;    ///< the same, where all were done
  std::map<SiteId, double> formed_s;  ///< when the site's first coalition stood
  bool safe = false;                  ///< every check but completion held
  std::vector<std::string> broken;    ///< the checks that did not hold
};

/// Measures with a number, in the order of the tables.
struct MeasureColumn {
  std::string_view name;
  std::string_view label;  ///< for plots
  std::optional<double> (*of)(const Measures& measures);
};
inline constexpr std::size_t kMeasureColumns = 15;
[[nodiscard]] const std::array<MeasureColumn, kMeasureColumns>& measure_columns();

/// Flies the mission, judges it and takes its measures, in the calling thread.
[[nodiscard]] Measures measure(const hil::TeamMission& mission, const checks::Limits& limits);

/// As measure(), of what was recorded.
[[nodiscard]] Measures measures_of(const hil::TeamMission& mission, const checks::RunRecord& record,
                                   const checks::Limits& limits, const hil::JudgedRun& run);

}  // namespace skein::experiments
