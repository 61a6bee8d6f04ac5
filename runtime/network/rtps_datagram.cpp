// SPDX-License-Identifier: Apache-2.0
#include "rtps_datagram.hpp"

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

bool looks_like_statistics(std::span<const std::uint8_t> datagram) {
  return datagram.size() >= kRtpsHeaderSize + kStatisticsBytes &&
         datagram[datagram.size() - kStatisticsBytes] == kStatistics;
}

}  // namespace skein::network
