// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace skein::groundstation {

inline constexpr std::size_t kPasswordMin = 8;

/// A line of standard input; on a terminal it is asked for and not shown.
[[nodiscard]] std::string typed_password(const std::string& name);

}  // namespace skein::groundstation
