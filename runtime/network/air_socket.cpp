// SPDX-License-Identifier: Apache-2.0
#include "air_socket.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

namespace skein::network {
namespace {

constexpr int kBufferBytes = 1 << 20;

template <class Value>
bool set(int socket, int level, int option, const Value& value) {
  return setsockopt(socket, level, option, &value, sizeof value) == 0;
}

Error failed(const Endpoint& group, const std::string& what) {
  return Error{"the air, " + group.address + ":" + std::to_string(group.port) + ": " + what + ": " +
               std::generic_category().message(errno)};
}

}  // namespace

Result<AirSocket> AirSocket::open(const Endpoint& group, const std::string& interface) {
  in_addr to{};
  in_addr from{};
  if (inet_pton(AF_INET, group.address.c_str(), &to) != 1) {
    return Error{group.address + " is not an IPv4 address"};
  }
  if (inet_pton(AF_INET, interface.c_str(), &from) != 1) {
    return Error{interface + " is not an IPv4 address"};
  }
  system::Descriptor s{socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)};
  if (s.get() < 0) return failed(group, "no socket");
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(group.port);
  address.sin_addr = to;  // so that only what is for the group comes
  if (!set(s.get(), SOL_SOCKET, SO_REUSEADDR, 1) || !set(s.get(), SOL_SOCKET, SO_BROADCAST, 1) ||
      bind(s.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return failed(group, "cannot be listened to");
  }
  (void)set(s.get(), SOL_SOCKET, SO_RCVBUF, kBufferBytes);
  (void)set(s.get(), SOL_SOCKET, SO_SNDBUF, kBufferBytes);
  if (IN_MULTICAST(ntohl(to.s_addr))) {
    const ip_mreqn membership{to, from, 0};
    if (!set(s.get(), IPPROTO_IP, IP_ADD_MEMBERSHIP, membership) ||
        !set(s.get(), IPPROTO_IP, IP_MULTICAST_IF, membership) ||
        !set(s.get(), IPPROTO_IP, IP_MULTICAST_LOOP, 1) ||
        !set(s.get(), IPPROTO_IP, IP_MULTICAST_TTL, 1)) {
      return failed(group, "cannot be joined from " + interface);
    }
    (void)set(s.get(), IPPROTO_IP, IP_MULTICAST_ALL, 0);
  }
  return AirSocket{std::move(s), to.s_addr, htons(group.port)};
}

bool AirSocket::send(std::span<const std::uint8_t> datagram) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = port_;
  to.sin_addr.s_addr = group_;
  return sendto(socket_.get(), datagram.data(), datagram.size(), MSG_NOSIGNAL,
                reinterpret_cast<const sockaddr*>(&to),
                sizeof to) == static_cast<ssize_t>(datagram.size());
}

bool AirSocket::receive(const std::function<void(std::span<const std::uint8_t>)>& take) {
  std::array<mmsghdr, kAtOnce> messages{};
  std::array<iovec, kAtOnce> places{};
  for (std::size_t i = 0; i < kAtOnce; ++i) {
    places.at(i) = {buffer_.data() + i * kDatagramMax, kDatagramMax};
    messages.at(i).msg_hdr.msg_iov = &places.at(i);
    messages.at(i).msg_hdr.msg_iovlen = 1;
  }
  const int count = recvmmsg(socket_.get(), messages.data(), kAtOnce, MSG_DONTWAIT, nullptr);
  for (std::size_t i = 0; static_cast<int>(i) < count; ++i) {
    if ((messages.at(i).msg_hdr.msg_flags & MSG_TRUNC) != 0) continue;  // none of ours
    take({buffer_.data() + i * kDatagramMax, messages.at(i).msg_len});
  }
  return count == static_cast<int>(kAtOnce);
}

}  // namespace skein::network
