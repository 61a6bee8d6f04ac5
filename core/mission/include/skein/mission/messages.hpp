// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "skein/coalition/messages.hpp"
#include "skein/domain/path.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/formation/change.hpp"
#include "skein/formation/passage.hpp"
#include "skein/idl/message.hpp"
#include "skein/mission/events.hpp"

namespace skein::mission {

/// To the millisecond before, for commands issued at mission time 0 or later.
[[nodiscard]] inline Instant issued_at(const Command& command) {
  return Instant{std::chrono::milliseconds{command.number} - std::chrono::milliseconds{1}};
}

}  // namespace skein::mission
