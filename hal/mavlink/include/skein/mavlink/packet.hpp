// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "skein/base/static_vector.hpp"
#include "skein/mavlink/messages.hpp"

namespace skein::mavlink {

inline constexpr std::size_t kPayloadMax = 255;
/// Header 10, payload 255, checksum 2, signature 13 bytes.
inline constexpr std::size_t kPacketMax = 280;

using Payload = std::array<std::uint8_t, kPayloadMax>;
using WireBytes = StaticVector<std::uint8_t, kPacketMax>;

/// A packet as it came: checksum held, and its signature where one is asked for.
struct Packet {
  std::uint32_t id = 0;
  std::uint8_t version = 2;  ///< 1 or 2
  std::uint8_t system = 0;
  std::uint8_t component = 0;
  std::uint8_t sequence = 0;
  std::uint8_t length = 0;  ///< bytes of payload on the wire; the rest of it is zero
  bool is_signed = false;
  Payload payload{};
};

namespace wire {

template <std::size_t Size>
struct UnsignedOf;
template <>
struct UnsignedOf<1> {
  using Type = std::uint8_t;
};
template <>
struct UnsignedOf<2> {
  using Type = std::uint16_t;
};
template <>
struct UnsignedOf<4> {
  using Type = std::uint32_t;
};
template <>
struct UnsignedOf<8> {
  using Type = std::uint64_t;
};

/// Little endian, on any host.
template <class Element>
void put(Element value, std::uint8_t* out) {
  const auto bits = std::bit_cast<typename UnsignedOf<sizeof(Element)>::Type>(value);
  for (std::size_t i = 0; i < sizeof(Element); ++i) {
    out[i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(bits) >> (8 * i));
  }
}
template <class Element>
[[nodiscard]] Element get(const std::uint8_t* in) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < sizeof(Element); ++i) bits |= std::uint64_t{in[i]} << (8 * i);
  return std::bit_cast<Element>(static_cast<typename UnsignedOf<sizeof(Element)>::Type>(bits));
}

}  // namespace wire

/// The payload of a message, whole: nothing is truncated yet.
template <class Message>
[[nodiscard]] Payload to_payload(const Message& message) {
  Payload payload{};
  std::size_t at = 0;
  Message::kDefinition.for_each([&]<class V>(const Field<Message, V>& f) {
    if constexpr (FieldShape<V>::kCount == 0) {
      wire::put(message.*f.member, payload.data() + at);
      at += sizeof(V);
    } else {
      for (const auto element : message.*f.member) {
        wire::put(element, payload.data() + at);
        at += sizeof(element);
      }
    }
  });
  return payload;
}

template <class Message>
[[nodiscard]] Message from_payload(const Payload& payload) {
  Message message;
  std::size_t at = 0;
  Message::kDefinition.for_each([&]<class V>(const Field<Message, V>& f) {
    if constexpr (FieldShape<V>::kCount == 0) {
      message.*f.member = wire::get<V>(payload.data() + at);
      at += sizeof(V);
    } else {
      for (auto& element : message.*f.member) {
        element = wire::get<typename FieldShape<V>::Element>(payload.data() + at);
        at += sizeof(element);
      }
    }
  });
  return message;
}

/// The message in a packet, or nothing if it is another one. Fields that the sender left out, being
/// older or truncating zeros, are zero.
template <class Message>
[[nodiscard]] std::optional<Message> decode(const Packet& packet) {
  if (packet.id != Message::kDefinition.id) return std::nullopt;
  return from_payload<Message>(packet.payload);
}

/// The text in a field of characters: up to a zero, or all of it.
template <std::size_t Size>
[[nodiscard]] std::string text_of(const std::array<char, Size>& field) {
  return {field.data(), ::strnlen(field.data(), Size)};
}
/// As long as it fits.
template <std::size_t Size>
[[nodiscard]] std::array<char, Size> field_of(std::string_view text) {
  std::array<char, Size> field{};
  std::copy_n(text.begin(), std::min(text.size(), Size), field.begin());
  return field;
}

/// "HEARTBEAT custom_mode=10 type=1 ...", for people; a message not in use by its number and
/// length.
[[nodiscard]] std::string to_text(const Packet& packet);

}  // namespace skein::mavlink
