// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace skein::configuration {

/// "2026-11-23T08:00:00Z", with a fraction where there is one. Precondition: the year has four
/// digits.
[[nodiscard]] std::string utc_text(std::int64_t unix_ns);
/// What utc_text() writes, from 1970 to 2200; nothing for any other text.
[[nodiscard]] std::optional<std::int64_t> parse_utc(std::string_view text);

}  // namespace skein::configuration
