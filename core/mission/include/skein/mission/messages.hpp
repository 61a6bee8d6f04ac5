// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

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

/// Of the commands that a vehicle hears those that are for it, each once: they are sent again and
/// again, and one that comes late counts for nothing.
class CommandFilter {
 public:
  [[nodiscard]] bool take(const Command& command, VehicleId self) {
    const bool ours = command.vehicle == self || command.vehicle == kGroundStation;
    if (!ours || command.number <= newest_) return false;
    newest_ = command.number;
    return true;
  }
  [[nodiscard]] std::uint32_t newest() const { return newest_; }

 private:
  std::uint32_t newest_ = 0;
};

}  // namespace skein::mission
