// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace skein::mavlink {

/// MAVLink's checksum: ITU X.25 / CRC-16-MCRF4XX, polynomial 0x1021 reflected, start 0xFFFF, no
/// final inversion. "123456789" gives 0x6F91.
class X25 {
 public:
  constexpr void add(std::uint8_t byte) {
    value_ = static_cast<std::uint16_t>(value_ ^ byte);
    for (int bit = 0; bit < 8; ++bit) {
      value_ =
          static_cast<std::uint16_t>((value_ & 1U) != 0 ? (value_ >> 1U) ^ 0x8408U : value_ >> 1U);
    }
  }
  constexpr void add(std::span<const std::uint8_t> bytes) {
    for (const std::uint8_t byte : bytes) add(byte);
  }
  [[nodiscard]] constexpr std::uint16_t value() const { return value_; }

 private:
  std::uint16_t value_ = 0xFFFF;
};

}  // namespace skein::mavlink
