// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/random.hpp"
#include "skein/can/frame.hpp"

namespace skein::can {

/// Any frame that can be on a bus.
inline Frame random_frame(Random& random) {
  Frame frame;
  frame.extended = random.chance(0.5);
  frame.fd = random.chance(0.3);
  frame.brs = frame.fd && random.chance(0.5);
  frame.rtr = !frame.fd && random.chance(0.1);
  frame.id = static_cast<std::uint32_t>(random.next()) &
             (frame.extended ? kExtendedIdMask : kStandardIdMask);
  const std::size_t size = frame.rtr ? 0 : random.index(frame.fd ? 65 : 9);
  frame.size = static_cast<std::uint8_t>(frame.fd ? fd_size(size) : size);
  for (std::size_t i = 0; i < frame.size; ++i) {
    frame.data[i] = static_cast<std::uint8_t>(random.next());
  }
  return frame;
}

inline std::vector<std::uint8_t> bytes_of(std::string_view hex) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    bytes.push_back(
        static_cast<std::uint8_t>(std::stoul(std::string{hex.substr(i, 2)}, nullptr, 16)));
  }
  return bytes;
}

}  // namespace skein::can
