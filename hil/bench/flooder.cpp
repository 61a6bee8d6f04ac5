// SPDX-License-Identifier: Apache-2.0
#include "flooder.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>
#include <vector>

#include "skein/seal/header.hpp"

namespace skein::hil {

bool Flooder::is_wanted(const configuration::Scenario& scenario) {
  return std::ranges::any_of(scenario.faults, [](const configuration::Fault& fault) {
    return fault.kind == configuration::FaultKind::flood;
  });
}

Result<Flooder> Flooder::open(const std::string& group, std::uint16_t port,
                              const std::string& address) {
  Flooder flooder{::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)};
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  in_addr from{};
  const int yes = 1;
  if (flooder.socket_ < 0 || ::inet_pton(AF_INET, group.c_str(), &to.sin_addr) != 1 ||
      ::inet_pton(AF_INET, address.c_str(), &from) != 1 ||
      ::setsockopt(flooder.socket_, IPPROTO_IP, IP_MULTICAST_IF, &from, sizeof from) != 0 ||
      ::setsockopt(flooder.socket_, SOL_SOCKET, SO_BROADCAST, &yes, sizeof yes) != 0 ||
      ::connect(flooder.socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) {
    return Error{"nothing can flood " + group + ": " + std::generic_category().message(errno)};
  }
  return flooder;
}

Flooder::~Flooder() {
  if (socket_ >= 0) ::close(socket_);
}

Flooder::Flooder(Flooder&& other) noexcept
    : socket_{std::exchange(other.socket_, -1)}, random_{other.random_} {}

void Flooder::say(const radio::Flood& flood, std::chrono::duration<double> time) {
  const auto datagrams = static_cast<std::size_t>(radio::Flood::kDatagrams_per_s * time.count());
  std::vector<std::uint8_t> datagram(
      std::max<std::size_t>(radio::Flood::kBytes, seal::kOverheadBytes));
  for (std::size_t i = 0; i < datagrams; ++i) {
    for (std::uint8_t& byte : datagram) byte = static_cast<std::uint8_t>(random_.index(256));
    seal::Header header;
    header.epoch = 1;
    header.from = {flood.vehicle, 1, static_cast<std::uint32_t>(random_.index(1U << 24U))};
    header.counter = random_.index(1'000'000);
    std::ranges::copy(to_bytes(header), datagram.begin());
    (void)::send(socket_, datagram.data(), datagram.size(), MSG_NOSIGNAL);
  }
}

}  // namespace skein::hil
