// SPDX-License-Identifier: Apache-2.0
#include "ports.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <optional>

#include "skein/base/random.hpp"

namespace skein::hil {

bool port_free(int type, const std::string& of, std::uint16_t port) {
  const int s = ::socket(AF_INET, type | SOCK_CLOEXEC, 0);
  if (s < 0) return false;
  const int reuse = type == SOCK_STREAM ? 1 : 0;  // connections that end are in nobody's way
  ::setsockopt(s, SOL_SOCKET, SO_REUSEADDR, &reuse, sizeof reuse);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  ::inet_pton(AF_INET, of.c_str(), &address.sin_addr);
  const bool free = ::bind(s, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  ::close(s);
  return free;
}

Result<std::uint16_t> port_block(const std::string& of, std::uint16_t wanted, std::size_t count) {
  const auto taken = [&](std::uint16_t base) -> std::optional<std::uint16_t> {
    for (std::size_t i = 0; i < count; ++i) {
      const auto port = static_cast<std::uint16_t>(base + i);
      if (!port_free(SOCK_DGRAM, of, port)) return port;
    }
    return std::nullopt;
  };
  if (wanted != 0) {
    if (wanted + count > 65535)
      return Error{"--port-base " + std::to_string(wanted) + " leaves no room for " +
                   std::to_string(count) + " ports"};
    if (const auto port = taken(wanted)) {
      return Error{
          "UDP port " + std::to_string(*port) +
          " is in use; name another --port-base, leave it out to have free ports looked for, "
          "or stop who uses it (ss -ulpn shows who)"};
    }
    return wanted;
  }
  Random random{static_cast<std::uint64_t>(::getpid())};
  for (int i = 0; i < 200; ++i) {
    const auto base = static_cast<std::uint16_t>(12'000 + 2 * random.index(10'000));
    if (!taken(base)) return base;
  }
  return Error{"no free block of " + std::to_string(count) + " UDP ports was found on " + of};
}

}  // namespace skein::hil
