// SPDX-License-Identifier: Apache-2.0
#include "crc32.hpp"

#include <array>

namespace skein::mcap {
namespace {

constexpr std::uint32_t kPolynomial = 0xEDB88320U;
constexpr std::size_t kSlices = 8;
using Tables = std::array<std::array<std::uint32_t, 256>, kSlices>;

/// Slicing by eight: table k is what a byte does to the sum k bytes further on.
constexpr Tables make_tables() {
  Tables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t sum = byte;
    for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1U) ^ ((sum & 1U) != 0 ? kPolynomial : 0U);
    tables[0][byte] = sum;
  }
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    for (std::size_t k = 1; k < kSlices; ++k) {
      const std::uint32_t sum = tables[k - 1][byte];
      tables[k][byte] = (sum >> 8U) ^ tables[0][sum & 0xFFU];
    }
  }
  return tables;
}
constexpr Tables kTables = make_tables();

}  // namespace

std::uint32_t crc32(std::span<const std::uint8_t> bytes, std::uint32_t before) {
  std::uint32_t sum = ~before;
  while (bytes.size() >= kSlices) {
    const std::uint32_t low = sum ^ (bytes[0] | static_cast<std::uint32_t>(bytes[1]) << 8U |
                                     static_cast<std::uint32_t>(bytes[2]) << 16U |
                                     static_cast<std::uint32_t>(bytes[3]) << 24U);
    sum = kTables[7][low & 0xFFU] ^ kTables[6][low >> 8U & 0xFFU] ^ kTables[5][low >> 16U & 0xFFU] ^
          kTables[4][low >> 24U] ^ kTables[3][bytes[4]] ^ kTables[2][bytes[5]] ^
          kTables[1][bytes[6]] ^ kTables[0][bytes[7]];
    bytes = bytes.subspan(kSlices);
  }
  for (const std::uint8_t byte : bytes) sum = (sum >> 8U) ^ kTables[0][(sum ^ byte) & 0xFFU];
  return ~sum;
}

}  // namespace skein::mcap
