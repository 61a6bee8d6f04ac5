// SPDX-License-Identifier: Apache-2.0
#include "intruder.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>

#include "skein/identity/key_change.hpp"
#include "skein/network/rtps_guid.hpp"
#include "skein/seal/header.hpp"

namespace skein::intruder {
namespace {

/// Of kind 0x80, and 4 bytes long instead of 56.
constexpr std::array<std::uint8_t, 8> kCutStatistics{0x80, 1, 4, 0, 1, 2, 3, 4};
constexpr std::uint8_t kHeartbeat = 0x07;
constexpr std::size_t kSubmessageHeader = 4;
constexpr std::size_t kDatagramMax = 1400;

void fill(Bytes& bytes, std::size_t from, Random& random) {
  for (std::size_t i = from; i < bytes.size(); ++i) {
    bytes[i] = static_cast<std::uint8_t>(random.index(256));
  }
}

}  // namespace

Socket::Socket() : descriptor_{::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)} {
  in_addr loopback{};
  loopback.s_addr = htonl(INADDR_LOOPBACK);
  (void)::setsockopt(descriptor_, IPPROTO_IP, IP_MULTICAST_IF, &loopback, sizeof loopback);
}
Socket::~Socket() { ::close(descriptor_); }

void Socket::send(std::span<const std::uint8_t> datagram, const network::Endpoint& endpoint) const {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(endpoint.port);
  if (::inet_pton(AF_INET, endpoint.address.c_str(), &to.sin_addr) != 1) return;
  // A full queue of the receiver is what an intruder would not mind either.
  (void)::sendto(descriptor_, datagram.data(), datagram.size(), MSG_DONTWAIT,
                 reinterpret_cast<const sockaddr*>(&to), sizeof to);
}

Bytes rtps_message(VehicleId as, std::uint8_t submessage, std::size_t bytes) {
  constexpr std::array<std::uint8_t, network::kRtpsGuidPrefixOffset> kStart{'R', 'T', 'P', 'S',
                                                                            2,   3,   1,   15};
  Bytes message(network::kRtpsHeaderSize + kSubmessageHeader + bytes, 0xFF);
  auto at = std::ranges::copy(kStart, message.begin()).out;
  at = std::ranges::copy(network::kGuidMark, at).out;
  *at++ = static_cast<std::uint8_t>(as.value >> 8U);
  *at++ = static_cast<std::uint8_t>(as.value & 0xFFU);
  at = message.begin() + network::kRtpsHeaderSize;
  *at++ = submessage;
  *at++ = 1;  // little endian
  *at++ = static_cast<std::uint8_t>(bytes & 0xFFU);
  *at = static_cast<std::uint8_t>(bytes >> 8U);
  return message;
}

Bytes killing_statistics(VehicleId as) {
  Bytes message = rtps_message(as, kHeartbeat, 28);
  for (const std::uint8_t byte : kCutStatistics) message.push_back(byte);
  return message;
}

Bytes deafening_heartbeat(VehicleId as) { return rtps_message(as, kHeartbeat, 28); }

Bytes forged_seal(VehicleId as, Random& random) {
  Bytes datagram(seal::kOverheadBytes + random.index(kDatagramMax - seal::kOverheadBytes));
  fill(datagram, 0, random);
  seal::Header header;
  header.epoch = static_cast<std::uint8_t>(1 + random.index(2));
  header.from = {as, static_cast<std::uint16_t>(1 + random.index(3)),
                 static_cast<std::uint32_t>(random.index(1U << 24U))};
  header.counter = random.index(1'000'000);
  std::ranges::copy(to_bytes(header), datagram.begin());
  return datagram;
}

Bytes forged_news(Random& random) {
  Bytes datagram(4 + random.index(identity::kChangeBytesMax - 4));
  fill(datagram, 0, random);
  datagram[0] = identity::kChangeMark;
  datagram[1] = 1;
  return datagram;
}

Bytes noise(Random& random) {
  Bytes datagram(random.index(kDatagramMax));
  fill(datagram, 0, random);
  return datagram;
}

}  // namespace skein::intruder
