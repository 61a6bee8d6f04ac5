// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "skein/base/time.hpp"

namespace skein::console {

/// So long what was said to a vehicle or of it, and its own next word, may be on their way: what
/// it says within that of an order, a plan or an event may have been said before it heard of it.
inline constexpr Duration kNewsMayTake = std::chrono::seconds{1};

}  // namespace skein::console
