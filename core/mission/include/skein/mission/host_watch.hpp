// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

namespace skein::mission {

/// Below it a recording will end before long: several minutes are left, to land or to make room.
inline constexpr std::uint64_t kDiskFreeMinBytes = 500'000'000;
/// Two clocks that may be off so far differ by no more than the protocol's clock guard (0.5 s).
inline constexpr std::chrono::milliseconds kClockErrorMax{250};

[[nodiscard]] constexpr bool nearly_full(std::uint64_t free_bytes) {
  return free_bytes < kDiskFreeMinBytes;
}
/// Whether a team may rely on a machine's clock, by what its kernel says of it.
[[nodiscard]] constexpr bool trusted_clock(bool synchronised, std::chrono::microseconds error_max) {
  return synchronised && error_max <= kClockErrorMax;
}

}  // namespace skein::mission
