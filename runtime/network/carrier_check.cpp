// SPDX-License-Identifier: Apache-2.0
#include "carrier_check.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <system_error>
#include <thread>
#include <vector>

#include "carrier_messages.hpp"

namespace skein::network {
namespace {

/// Of a node that was killed: its carrier's process is found dead a little later.
constexpr std::chrono::milliseconds kPredecessorEndsWithin{500};
constexpr std::chrono::milliseconds kBindAgain{10};

/// Binds and lets go: Fast DDS itself would carry on in silence with a port that it did not get.
Result<void> check_free(const Endpoint& endpoint, std::uint16_t port) {
  const Endpoint wanted{endpoint.address, port};
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  inet_pton(AF_INET, endpoint.address.c_str(), &address.sin_addr);
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return Error{std::string{"no UDP socket: "} + std::generic_category().message(errno)};
  int status = 0;
  int reason = 0;
  const auto end = std::chrono::steady_clock::now() + kPredecessorEndsWithin;
  do {
    if (reason != 0) std::this_thread::sleep_for(kBindAgain);
    status = bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address);
    reason = status == 0 ? 0 : errno;
  } while (reason == EADDRINUSE && std::chrono::steady_clock::now() < end);
  close(fd);
  if (status == 0) return {};
  if (reason == EADDRINUSE) {
    return Error{"UDP port " + to_text(wanted) +
                 " is already in use: is another node running with this address and port?"};
  }
  if (reason == EADDRNOTAVAIL) {
    return Error{"no network interface of this machine has the address " + endpoint.address};
  }
  return Error{"cannot listen on " + to_text(wanted) + ": " +
               std::generic_category().message(reason)};
}

Result<void> check_endpoint(const std::string& who, const Endpoint& e) {
  in_addr parsed{};
  if (inet_pton(AF_INET, e.address.c_str(), &parsed) != 1) {
    return Error{who + ": '" + e.address + "' is no IPv4 address (such as 10.0.0.5)"};
  }
  if (e.port < 1024 || e.port > 65534) {
    return Error{who + ": port " + std::to_string(e.port) + " is not within 1024 to 65534"};
  }
  return {};
}

}  // namespace

std::string to_text(const Endpoint& e) { return e.address + ":" + std::to_string(e.port); }

Result<void> check(const CarrierConfig& config) {
  const std::string self = "node " + std::to_string(config.self.value);
  if (config.domain > 232) {
    return Error{self + ": domain " + std::to_string(config.domain) + " is not within 0 to 232"};
  }
  if (auto r = check_endpoint(self, config.endpoint); !r) return r;
  std::vector<PeerConfig> seen{{config.self, config.endpoint}};
  for (const PeerConfig& peer : config.peers) {
    const std::string name = self + ": peer " + std::to_string(peer.id.value);
    if (auto r = check_endpoint(name, peer.endpoint); !r) return r;
    for (const PeerConfig& other : seen) {
      if (other.id == peer.id) {
        return Error{name + (peer.id == config.self ? " is this node itself: leave it out"
                                                    : " is listed twice")};
      }
      if (other.endpoint.address == peer.endpoint.address &&
          std::abs(int{other.endpoint.port} - int{peer.endpoint.port}) < 2) {
        return Error{name + " at " + to_text(peer.endpoint) + " shares a port with node " +
                     std::to_string(other.id.value) + " at " + to_text(other.endpoint) +
                     ": each node needs two ports, its own and the next"};
      }
    }
    seen.push_back(peer);
  }
  if (config.peers.size() > kCarrierPeersMax) {
    return Error{self + ": more than " + std::to_string(kCarrierPeersMax) + " peers"};
  }
  if (config.transport_plugin.size() > kCarrierTextMax) {
    return Error{self + ": the path of the transport plugin is too long"};
  }
  return {};
}

Result<void> check_ports(const CarrierConfig& config) {
  for (const int offset : {0, 1}) {
    const auto port = static_cast<std::uint16_t>(config.endpoint.port + offset);
    if (auto r = check_free(config.endpoint, port); !r) return r;
  }
  return {};
}

}  // namespace skein::network
