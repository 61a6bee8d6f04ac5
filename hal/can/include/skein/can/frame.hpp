// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "skein/base/time.hpp"

namespace skein::can {

inline constexpr std::uint32_t kStandardIdMask = 0x7FF;
inline constexpr std::uint32_t kExtendedIdMask = 0x1FFFFFFF;
inline constexpr std::size_t kClassicDataMax = 8;
inline constexpr std::size_t kFdDataMax = 64;

/// A frame of classic CAN or CAN FD.
struct Frame {
  std::uint32_t id = 0;  ///< 11 bits, or 29 if extended; of an error frame, the kernel's class bits
  bool extended = false;  ///< 29-bit id
  bool rtr = false;       ///< asks for data (classic only); carries none
  bool error = false;     ///< made by the controller's driver: linux/can/error.h says what it means
  bool fd = false;
  bool brs = false;       ///< FD: data at the second bit rate
  std::uint8_t size = 0;  ///< bytes of data; FD: one of 0..8, 12, 16, 20, 24, 32, 48, 64
  std::array<std::uint8_t, kFdDataMax> data{};
  /// Since the Unix epoch, by the kernel, when it arrived; just after a bus was opened it may be
  /// when it was read. 0: not known.
  Duration timestamp{};

  [[nodiscard]] std::span<const std::uint8_t> payload() const { return {data.data(), size}; }
};

/// The same on the wire: everything but the time.
[[nodiscard]] inline bool same_content(const Frame& a, const Frame& b) {
  return a.id == b.id && a.extended == b.extended && a.rtr == b.rtr && a.error == b.error &&
         a.fd == b.fd && a.brs == b.brs && std::ranges::equal(a.payload(), b.payload());
}

/// The least number of bytes that an FD frame can have for `size` of them. Precondition: <= 64.
[[nodiscard]] constexpr std::size_t fd_size(std::size_t size) {
  constexpr std::array<std::size_t, 7> kSizes{12, 16, 20, 24, 32, 48, 64};
  if (size <= kClassicDataMax) return size;
  return *std::lower_bound(kSizes.begin(), kSizes.end(), size);
}

/// Whether it can be on a bus: its id fits, its size is one of those that there are.
[[nodiscard]] constexpr bool is_valid(const Frame& frame) {
  if (frame.id > (frame.extended || frame.error ? kExtendedIdMask : kStandardIdMask)) return false;
  if (frame.fd) return !frame.rtr && frame.size <= kFdDataMax && fd_size(frame.size) == frame.size;
  return frame.size <= kClassicDataMax && !frame.brs && (!frame.rtr || frame.size == 0);
}

}  // namespace skein::can
