// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/groundstation/orders.hpp"

/// A fence as it is typed: 'fence 0,0 900,0 900,700 height 100', 'fence FILE height 100'.
namespace skein::groundstation {

/// `fence` alone looks.
[[nodiscard]] Result<Input> fence_order(const std::vector<std::string_view>& words, bool preview);
[[nodiscard]] std::string fence_line(const NewFence& order);

}  // namespace skein::groundstation
