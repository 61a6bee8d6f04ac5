// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "skein/base/static_vector.hpp"
#include "skein/dronecan/bits.hpp"

/// How a message is defined: a plain struct whose `kDefinition` names type, signature and fields
/// with their widths in bits. Encoding, decoding and the printed form all come from there. A member
/// may be an integer or enum, an array of them, bytes of a variable number (Bytes), or another
/// defined struct.
namespace skein::dronecan {

/// uint8[<=Max] of the definition language.
template <std::size_t Max>
using Bytes = StaticVector<std::uint8_t, Max>;

enum class TypeKind : std::uint8_t { message, service, part };

/// `bits`: of one element; 0 for a struct, whose own fields say.
template <class Message, class Value>
struct Field {
  const char* name;
  Value Message::*member;
  unsigned bits;
};

template <class Message, class Value>
consteval Field<Message, Value> field(const char* name, Value Message::*member, unsigned bits = 0) {
  return {name, member, bits};
}

template <class... Fields>
struct Definition {
  TypeKind kind;
  std::uint16_t id;  ///< 16 bits for a message, 8 for a service
  const char* name;
  std::uint64_t signature;  ///< of the data type: enters the CRC of a transfer of many frames
  std::tuple<Fields...> fields;
};

template <class... Fields>
consteval Definition<Fields...> message(std::uint16_t id, const char* name, std::uint64_t signature,
                                        Fields... fields) {
  return {TypeKind::message, id, name, signature, {fields...}};
}
template <class... Fields>
consteval Definition<Fields...> service(std::uint16_t id, const char* name, std::uint64_t signature,
                                        Fields... fields) {
  return {TypeKind::service, id, name, signature, {fields...}};
}
/// A struct that only stands in others.
template <class... Fields>
consteval Definition<Fields...> part(Fields... fields) {
  return {TypeKind::part, 0, "", 0, {fields...}};
}

template <class T>
concept Defined = requires {
  T::kDefinition.fields;
};

template <class T>
inline constexpr bool kIsBytes = false;
template <std::size_t Max>
inline constexpr bool kIsBytes<StaticVector<std::uint8_t, Max>> = true;

template <class T>
inline constexpr bool kIsArray = false;
template <class T, std::size_t Count>
inline constexpr bool kIsArray<std::array<T, Count>> = true;

/// Bits of the length of a variable array.
template <std::size_t Max>
constexpr unsigned length_bits(const StaticVector<std::uint8_t, Max>& /*bytes*/) {
  return static_cast<unsigned>(std::bit_width(Max));
}

/// Whether the array that ends a message goes without its length: so it is on classic CAN, where
/// the end of the transfer tells ("tail array optimisation"). CAN FD pads frames, so there it has
/// one.
enum class TailArray : bool { with_length, bare };

namespace wire {

template <class Value>
void put_scalar(BitWriter& writer, Value value, unsigned bits) {
  writer.put(static_cast<std::uint64_t>(value), bits);
}

template <class Value>
[[nodiscard]] Value get_scalar(BitReader& reader, unsigned bits) {
  if constexpr (std::is_signed_v<Value>) {
    return static_cast<Value>(reader.get_signed(bits));
  } else {
    return static_cast<Value>(reader.get(bits));
  }
}

template <class Message>
void encode(const Message& message, BitWriter& writer, TailArray tail) {
  const auto put = [&]<class Value>(const Field<Message, Value>& f, bool last) {
    const Value& value = message.*f.member;
    const TailArray inner = last ? tail : TailArray::with_length;
    if constexpr (Defined<Value>) {
      encode(value, writer, inner);
    } else if constexpr (kIsBytes<Value>) {
      if (inner == TailArray::with_length) writer.put(value.size(), length_bits(value));
      for (const std::uint8_t byte : value) writer.put(byte, f.bits);
    } else if constexpr (kIsArray<Value>) {
      for (const auto element : value) put_scalar(writer, element, f.bits);
    } else {
      put_scalar(writer, value, f.bits);
    }
  };
  std::apply(
      [&](const auto&... f) {
        [[maybe_unused]] std::size_t left = sizeof...(f);
        (put(f, --left == 0), ...);
      },
      Message::kDefinition.fields);
}

/// False for an array that is longer than its type allows.
template <class Message>
[[nodiscard]] bool decode(BitReader& reader, TailArray tail, Message& message) {
  bool ok = true;
  const auto get = [&]<class Value>(const Field<Message, Value>& f, bool last) {
    Value& value = message.*f.member;
    const TailArray inner = last ? tail : TailArray::with_length;
    if constexpr (Defined<Value>) {
      ok = decode(reader, inner, value) && ok;
    } else if constexpr (kIsBytes<Value>) {
      const std::size_t count = inner == TailArray::with_length
                                    ? static_cast<std::size_t>(reader.get(length_bits(value)))
                                    : reader.left() / f.bits;
      ok = ok && count <= Value::capacity();
      for (std::size_t i = 0; ok && i < count; ++i) {
        value.push_back(static_cast<std::uint8_t>(reader.get(f.bits)));
      }
    } else if constexpr (kIsArray<Value>) {
      for (auto& element : value) {
        element = get_scalar<typename Value::value_type>(reader, f.bits);
      }
    } else {
      value = get_scalar<Value>(reader, f.bits);
    }
  };
  std::apply(
      [&](const auto&... f) {
        [[maybe_unused]] std::size_t left = sizeof...(f);
        (get(f, --left == 0), ...);
      },
      Message::kDefinition.fields);
  return ok && reader.ok();
}

void append(std::string& text, std::string_view name, std::int64_t value);
void append(std::string& text, std::string_view name, std::uint64_t value);
void append(std::string& text, std::string_view name, std::span<const std::uint8_t> bytes);

template <class Message>
void append_fields(std::string& text, const Message& message) {
  const auto add = [&]<class Value>(const Field<Message, Value>& f) {
    const Value& value = message.*f.member;
    if constexpr (Defined<Value>) {
      append_fields(text, value);
    } else if constexpr (kIsBytes<Value> || kIsArray<Value>) {
      append(text, f.name, std::span<const std::uint8_t>{value});
    } else if constexpr (std::is_signed_v<Value>) {
      append(text, f.name, std::int64_t{value});
    } else {
      append(text, f.name, static_cast<std::uint64_t>(value));
    }
  };
  std::apply([&](const auto&... f) { (add(f), ...); }, Message::kDefinition.fields);
}

}  // namespace wire

}  // namespace skein::dronecan
