// SPDX-License-Identifier: Apache-2.0
#include "skein/mavlink/packet.hpp"

#include <array>
#include <charconv>
#include <string>

namespace skein::mavlink {
namespace {

template <class Value>
void append_number(std::string& text, Value value) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  text.append(digits.data(), end);
}

void append_element(std::string& text, ElementType type, const std::uint8_t* at) {
  switch (type) {
    case ElementType::i8:
      append_number(text, int{wire::get<std::int8_t>(at)});
      break;
    case ElementType::u8:
      append_number(text, unsigned{*at});
      break;
    case ElementType::i16:
      append_number(text, wire::get<std::int16_t>(at));
      break;
    case ElementType::u16:
      append_number(text, wire::get<std::uint16_t>(at));
      break;
    case ElementType::i32:
      append_number(text, wire::get<std::int32_t>(at));
      break;
    case ElementType::u32:
      append_number(text, wire::get<std::uint32_t>(at));
      break;
    case ElementType::i64:
      append_number(text, wire::get<std::int64_t>(at));
      break;
    case ElementType::u64:
      append_number(text, wire::get<std::uint64_t>(at));
      break;
    case ElementType::f32:
      append_number(text, wire::get<float>(at));
      break;
    case ElementType::f64:
      append_number(text, wire::get<double>(at));
      break;
    case ElementType::character:
      break;
  }
}

/// Bytes from outside end up on a terminal: nothing that moves its cursor.
void append_characters(std::string& text, const std::uint8_t* at, std::size_t count) {
  text += '"';
  for (std::size_t i = 0; i < count && at[i] != 0; ++i) {
    const bool plain = at[i] >= 0x20 && at[i] < 0x7F && at[i] != '"' && at[i] != '\\';
    text += plain ? static_cast<char>(at[i]) : '?';
  }
  text += '"';
}

void append_field(std::string& text, const FieldInfo& field, const Payload& payload) {
  const std::uint8_t* at = payload.data() + field.offset;
  text += ' ';
  text += field.name;
  text += '=';
  if (field.type == ElementType::character) {
    append_characters(text, at, field.count);
    return;
  }
  if (field.count == 0) {
    append_element(text, field.type, at);
    return;
  }
  for (std::size_t i = 0; i < field.count; ++i) {
    text += i == 0 ? '[' : ',';
    append_element(text, field.type, at + i * field.element_size);
  }
  text += ']';
}

}  // namespace

std::string to_text(const Packet& packet) {
  const MessageInfo* info = find_message(packet.id);
  std::string text;
  if (info == nullptr) {
    text = "message ";
    append_number(text, packet.id);
    text += ", bytes ";
    append_number(text, unsigned{packet.length});
    return text;
  }
  text = info->name;
  for (const FieldInfo& field : info->fields) append_field(text, field, packet.payload);
  return text;
}

}  // namespace skein::mavlink
