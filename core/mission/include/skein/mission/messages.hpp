// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
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

/// Of an order: in milliseconds the last that an Instant can tell.
inline constexpr std::uint64_t kLastNumber = 9'223'372'036'854;

/// The whole of it: its lower half would be spent after 49 days.
[[nodiscard]] inline std::uint64_t number_of(const Command& command) {
  return (std::uint64_t{command.number_high} << 32U) | command.number;
}
inline void set_number(Command& command, std::uint64_t number) {
  command.number = static_cast<std::uint32_t>(number & 0xFFFF'FFFFU);
  command.number_high = static_cast<std::uint32_t>(number >> 32U);
}

/// To the millisecond before, for commands issued at mission time 0 or later.
[[nodiscard]] inline Instant issued_at(const Command& command) {
  const auto after = static_cast<std::int64_t>(std::min(number_of(command), kLastNumber));
  return Instant{std::chrono::milliseconds{after} - std::chrono::milliseconds{1}};
}

/// Of the commands that a vehicle hears those that are for it, each once: they are sent again and
/// again, and one that comes late counts for nothing.
class CommandFilter {
 public:
  [[nodiscard]] bool take(const Command& command, VehicleId self) {
    const bool ours = command.vehicle == self || command.vehicle == kGroundStation;
    if (!ours || number_of(command) <= newest_) return false;
    newest_ = number_of(command);
    return true;
  }
  [[nodiscard]] std::uint64_t newest() const { return newest_; }

 private:
  std::uint64_t newest_ = 0;
};

}  // namespace skein::mission
