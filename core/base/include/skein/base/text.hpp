// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace skein {

/// Valid UTF-8 without control characters.
[[nodiscard]] bool is_text(std::string_view text);
/// Cut at a character to at most so many bytes; a space for each control character.
[[nodiscard]] std::string as_text(std::string_view text, std::size_t bytes_max);

}  // namespace skein
