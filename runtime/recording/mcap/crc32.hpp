// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <zlib.h>

#include <cstdint>
#include <span>

namespace skein::mcap {

/// CRC-32 of zip and Ethernet (polynomial 0xEDB88320, reflected), going on from that of what came
/// before.
[[nodiscard]] inline std::uint32_t crc32(std::span<const std::uint8_t> bytes,
                                         std::uint32_t before = 0) {
  // Of no bytes, zlib takes a null pointer for the question what to start with.
  if (bytes.empty()) return before;
  return static_cast<std::uint32_t>(::crc32_z(before, bytes.data(), bytes.size()));
}

}  // namespace skein::mcap
