// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>

#include "skein/base/time.hpp"

namespace skein::mission {

/// The ground station tells so many vehicles of what each is to fly at once: of more, the first
/// would give way before they are on the air (64 are kept there, topics.json).
inline constexpr std::size_t kToldAtOnce = 32;
inline constexpr Duration kToldEvery = std::chrono::milliseconds{100};

}  // namespace skein::mission
