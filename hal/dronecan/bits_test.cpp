// SPDX-License-Identifier: Apache-2.0
#include "skein/dronecan/bits.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

#include "skein/base/random.hpp"

namespace skein::dronecan {
namespace {

TEST(Bits, WholeBytesAreLittleEndian) {
  std::array<std::uint8_t, 3> bytes{};
  BitWriter writer{bytes};
  writer.put(115200, 24);
  EXPECT_EQ(bytes, (std::array<std::uint8_t, 3>{0x00, 0xC2, 0x01}));
}

TEST(Bits, PartsOfBytesBeginAtTheMostSignificantBit) {
  std::array<std::uint8_t, 2> bytes{};
  BitWriter writer{bytes};
  writer.put(42, 7);
  writer.put(static_cast<std::uint64_t>(-1), 5);
  writer.put(1, 4);
  EXPECT_EQ(bytes, (std::array<std::uint8_t, 2>{0x55, 0xF1}));
}

TEST(Bits, AValueOfTwelveBitsIsAByteAndTheRest) {
  std::array<std::uint8_t, 2> bytes{};
  BitWriter writer{bytes};
  writer.put(0xABC, 12);
  EXPECT_EQ(bytes, (std::array<std::uint8_t, 2>{0xBC, 0xA0}));
}

TEST(Bits, WhatIsWrittenIsRead) {
  Random random{1};
  for (int round = 0; round < 1000; ++round) {
    std::array<std::uint8_t, 64> bytes{};
    std::vector<std::pair<std::uint64_t, unsigned>> values;
    BitWriter writer{bytes};
    for (;;) {
      const auto bits = static_cast<unsigned>(1 + random.index(64));
      const std::uint64_t value = random.next() >> (64 - bits);
      writer.put(value, bits);
      if (!writer.ok()) break;
      values.emplace_back(value, bits);
    }
    BitReader reader{bytes};
    for (const auto& [value, bits] : values) ASSERT_EQ(reader.get(bits), value) << bits;
    ASSERT_TRUE(reader.ok());
  }
}

TEST(Bits, SignedNumbersKeepTheirSign) {
  std::array<std::uint8_t, 16> bytes{};
  BitWriter writer{bytes};
  for (const std::int64_t value : {-16, 15, -1, 0}) {
    writer.put(static_cast<std::uint64_t>(value), 5);
  }
  BitReader reader{bytes};
  for (const std::int64_t value : {-16, 15, -1, 0}) EXPECT_EQ(reader.get_signed(5), value);
}

TEST(Bits, BeyondTheEndIsZeroAndSaid) {
  const std::array<std::uint8_t, 1> bytes{0xFF};
  BitReader reader{bytes};
  EXPECT_EQ(reader.get(4), 0xFU);
  EXPECT_EQ(reader.get(5), 0U);
  EXPECT_FALSE(reader.ok());
  EXPECT_EQ(reader.left(), 0U);
  std::array<std::uint8_t, 1> small{};
  BitWriter writer{small};
  writer.put(1, 9);
  EXPECT_FALSE(writer.ok());
  EXPECT_EQ(small[0], 0);
}

}  // namespace
}  // namespace skein::dronecan
