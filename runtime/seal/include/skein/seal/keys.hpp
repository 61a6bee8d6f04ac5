// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "skein/base/ids.hpp"

namespace skein::seal {

/// What a team shares for a while. Another follows it when a member is lost.
struct EpochKey {
  std::uint8_t epoch = 0;
  std::array<std::uint8_t, 32> secret{};  ///< from a random generator fit for keys
};

/// Which run of which node's program sealed a datagram. No two runs of one node may be equal under
/// one epoch's key, or the cipher tells what it hides: `number` is counted where it outlasts the
/// program, and `random` is for the day when that was lost.
struct SenderStart {
  VehicleId sender;
  std::uint16_t number = 0;  ///< greater at each start of this node
  std::uint32_t random = 0;  ///< 24 bits
  friend auto operator<=>(const SenderStart&, const SenderStart&) = default;
};

}  // namespace skein::seal
