// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "skein/codec/topics.hpp"
#include "skein/mission/messages.hpp"

namespace skein::codec {

/// What is accepted, in both directions; beyond it a message is a bad value. The bounds keep the
/// arithmetic of whoever receives it free of overflow; whether a value makes sense is theirs to
/// judge. Besides these: limits of coalition/messages.hpp, enumerators that exist, valid UTF-8.
inline constexpr Duration kTimeMax = std::chrono::hours{24 * 3650};  ///< |instant|, and durations
inline constexpr double kDistanceMaxM = 1e8;                         ///< positions, radii, ranges
inline constexpr double kSpeedMaxMps = 1e4;
inline constexpr double kAngleMaxRad = 100.0;
inline constexpr double kCurvatureMaxPerM = 100.0;
inline constexpr double kNumberMax = 1e15;  ///< rewards and the values of events

/// Why bytes are no message.
enum class Fault : std::uint8_t {
  malformed,    ///< too short, too long, or not what CDR allows
  bad_version,  ///< of another version of the wire types
  bad_value,    ///< a field is out of its range
};

/// The bytes of a sample: XCDR1, little endian, with the 4-byte encapsulation header. None where a
/// value is out of range: a node does not send what its peers would drop. Texts are cut to
/// coalition::kReasonMax bytes, at a character.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> encode(const mission::Message& message);

/// The message in the bytes of a sample on that topic. Any bytes are safe.
[[nodiscard]] std::variant<mission::Message, Fault> decode(Topic topic,
                                                           std::span<const std::uint8_t> bytes);

/// The most bytes that a message of the topic can have.
[[nodiscard]] std::size_t encoded_size_max(Topic topic);

}  // namespace skein::codec
