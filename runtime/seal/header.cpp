// SPDX-License-Identifier: Apache-2.0
#include "skein/seal/header.hpp"

namespace skein::seal {
namespace {

/// The `count` low bytes of the value, big endian.
void put(std::uint8_t*& at, std::uint64_t value, unsigned count) {
  while (count-- > 0) *at++ = static_cast<std::uint8_t>(value >> (8U * count));
}

std::uint64_t take(const std::uint8_t*& at, unsigned count) {
  std::uint64_t value = 0;
  while (count-- > 0) value = value << 8U | *at++;
  return value;
}

}  // namespace

std::array<std::uint8_t, kHeaderBytes> to_bytes(const Header& header) {
  std::array<std::uint8_t, kHeaderBytes> bytes{};
  std::uint8_t* at = bytes.data();
  put(at, kMark, 1);
  put(at, header.epoch, 1);
  put(at, header.from.sender.value, 2);
  put(at, header.from.number, 2);
  put(at, header.from.random, 3);
  put(at, header.counter, 5);
  return bytes;
}

std::optional<Header> read_header(std::span<const std::uint8_t> datagram) {
  if (datagram.size() < kOverheadBytes || datagram[0] != kMark) return std::nullopt;
  const std::uint8_t* at = datagram.data() + 1;
  Header header;
  header.epoch = static_cast<std::uint8_t>(take(at, 1));
  header.from.sender.value = static_cast<std::uint16_t>(take(at, 2));
  header.from.number = static_cast<std::uint16_t>(take(at, 2));
  header.from.random = static_cast<std::uint32_t>(take(at, 3));
  header.counter = take(at, 5);
  return header;
}

}  // namespace skein::seal
