// SPDX-License-Identifier: Apache-2.0
#include "rtps_datagram.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "skein/network/rtps_guid.hpp"

namespace skein::network {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes header() {
  Bytes bytes(kRtpsHeaderSize);
  const std::array<std::uint8_t, 4> magic{'R', 'T', 'P', 'S'};
  std::copy(magic.begin(), magic.end(), bytes.begin());
  std::copy(kGuidMark.begin(), kGuidMark.end(), bytes.begin() + kRtpsGuidPrefixOffset);
  bytes[kRtpsGuidPrefixOffset + 4] = 0x12;
  bytes[kRtpsGuidPrefixOffset + 5] = 0x34;
  return bytes;
}

/// Appends a submessage, its length in the order that the flags say, `said` instead of the true
/// one.
Bytes with(Bytes message, std::uint8_t kind, std::uint8_t flags, std::size_t size,
           std::optional<std::size_t> said = {}) {
  const std::size_t length = said.value_or(size);
  const auto low = static_cast<std::uint8_t>(length & 0xFFU);
  const auto high = static_cast<std::uint8_t>(length >> 8U);
  message.push_back(kind);
  message.push_back(flags);
  message.push_back((flags & 1U) != 0 ? low : high);
  message.push_back((flags & 1U) != 0 ? high : low);
  message.insert(message.end(), size, 0x80);
  return message;
}

std::optional<std::size_t> left_of(const Bytes& message) {
  const auto rest = without_statistics(message);
  return rest ? std::optional{rest->size()} : std::nullopt;
}

TEST(RtpsDatagram, KnowsItsSender) {
  EXPECT_EQ(rtps_sender(header()), VehicleId{0x1234});
  Bytes other = header();
  other[kRtpsGuidPrefixOffset] = 9;
  EXPECT_FALSE(rtps_sender(other));
  Bytes cut = header();
  cut.pop_back();
  EXPECT_FALSE(rtps_sender(cut));
}

TEST(RtpsDatagram, StatisticsAtTheEndAreCutOffWhateverTheirOrder) {
  const Bytes data = with(with(header(), 0x09, 1, 8), 0x15, 1, 200);
  EXPECT_EQ(left_of(data), data.size());
  for (const std::uint8_t flags : {std::uint8_t{0}, std::uint8_t{1}}) {
    EXPECT_EQ(left_of(with(data, 0x80, flags, 56)), data.size());
  }
  EXPECT_EQ(left_of(header()), kRtpsHeaderSize);
}

// The first ends a process of Debian's Fast DDS 2.9.1.
TEST(RtpsDatagram, OtherStatisticsAreRefused) {
  EXPECT_FALSE(left_of(with(header(), 0x80, 1, 4)));
  EXPECT_FALSE(left_of(with(with(header(), 0x80, 1, 56), 0x09, 1, 8)));
  EXPECT_FALSE(left_of(with(with(header(), 0x80, 1, 56), 0x80, 1, 56)));
  EXPECT_FALSE(left_of(with(header(), 0x80, 1, 57, 0)));
}

TEST(RtpsDatagram, EverySubmessageMustBeWhole) {
  EXPECT_FALSE(left_of(with(header(), 0x15, 1, 20, 21)));
  Bytes cut = with(header(), 0x15, 1, 0);
  cut.pop_back();
  EXPECT_FALSE(left_of(cut));
  // A length of 0 is that of the rest, but for two kinds, which may be empty.
  EXPECT_TRUE(left_of(with(header(), 0x15, 1, 20, 0)));
  EXPECT_TRUE(left_of(with(with(header(), 0x01, 1, 0), 0x15, 1, 20)));
  EXPECT_FALSE(left_of(with(header(), 0x01, 1, 2, 0)));
  EXPECT_FALSE(left_of({}));
}

TEST(RtpsDatagram, OneByteFromTheEndLooksLikeStatistics) {
  Bytes datagram(200);
  EXPECT_FALSE(looks_like_statistics(datagram));
  datagram[140] = 0x80;
  EXPECT_TRUE(looks_like_statistics(datagram));
  datagram.resize(79);
  datagram[19] = 0x80;
  EXPECT_FALSE(looks_like_statistics(datagram));
}

}  // namespace
}  // namespace skein::network
