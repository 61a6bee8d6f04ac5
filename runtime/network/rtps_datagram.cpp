// SPDX-License-Identifier: Apache-2.0
#include "rtps_datagram.hpp"

#include <algorithm>
#include <array>

#include "skein/base/assert.hpp"
#include "skein/network/rtps_guid.hpp"

namespace skein::network {
namespace {

constexpr std::size_t kSubmessageHeaderBytes = 4;  ///< kind, flags, length in the flagged order
constexpr std::uint8_t kLittleEndian = 0x01;
constexpr std::uint8_t kStatistics = 0x80;
constexpr std::size_t kStatisticsBytes = 60;  ///< with their header
/// Of these a length of 0 says: up to the end (8.3.3.2.3 has it for all but two).
constexpr std::uint8_t kPad = 0x01;
constexpr std::uint8_t kInfoTimestamp = 0x09;

/// With its header, of what is left of the message; none where it is not whole.
std::optional<std::size_t> submessage_bytes(std::span<const std::uint8_t> rest) {
  if (rest.size() < kSubmessageHeaderBytes) return std::nullopt;
  const bool little = (rest[1] & kLittleEndian) != 0;
  const std::size_t length =
      little ? rest[2] | std::size_t{rest[3]} << 8U : std::size_t{rest[2]} << 8U | rest[3];
  if (length == 0 && rest[0] != kPad && rest[0] != kInfoTimestamp) return rest.size();
  const std::size_t bytes = kSubmessageHeaderBytes + length;
  return bytes <= rest.size() ? std::optional{bytes} : std::nullopt;
}

}  // namespace

std::optional<std::span<const std::uint8_t>> without_statistics(
    std::span<const std::uint8_t> message) {
  if (!is_rtps(message)) return std::nullopt;
  std::size_t at = kRtpsHeaderSize;
  while (at < message.size()) {
    const auto bytes = submessage_bytes(message.subspan(at));
    if (!bytes) return std::nullopt;
    if (message[at] == kStatistics) {
      if (*bytes != kStatisticsBytes || at + *bytes != message.size()) return std::nullopt;
      return message.first(at);
    }
    at += *bytes;
  }
  return message;
}

std::vector<std::uint8_t> participant_gone(std::span<const std::uint8_t> prefix) {
  SKEIN_ASSERT(prefix.size() == kGuidPrefixBytes);
  constexpr std::array<std::uint8_t, kRtpsGuidPrefixOffset> kHeader{'R', 'T',  'P',  'S',
                                                                    2,   0x03, 0x01, 0x0F};
  // DATA with inline QoS and without data, to the participants' reader (0x000100C7) of their writer
  // (0x000100C2), with a sequence number that it has not come to: it announced itself under its
  // first.
  constexpr std::array<std::uint8_t, 36> kData{
      0x15, 0x03, 52, 0,                          // little endian; bytes after this
      0,    0,    16, 0,                          // flags; to the inline QoS
      0,    0x01, 0,  0xC7, 0,    0x01, 0, 0xC2,  // reader, writer
      0,    0,    0,  0,    0xFF, 0xFF, 0, 0,     // sequence
      0x71, 0,    4,  0,    0,    0,    0, 3,     // status: disposed, unregistered
      0x70, 0,    16, 0};                         // key: the GUID
  constexpr std::array<std::uint8_t, 4> kParticipant{0, 0, 0x01, 0xC1};
  constexpr std::array<std::uint8_t, 4> kEndOfQos{0x01, 0, 0, 0};
  std::vector<std::uint8_t> bytes;
  const auto add = [&bytes](std::span<const std::uint8_t> more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
  };
  add(kHeader);
  add(prefix);
  add(kData);
  add(prefix);
  add(kParticipant);
  add(kEndOfQos);
  return bytes;
}

bool looks_like_statistics(std::span<const std::uint8_t> datagram) {
  return datagram.size() >= kRtpsHeaderSize + kStatisticsBytes &&
         datagram[datagram.size() - kStatisticsBytes] == kStatistics;
}

}  // namespace skein::network
