// SPDX-License-Identifier: Apache-2.0
#include "skein/dronecan/bits.hpp"

#include <algorithm>

#include "skein/base/assert.hpp"

namespace skein::dronecan {

void BitWriter::put(std::uint64_t value, unsigned bits) {
  SKEIN_ASSERT(bits >= 1 && bits <= 64);
  if (bits > buffer_.size() * 8 - at_) {
    ok_ = false;
    return;
  }
  for (unsigned done = 0; done < bits; done += 8) {
    const unsigned piece = std::min(bits - done, 8U);
    for (unsigned i = piece; i-- > 0; ++at_) {
      const auto bit = static_cast<std::uint8_t>((value >> (done + i)) & 1U);
      buffer_[at_ / 8] = static_cast<std::uint8_t>(buffer_[at_ / 8] | bit << (7 - at_ % 8));
    }
  }
}

std::uint64_t BitReader::get(unsigned bits) {
  SKEIN_ASSERT(bits >= 1 && bits <= 64);
  if (bits > left()) {
    ok_ = false;
    at_ = bytes_.size() * 8;
    return 0;
  }
  std::uint64_t value = 0;
  for (unsigned done = 0; done < bits; done += 8) {
    const unsigned piece = std::min(bits - done, 8U);
    for (unsigned i = piece; i-- > 0; ++at_) {
      const std::uint64_t bit = (bytes_[at_ / 8] >> (7 - at_ % 8)) & 1U;
      value |= bit << (done + i);
    }
  }
  return value;
}

std::int64_t BitReader::get_signed(unsigned bits) {
  const std::uint64_t value = get(bits);
  if (bits == 64 || (value >> (bits - 1)) == 0) return static_cast<std::int64_t>(value);
  return static_cast<std::int64_t>(value | ~std::uint64_t{0} << bits);
}

}  // namespace skein::dronecan
