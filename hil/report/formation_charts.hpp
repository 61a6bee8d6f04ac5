// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "skein/checks/run_record.hpp"

/// The pictures of a formation's flight: inline SVG, as those of charts.hpp.
namespace skein::report {

/// Distance of the two nearest vehicles over time; shaded where a formation held.
[[nodiscard]] std::string separation_chart(const checks::RunRecord& record,
                                           const checks::Limits& limits);
/// Distance of every vehicle from its place while a formation held. Empty where none did.
[[nodiscard]] std::string place_chart(const checks::RunRecord& record,
                                      const checks::Limits& limits);
/// Title and picture from above of each formation that held: places as rings, what was flown there
/// as lines.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> formation_pictures(
    const checks::RunRecord& record);

}  // namespace skein::report
