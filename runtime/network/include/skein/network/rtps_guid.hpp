// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "skein/base/ids.hpp"

namespace skein::network {

/// Nodes are told apart by the prefix of their GUID, which every RTPS message carries in its
/// header: bytes 0-3 `kGuidMark`, 4-5 the vehicle id (big endian), 6-10 from the instance id, and
/// 11 counts the node's carriers: to DDS, who is started again is somebody else, or it would not be
/// heard before it has said as much as before.
inline constexpr std::array<std::uint8_t, 4> kGuidMark{0x01, 0x0F, 0x53, 0x4B};
inline constexpr std::size_t kGuidInstanceBytes = 5;
inline constexpr std::size_t kGuidPrefixBytes = 12;
inline constexpr std::size_t kRtpsGuidPrefixOffset = 8;  ///< in an RTPS message
inline constexpr std::size_t kRtpsHeaderSize = 20;

[[nodiscard]] inline bool is_rtps(std::span<const std::uint8_t> message) {
  constexpr std::array<std::uint8_t, 4> kMagic{'R', 'T', 'P', 'S'};
  return message.size() >= kRtpsHeaderSize &&
         std::equal(kMagic.begin(), kMagic.end(), message.begin());
}

/// Whose RTPS message this is, where a node of ours made it. What it says of itself: without a seal
/// anybody can write it.
[[nodiscard]] inline std::optional<VehicleId> rtps_sender(std::span<const std::uint8_t> message) {
  if (!is_rtps(message)) return std::nullopt;
  const auto prefix = message.subspan(kRtpsGuidPrefixOffset);
  if (!std::equal(kGuidMark.begin(), kGuidMark.end(), prefix.begin())) return std::nullopt;
  return VehicleId{static_cast<std::uint16_t>(prefix[4] << 8U | prefix[5])};
}

}  // namespace skein::network
