// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>
#include <utility>

#include "skein/mavlink/x25.hpp"

/// How a message is defined. A message is a plain struct with its fields in the order of the wire,
/// which is that of MAVLink 2: base fields by the size of their elements, largest first, then the
/// extensions as they were added. `kDefinition` in it names id, name and fields; encoding,
/// decoding, lengths, the CRC extra and the printed form all come from there.
namespace skein::mavlink {

enum class ElementType : std::uint8_t { i8, u8, i16, u16, i32, u32, i64, u64, f32, f64, character };

template <class Message, class Value>
struct Field {
  const char* name;
  Value Message::*member;
};

template <class Message, class Value>
consteval Field<Message, Value> field(const char* name, Value Message::*member) {
  return {name, member};
}

/// Of what a field is made: elements of one type; `kCount` is 0 for a lone one, as in the CRC
/// extra.
template <class Value>
struct FieldShape {
  using Element = Value;
  static constexpr std::size_t kCount = 0;
};
template <class Value, std::size_t Count>
struct FieldShape<std::array<Value, Count>> {
  using Element = Value;
  static constexpr std::size_t kCount = Count;
};

template <class Element>
consteval ElementType element_type() {
  if constexpr (std::is_same_v<Element, char>) return ElementType::character;
  if constexpr (std::is_same_v<Element, float>) return ElementType::f32;
  if constexpr (std::is_same_v<Element, double>) return ElementType::f64;
  if constexpr (std::is_same_v<Element, std::int8_t>) return ElementType::i8;
  if constexpr (std::is_same_v<Element, std::uint8_t>) return ElementType::u8;
  if constexpr (std::is_same_v<Element, std::int16_t>) return ElementType::i16;
  if constexpr (std::is_same_v<Element, std::uint16_t>) return ElementType::u16;
  if constexpr (std::is_same_v<Element, std::int32_t>) return ElementType::i32;
  if constexpr (std::is_same_v<Element, std::uint32_t>) return ElementType::u32;
  if constexpr (std::is_same_v<Element, std::int64_t>) return ElementType::i64;
  if constexpr (std::is_same_v<Element, std::uint64_t>) return ElementType::u64;
}

/// As MAVLink's definitions spell it; it goes into the CRC extra.
constexpr std::string_view type_name(ElementType type) {
  constexpr std::array<std::string_view, 11> kNames{"int8_t",  "uint8_t",  "int16_t", "uint16_t",
                                                    "int32_t", "uint32_t", "int64_t", "uint64_t",
                                                    "float",   "double",   "char"};
  return kNames.at(static_cast<std::size_t>(type));
}

/// What can be known of a field without its struct.
struct FieldInfo {
  std::string_view name;
  ElementType type = ElementType::u8;
  std::uint8_t element_size = 1;  ///< bytes
  std::uint8_t count = 0;         ///< elements; 0: a lone one
  std::uint8_t offset = 0;        ///< bytes from the start of the payload
  bool extension = false;         ///< not in MAVLink 1, nor in the CRC extra

  [[nodiscard]] constexpr std::size_t size() const {
    return element_size * (count == 0 ? std::size_t{1} : count);
  }
};

void fields_are_not_in_the_order_of_the_wire();  // never defined: named only to fail a consteval

/// Base and Extensions call what they are given with each of their fields: SKEIN_MAVLINK_FIELDS.
template <class Base, class Extensions>
struct Definition {
  std::uint32_t id;  ///< 24 bits
  const char* name;
  Base base;
  Extensions extensions;

