// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "skein/can/bus.hpp"

namespace skein::can {

/// What the kernel knows of the interface that a bus is on.
struct InterfaceFacts {
  std::string name;
  bool over_udp = false;  ///< a multicast bus: it has no bit rate and no error counters
  bool is_there = false;
  bool is_up = false;
  std::optional<std::uint32_t> bitrate;  ///< of the nominal bits; none of a virtual one
  std::optional<State> state;            ///< of its controller, where it has one
  std::uint64_t receive_errors = 0;
  std::uint64_t transmit_errors = 0;
};
/// `bus` as open() takes it. Asks no right.
[[nodiscard]] InterfaceFacts interface_of(const std::string& bus);

}  // namespace skein::can
