// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace skein::can {

/// CRC-16/CCITT-FALSE: polynomial 0x1021, start 0xFFFF, not reflected, no final inversion.
/// "123456789" gives 0x29B1. Used by DroneCAN's transfers and by the multicast datagrams.
class Crc16 {
 public:
  constexpr void add(std::uint8_t byte) {
    value_ = static_cast<std::uint16_t>(value_ ^ (byte << 8));
    for (int bit = 0; bit < 8; ++bit) {
      value_ = static_cast<std::uint16_t>((value_ & 0x8000U) != 0 ? (value_ << 1) ^ 0x1021
                                                                  : value_ << 1);
    }
  }
  constexpr void add(std::span<const std::uint8_t> bytes) {
    for (const std::uint8_t byte : bytes) add(byte);
  }
  [[nodiscard]] constexpr std::uint16_t value() const { return value_; }

 private:
  std::uint16_t value_ = 0xFFFF;
};

}  // namespace skein::can
