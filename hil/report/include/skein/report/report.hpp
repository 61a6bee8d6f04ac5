// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/checks/checks.hpp"
#include "skein/checks/run_record.hpp"
#include "skein/hindsight/hindsight.hpp"

/// A judged mission, told to people.
namespace skein::report {

/// One figure of one site, ours beside a published one. Texts with their units; "-" where there is
/// none.
struct ComparisonRow {
  SiteId site;
  std::string what;
  std::string ours;
  std::string published;
};

struct Contents {
  std::string title;    ///< of the mission
  std::string summary;  ///< a line under it: scenario, seed, date
  std::string replay;   ///< the command that shows the mission again in the console; may be empty
  std::string replay_url;  ///< where its page is then, if nothing else is asked for; may be empty
  std::string run;         ///< how that page calls the recording
  checks::RunRecord record;
  checks::Limits limits;
  std::vector<checks::CheckResult> checks;     ///< passed when every one of them held
  std::vector<ComparisonRow> comparison;       ///< by site
  std::vector<hindsight::Row> hindsight = {};  ///< empty where nothing was compared
};

/// One HTML file that needs nothing else and may ask nobody: verdict, tables, map, distance curves,
/// time line, errors. Each check has a link to its moment in the replay. For light and dark
/// screens. Tracks are thinned to what can be seen.
[[nodiscard]] std::string html(const Contents& contents);

/// The map alone as an SVG file, for light and dark pages.
[[nodiscard]] std::string mission_svg(const checks::RunRecord& record);

/// Comparison, checks with the first few violations of each, and the verdict as the last line.
[[nodiscard]] std::string text_table(const std::vector<checks::CheckResult>& checks,
                                     const std::vector<ComparisonRow>& comparison);

/// What was planned, believed and true, each aircraft and each delivery in a line; empty where no
/// truth is known.
[[nodiscard]] std::string truth_text(const checks::RunRecord& record, const checks::Limits& limits);

}  // namespace skein::report
