// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/network/node.hpp"
#include "skein/system/descriptor.hpp"

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
  /// What has come, at most kAtOnce; true where that is so much that there may be more. What is
  /// longer than kDatagramMax is dropped.
  bool receive(const std::function<void(std::span<const std::uint8_t>)>& take);
  static constexpr std::size_t kAtOnce = 32;
  static constexpr std::size_t kDatagramMax = 2048;

 private:
  AirSocket(system::Descriptor socket, std::uint32_t group, std::uint16_t port)
      : socket_{std::move(socket)}, group_{group}, port_{port} {}
  system::Descriptor socket_;
  std::uint32_t group_;  ///< in network order
  std::uint16_t port_;
  std::vector<std::uint8_t> buffer_ = std::vector<std::uint8_t>(kAtOnce * kDatagramMax);
};

}  // namespace skein::network
