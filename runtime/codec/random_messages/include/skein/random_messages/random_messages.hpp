// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "skein/base/random.hpp"
#include "skein/mission/messages.hpp"

namespace skein::codec {

/// The seven of the coalition, then the others of mission::Message in their order.
inline constexpr std::size_t kMessageKinds = 20;

/// A message of that kind with every field random within its limits, for tests.
[[nodiscard]] mission::Message random_message(std::size_t kind, Random& random);

}  // namespace skein::codec
