// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "skein/idl/domain.hpp"

namespace skein {

/// A set of task kinds.
class Capabilities {
 public:
  constexpr Capabilities() = default;
  explicit constexpr Capabilities(unsigned bits) : bits_{static_cast<std::uint8_t>(bits & 0x7U)} {}
  [[nodiscard]] constexpr bool has(TaskKind kind) const { return (bits_ & bit(kind)) != 0; }
  constexpr Capabilities& add(TaskKind kind) {
    bits_ = static_cast<std::uint8_t>(bits_ | bit(kind));
    return *this;
  }
  [[nodiscard]] constexpr std::uint8_t bits() const { return bits_; }
  [[nodiscard]] static constexpr Capabilities from_bits(std::uint8_t bits) {
    return Capabilities{bits};
  }
  friend constexpr bool operator==(Capabilities, Capabilities) = default;

 private:
  [[nodiscard]] static constexpr std::uint8_t bit(TaskKind kind) {
    return static_cast<std::uint8_t>(1U << static_cast<unsigned>(kind));
  }
  std::uint8_t bits_ = 0;
};

/// "site 1 deliver 3"
[[nodiscard]] std::string to_string(const TaskId& task);

}  // namespace skein
