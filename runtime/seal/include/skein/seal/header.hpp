// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "skein/seal/keys.hpp"

namespace skein::seal {

/// What a sealed datagram says in clear, big endian: the mark and version of the format (1 byte),
/// the key's epoch (1), the sender (2), its start's number (2) and random part (3), the counter
/// (5). Then comes as much as was sealed, and the tag.
inline constexpr std::uint32_t kHeaderBytes = 14;
inline constexpr std::uint32_t kTagBytes = 16;
/// By how much a datagram grows.
inline constexpr std::uint32_t kOverheadBytes = kHeaderBytes + kTagBytes;
inline constexpr std::uint8_t kMark = 0xA1;  ///< an RTPS message begins with 'R', 0x52
inline constexpr std::uint64_t kCounterMax = (std::uint64_t{1} << 40U) - 1;

struct Header {
  std::uint8_t epoch = 0;
  SenderStart from;
  std::uint64_t counter = 0;  ///< 0 to kCounterMax; no two datagrams of one start have the same
  friend bool operator==(const Header&, const Header&) = default;
};

[[nodiscard]] std::array<std::uint8_t, kHeaderBytes> to_bytes(const Header& header);

/// None where the datagram is too short to be sealed, or is of another format. What it says is not
/// known to be true before the datagram is opened.
[[nodiscard]] std::optional<Header> read_header(std::span<const std::uint8_t> datagram);

}  // namespace skein::seal
