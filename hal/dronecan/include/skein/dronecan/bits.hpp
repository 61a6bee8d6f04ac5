// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

/// DroneCAN's bit order: a value is cut into bytes, the least significant first; the bits of each
/// piece follow the most significant first, from the most significant bit of a byte on. The last
/// piece may be shorter than a byte (dronecan.github.io, "Data serialization").
namespace skein::dronecan {

/// Writes into a buffer of zeros; what does not fit is left out and makes ok() false.
class BitWriter {
 public:
  explicit BitWriter(std::span<std::uint8_t> buffer) : buffer_{buffer} {}

  /// The lowest `bits` (1 to 64) of a value.
  void put(std::uint64_t value, unsigned bits);

  [[nodiscard]] std::size_t bits() const { return at_; }
  /// Bytes that hold what was written.
  [[nodiscard]] std::size_t size() const { return (at_ + 7) / 8; }
  [[nodiscard]] bool ok() const { return ok_; }

 private:
  std::span<std::uint8_t> buffer_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

/// Reads; beyond the end everything is zero and ok() is false.
class BitReader {
 public:
  explicit BitReader(std::span<const std::uint8_t> bytes) : bytes_{bytes} {}

  [[nodiscard]] std::uint64_t get(unsigned bits);
  /// The same as a signed number.
  [[nodiscard]] std::int64_t get_signed(unsigned bits);

  [[nodiscard]] std::size_t left() const { return bytes_.size() * 8 - at_; }
  [[nodiscard]] bool ok() const { return ok_; }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

}  // namespace skein::dronecan
