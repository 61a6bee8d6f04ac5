// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace skein::ardupilot {

/// Why an autopilot would not arm, in its own words, and what to do: "reason (remedy)", of at most
/// `bytes_max`.
[[nodiscard]] std::string with_remedy(std::string_view reason, std::size_t bytes_max);

/// Whether two reasons are one that is measured again: "Yaw inconsistent 94 deg", then 93. Numbers
/// of one digit are names ("GPS 1").
[[nodiscard]] bool is_same_reason(std::string_view a, std::string_view b);

}  // namespace skein::ardupilot
