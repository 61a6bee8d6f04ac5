// SPDX-License-Identifier: Apache-2.0
#include "socket.hpp"

#include <net/if.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <system_error>

namespace skein::can {

Error system_error(const std::string& what) {
  return Error{what + ": " + std::generic_category().message(errno)};
}

std::optional<Datagram> receive_datagram(const Descriptor& socket, std::span<std::uint8_t> buffer,
                                         std::uint64_t& lost) {
  Datagram datagram;
  iovec part{buffer.data(), buffer.size()};
  alignas(cmsghdr) std::array<std::uint8_t, 256> control{};
  msghdr message{};
  message.msg_name = &datagram.source;
  message.msg_namelen = sizeof(datagram.source);
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t size = ::recvmsg(socket.get(), &message, MSG_DONTWAIT);
  if (size < 0) return std::nullopt;
  datagram.size = static_cast<std::size_t>(size);
  datagram.flags = message.msg_flags;
  for (cmsghdr* item = CMSG_FIRSTHDR(&message); item != nullptr;
       item = CMSG_NXTHDR(&message, item)) {
    if (item->cmsg_level != SOL_SOCKET) continue;
    if (item->cmsg_type == SCM_TIMESTAMPNS) {
      timespec time{};
      std::memcpy(&time, CMSG_DATA(item), sizeof(time));
      datagram.timestamp = std::chrono::seconds{time.tv_sec} + Duration{time.tv_nsec};
    } else if (item->cmsg_type == SO_RXQ_OVFL) {
      std::uint32_t dropped = 0;
      std::memcpy(&dropped, CMSG_DATA(item), sizeof(dropped));
      // The kernel counts in 32 bits, since the socket was made.
      lost += dropped - static_cast<std::uint32_t>(lost);
    }
  }
  return datagram;
}

bool ask_for_times_and_losses(const Descriptor& socket, int receive_buffer_bytes) {
  constexpr int kOn = 1;
  // Beyond the machine's limit only the superuser gets what is asked.
  if (!set_option(socket, SOL_SOCKET, SO_RCVBUFFORCE, receive_buffer_bytes)) {
    (void)set_option(socket, SOL_SOCKET, SO_RCVBUF, receive_buffer_bytes);
  }
  return set_option(socket, SOL_SOCKET, SO_TIMESTAMPNS, kOn) &&
         set_option(socket, SOL_SOCKET, SO_RXQ_OVFL, kOn);
}

std::optional<unsigned> interface_flags(const std::string& interface) {
  const Descriptor any{::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  if (!any || interface.size() >= IFNAMSIZ) return std::nullopt;
  ifreq request{};
  std::copy(interface.begin(), interface.end(), std::begin(request.ifr_name));
  if (::ioctl(any.get(), SIOCGIFFLAGS, &request) != 0) return std::nullopt;
  return static_cast<unsigned short>(request.ifr_flags);
}

}  // namespace skein::can
