// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "descriptor.hpp"
#include "skein/base/result.hpp"
#include "skein/network/node.hpp"

namespace skein::network {

/// A UDP socket that speaks to all who listen to one group: a multicast address, or that of a
/// broadcast. Several programs of one machine may.
class AirSocket {
 public:
  /// `group` is where all listen; `interface` is this machine's address on that network.
  [[nodiscard]] static Result<AirSocket> open(const Endpoint& group, const std::string& interface);

  [[nodiscard]] int descriptor() const { return socket_.get(); }
  /// False where it could not be sent; nobody is waited for.
  bool send(std::span<const std::uint8_t> datagram);
  /// All that has come, at most so many.
  void receive(std::size_t limit, const std::function<void(std::span<const std::uint8_t>)>& take);

 private:
  AirSocket(Descriptor socket, std::uint32_t group, std::uint16_t port)
      : socket_{std::move(socket)}, group_{group}, port_{port} {}
  Descriptor socket_;
  std::uint32_t group_;  ///< in network order
  std::uint16_t port_;
  std::vector<std::uint8_t> buffer_ = std::vector<std::uint8_t>(65'536);
};

}  // namespace skein::network