  /// Calls `visit(field)` for each, in the order of the wire.
  template <class Visit>
  constexpr void for_each(Visit&& visit) const {
    base(visit);
    extensions(visit);
  }
};

struct NoFields {
  template <class Visit>
  constexpr void operator()(Visit& /*visit*/) const {}
};

template <class Base, class Extensions = NoFields>
consteval Definition<Base, Extensions> define(std::uint32_t id, const char* name, Base base,
                                              Extensions extensions = {}) {
  return {id, name, base, extensions};
}

template <class Fields>
consteval std::size_t count_of(const Fields& fields) {
  std::size_t count = 0;
  const auto add = [&count](const auto& /*field*/) { ++count; };
  fields(add);
  return count;
}

template <class Message>
consteval auto field_infos() {
  constexpr auto kDefinition = Message::kDefinition;
  constexpr std::size_t kBase = count_of(kDefinition.base);
  std::array<FieldInfo, kBase + count_of(kDefinition.extensions)> infos{};
  std::size_t i = 0;
  std::size_t offset = 0;
  std::size_t largest = 8;
  kDefinition.for_each([&]<class V>(const Field<Message, V>& f) {
    using Shape = FieldShape<V>;
    infos.at(i) = {f.name,
                   element_type<typename Shape::Element>(),
                   static_cast<std::uint8_t>(sizeof(typename Shape::Element)),
                   static_cast<std::uint8_t>(Shape::kCount),
                   static_cast<std::uint8_t>(offset),
                   i >= kBase};
    if (i < kBase && infos.at(i).element_size > largest) fields_are_not_in_the_order_of_the_wire();
    largest = infos.at(i).element_size;
    offset += infos.at(i).size();
    ++i;
  });
  return infos;
}
template <class Message>
inline constexpr auto kFieldInfos = field_infos<Message>();

/// What can be known of a message without its struct.
struct MessageInfo {
  std::uint32_t id = 0;
  std::string_view name;
  std::uint8_t crc_extra = 0;
  std::uint8_t base_length = 0;  ///< bytes of payload in MAVLink 1
  std::uint8_t length = 0;       ///< with the extensions
  std::span<const FieldInfo> fields;
};

/// The byte that ties a message to its definition: X.25 over name, types and names of the base
/// fields, folded (mavlink.io/en/guide/serialization.html, "CRC_EXTRA").
constexpr std::uint8_t crc_extra(std::string_view name, std::span<const FieldInfo> fields) {
  X25 crc;
  const auto add = [&crc](std::string_view text) {
    for (const char c : text) crc.add(static_cast<std::uint8_t>(c));
    crc.add(' ');
  };
  add(name);
  for (const FieldInfo& f : fields) {
    if (f.extension) break;
    add(type_name(f.type));
    add(f.name);
    if (f.count > 0) crc.add(f.count);
  }
  return static_cast<std::uint8_t>((crc.value() & 0xFF) ^ (crc.value() >> 8));
}

template <class Message>
consteval MessageInfo message_info() {
  const std::span<const FieldInfo> fields{kFieldInfos<Message>};
  MessageInfo info{Message::kDefinition.id,
                   Message::kDefinition.name,
                   crc_extra(Message::kDefinition.name, fields),
                   0,
                   0,
                   fields};
  for (const FieldInfo& f : fields) {
    info.length = static_cast<std::uint8_t>(info.length + f.size());
    if (!f.extension) info.base_length = info.length;
  }
  return info;
}
template <class Message>
inline constexpr MessageInfo kMessageInfo = message_info<Message>();

}  // namespace skein::mavlink

/// SKEIN_MAVLINK_FIELDS(Type, a, b, ...): what calls a visitor with a Field for each of the named
/// members of Type (60 at most). A function and not a tuple, since the 60 tuples took seconds of
/// every compilation. A macro, because the names are on the wire's checksum and would otherwise be
/// written twice.
#define SKEIN_MAVLINK_PARENS ()
#define SKEIN_MAVLINK_EXPAND(...) SKEIN_MAVLINK_EXPAND2(SKEIN_MAVLINK_EXPAND2(__VA_ARGS__))
#define SKEIN_MAVLINK_EXPAND2(...) SKEIN_MAVLINK_EXPAND1(SKEIN_MAVLINK_EXPAND1(__VA_ARGS__))
#define SKEIN_MAVLINK_EXPAND1(...) \
  SKEIN_MAVLINK_EXPAND0(           \
      SKEIN_MAVLINK_EXPAND0(SKEIN_MAVLINK_EXPAND0(SKEIN_MAVLINK_EXPAND0(__VA_ARGS__))))
#define SKEIN_MAVLINK_EXPAND0(...) __VA_ARGS__
#define SKEIN_MAVLINK_EACH(Type, name, ...)           \
  visit(::skein::mavlink::field(#name, &Type::name)); \
  __VA_OPT__(SKEIN_MAVLINK_AGAIN SKEIN_MAVLINK_PARENS(Type, __VA_ARGS__))
#define SKEIN_MAVLINK_AGAIN() SKEIN_MAVLINK_EACH
#define SKEIN_MAVLINK_FIELDS(Type, ...) \
  [](auto& visit) { SKEIN_MAVLINK_EXPAND(SKEIN_MAVLINK_EACH(Type, __VA_ARGS__)) }
