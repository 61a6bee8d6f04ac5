// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace skein::mcap {

/// CRC-32 of zip and Ethernet (polynomial 0xEDB88320, reflected), going on from that of what came
/// before.
[[nodiscard]] std::uint32_t crc32(std::span<const std::uint8_t> bytes, std::uint32_t before = 0);

}  // namespace skein::mcap
