// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "skein/base/result.hpp"
#include "skein/groundstation/orders.hpp"

/// What the operator can type.
namespace skein::groundstation {

/// Fails with what is wrong and what would be right.
[[nodiscard]] Result<Input> parse_input(std::string_view line);
inline constexpr std::size_t kLineMax = 1000;  ///< of a line; a longer one is refused

/// Whether the line is an order to the formation, its preview, or a question about its places.
[[nodiscard]] bool is_of_formation(std::string_view line);

/// The answer to "help".
[[nodiscard]] std::string help_text();

}  // namespace skein::groundstation
