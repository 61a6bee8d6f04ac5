// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/checks/checks.hpp"
#include "skein/configuration/scenario.hpp"
#include "skein/hil/bench.hpp"
#include "skein/report/report.hpp"

namespace skein::hil {

/// What the processes recorded in the run's folder, with what the mission was to be, and what
/// faults were done to them.
[[nodiscard]] Result<checks::RunRecord> read_record(const configuration::Scenario& scenario,
                                                    const std::filesystem::path& run_folder,
                                                    const BenchOutcome& outcome);

/// All checks of the record, and those that only the bench can make: that everybody found
/// everybody, kept up and stopped cleanly, that as many coalitions formed as the scenario expects,
/// and that the sites whose first attempt must fail had to wait.
[[nodiscard]] std::vector<checks::CheckResult> judge_run(const configuration::Scenario& scenario,
                                                         const checks::RunRecord& record,
                                                         const BenchOutcome& outcome);

/// One site's mission in figures. Times are mission seconds.
struct SiteFigures {
  SiteId site;
  std::optional<VehicleId> found_by;
  std::optional<double> survey_done_s;
  std::optional<double> formed_s;  ///< the coalition whose deliveries were flown
  std::optional<int> coalition_size;
  int attempts_failed = 0;
  std::vector<double> delivery_times_s;  ///< as flown
  std::optional<double> assessment_done_s;
  std::optional<double> allocation_time_s;
};
[[nodiscard]] std::vector<SiteFigures> site_figures(const checks::RunRecord& record,
                                                    const checks::Limits& limits);

/// Ours beside the published values, by site.
[[nodiscard]] std::vector<report::ComparisonRow> compare(
    const std::vector<SiteFigures>& figures,
    const std::vector<configuration::ReferenceSite>& reference);

}  // namespace skein::hil
