// SPDX-License-Identifier: Apache-2.0
#include "skein/can/mcast_datagram.hpp"

#include <algorithm>

#include "skein/base/assert.hpp"
#include "skein/can/crc16.hpp"

namespace skein::can {
namespace {

constexpr std::uint16_t kMagic = 0x2934;
constexpr std::uint16_t kFlagFd = 1;
constexpr std::uint32_t kExtended = 1U << 31U;
constexpr std::uint32_t kRtr = 1U << 30U;
constexpr std::uint32_t kError = 1U << 29U;
constexpr std::size_t kCovered = 4;  // the checksum is over all from here

std::uint16_t checksum(std::span<const std::uint8_t> datagram) {
  const auto covered = datagram.subspan(kCovered);
  Crc16 crc;
  crc.process_bytes(covered.data(), covered.size());
  return crc.checksum();
}

std::uint16_t u16_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] | bytes[at + 1] << 8);
}

}  // namespace

McastDatagram to_mcast(const Frame& frame) {
  SKEIN_ASSERT(is_valid(frame));
  const std::uint32_t id = frame.id | (frame.extended ? kExtended : 0) | (frame.rtr ? kRtr : 0) |
                           (frame.error ? kError : 0);
  McastDatagram datagram;
  const auto u16 = [&datagram](std::uint32_t value) {
    datagram.push_back(static_cast<std::uint8_t>(value));
    datagram.push_back(static_cast<std::uint8_t>(value >> 8U));
  };
  u16(kMagic);
  u16(0);
  u16(frame.fd ? kFlagFd : 0);
  u16(id);
  u16(id >> 16U);
  for (const std::uint8_t byte : frame.payload()) datagram.push_back(byte);
  const std::uint16_t crc = checksum(datagram);
  datagram[2] = static_cast<std::uint8_t>(crc);
  datagram[3] = static_cast<std::uint8_t>(crc >> 8U);
  return datagram;
}

std::optional<Frame> from_mcast(std::span<const std::uint8_t> datagram) {
  if (datagram.size() < kMcastHeader || datagram.size() > kMcastHeader + kFdDataMax ||
      u16_at(datagram, 0) != kMagic || u16_at(datagram, 2) != checksum(datagram)) {
    return std::nullopt;
  }
  const std::uint32_t id = u16_at(datagram, 6) | static_cast<std::uint32_t>(u16_at(datagram, 8))
                                                     << 16U;
  Frame frame;
  frame.fd = (u16_at(datagram, 4) & kFlagFd) != 0;
  frame.extended = (id & kExtended) != 0;
  frame.rtr = (id & kRtr) != 0;
  frame.error = (id & kError) != 0;
  frame.id = id & kExtendedIdMask;
  frame.size = static_cast<std::uint8_t>(datagram.size() - kMcastHeader);
  std::copy(datagram.begin() + kMcastHeader, datagram.end(), frame.data.begin());
  if (!is_valid(frame)) return std::nullopt;
  return frame;
}

}  // namespace skein::can
