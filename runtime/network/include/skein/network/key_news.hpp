// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/identity/key_change.hpp"

namespace skein::network {

/// That the team's key has changed, for one member (identity::KeyChange as bytes). It goes in
/// clear, since who missed it cannot read what is sealed by now.
struct KeyNews {
  VehicleId member;
  std::uint8_t epoch = 0;  ///< told until the member is heard under this one or a later one
  std::vector<std::uint8_t> change;
};

/// Such a datagram is a KeyChange, whose first byte marks it, and who sends it, for radios.
inline constexpr std::size_t kNewsSenderBytes = 2;
[[nodiscard]] inline bool is_key_news(std::span<const std::uint8_t> datagram) {
  return datagram.size() > 1 + kNewsSenderBytes && datagram[0] == identity::kChangeMark &&
         datagram.size() <= identity::kChangeBytesMax + kNewsSenderBytes;
}
/// Who sends it, as it says; none for any other datagram.
[[nodiscard]] inline std::optional<VehicleId> key_news_sender(
    std::span<const std::uint8_t> datagram) {
  if (!is_key_news(datagram)) return std::nullopt;
  const auto sender = datagram.last(kNewsSenderBytes);
  return VehicleId{static_cast<std::uint16_t>(sender[0] << 8 | sender[1])};
}

}  // namespace skein::network
