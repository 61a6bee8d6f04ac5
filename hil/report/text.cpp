// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "skein/report/report.hpp"

namespace skein::report {

std::string text_table(const std::vector<checks::CheckResult>& checks,
                       const std::vector<ComparisonRow>& comparison) {
  constexpr std::size_t kSentencesMax = 5;
  std::string text;
  if (!comparison.empty()) {
    text += fmt::format("{:<8} {:<20} {:<26} {}\n", "", "", "ours", "published");
  }
  for (std::size_t i = 0; i < comparison.size(); ++i) {
    const ComparisonRow& row = comparison[i];
    const bool new_site = i == 0 || row.site != comparison[i - 1].site;
    text += fmt::format("{:<8} {:<20} {:<26} {}\n",
                        new_site ? fmt::format("site {}", row.site.value) : "", row.what, row.ours,
                        row.published);
  }
  if (!comparison.empty()) text += '\n';

  std::size_t failed = 0;
  for (const checks::CheckResult& check : checks) {
    if (!check.held()) ++failed;
    text += fmt::format("{:<4} {:<16} {:>5} {:<32} {}\n", check.held() ? "ok" : "FAIL", check.name,
                        check.judged, check.judged_what, check.measured);
    for (std::size_t i = 0; i < std::min(kSentencesMax, check.violations.size()); ++i) {
      text += "       " + check.violations[i].sentence + "\n";
    }
    if (check.violations.size() > kSentencesMax) {
      text += fmt::format("       and {} more\n", check.violations.size() - kSentencesMax);
    }
    for (const auto& excused : check.excused) text += "       excused: " + excused.sentence + "\n";
  }
  return text + (failed == 0
                     ? fmt::format("PASS: all {} checks held\n", checks.size())
                     : fmt::format("FAIL: {} of {} checks did not hold\n", failed, checks.size()));
}

}  // namespace skein::report
