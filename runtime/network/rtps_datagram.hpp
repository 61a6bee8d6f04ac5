// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace skein::network {

/// The RTPS message without the statistics that Debian's Fast DDS appends to each for tools that we
/// do not use: 60 bytes, for which its parser aborts where they are cut. None where the message is
/// no sequence of whole submessages (RTPS 2.3, 8.3.3), or has such statistics elsewhere.
[[nodiscard]] std::optional<std::span<const std::uint8_t>> without_statistics(
    std::span<const std::uint8_t> message);

/// Whether Fast DDS, when it sends these bytes, would take their end for its statistics and write
/// over it: it looks at one byte.
[[nodiscard]] bool looks_like_statistics(std::span<const std::uint8_t> datagram);

/// What a participant of that GUID prefix says last of all (RTPS 2.3, 8.5.3: its own data, disposed
/// of): others forget it.
[[nodiscard]] std::vector<std::uint8_t> participant_gone(std::span<const std::uint8_t> prefix);

}  // namespace skein::network
