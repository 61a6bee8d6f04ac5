// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <random>
#include <set>
#include <vector>

namespace skein::network {

[[nodiscard]] inline bool udp_port_is_free(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const bool is_free =
      fd >= 0 && bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  close(fd);
  return is_free;
}

/// Ports p where p and p + 1 are free on loopback now, at random so that tests that run at the same
/// time do not meet; below the range from which the kernel hands out ports by itself.
[[nodiscard]] inline std::vector<std::uint16_t> free_port_pairs(std::size_t count) {
  std::random_device device;
  std::uniform_int_distribution<int> half{5000, 15999};
  std::set<std::uint16_t> ports;
  while (ports.size() < count) {
    const auto port = static_cast<std::uint16_t>(2 * half(device));
    if (udp_port_is_free(port) && udp_port_is_free(static_cast<std::uint16_t>(port + 1))) {
      ports.insert(port);
    }
  }
  return {ports.begin(), ports.end()};
}

}  // namespace skein::network
