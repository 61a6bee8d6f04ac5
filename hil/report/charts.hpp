// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "skein/checks/run_record.hpp"
#include "story.hpp"

/// The pictures of the report: inline SVG that takes its colours from the page's style.
namespace skein::report {

/// Tracks from above, coloured by coalition, with sites, bearings, hazards, legend and scale.
/// `head` is put first inside the svg element: attributes of a standalone file and its style.
[[nodiscard]] std::string map(const checks::RunRecord& record, const std::vector<Story>& stories,
                              std::string_view attributes, std::string_view style);

/// Distance of every member from a site over time (Wang 2022, figures 8 to 10). Empty where nobody
/// worked for the site.
[[nodiscard]] std::string distance_curves(const checks::RunRecord& record,
                                          const checks::Limits& limits,
                                          const std::vector<Story>& stories, const Site& site);

/// A row a vehicle, what it did when (Wang 2022, figure 11).
[[nodiscard]] std::string time_line(const checks::RunRecord& record,
                                    const std::vector<Story>& stories);

/// Flown against planned, delivery by delivery and arc by arc.
[[nodiscard]] std::string errors(const checks::RunRecord& record, const checks::Limits& limits);

}  // namespace skein::report
