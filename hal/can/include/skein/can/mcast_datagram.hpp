// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "skein/base/static_vector.hpp"
#include "skein/can/frame.hpp"

/// One frame in one UDP datagram, as ArduPilot's `mcast` driver has it. Little endian: magic 0x2934
/// (u16), CRC-16/CCITT-FALSE of all that follows (u16), flags (u16, bit 0: FD), id (u32, bit 31:
/// extended, 30: RTR, 29: error), data.
namespace skein::can {

inline constexpr std::size_t kMcastHeader = 10;
inline constexpr std::uint16_t kMcastPort = 57732;
/// The group of bus 0; those of the others follow it.
inline constexpr std::uint32_t kMcastGroup = 0xEF415200;  // 239.65.82.0

using McastDatagram = StaticVector<std::uint8_t, kMcastHeader + kFdDataMax>;

/// Precondition: is_valid(frame). BRS is not carried.
[[nodiscard]] McastDatagram to_mcast(const Frame& frame);
/// Nothing if it is not such a datagram, or its checksum does not hold.
[[nodiscard]] std::optional<Frame> from_mcast(std::span<const std::uint8_t> datagram);

}  // namespace skein::can
