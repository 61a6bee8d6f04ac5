// SPDX-License-Identifier: Apache-2.0
#include "skein/dronecan/messages.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include "skein/dronecan/transfer.hpp"

namespace skein::dronecan {
namespace {

using TextOf = bool (*)(const Transfer& transfer, std::string& text);

template <class Message>
bool text_of(const Transfer& transfer, std::string& text) {
  const auto message = decode<Message>(transfer);
  if (message) wire::append_fields(text, *message);
  return message.has_value();
}

struct Entry {
  TypeInfo info;
  TextOf text = nullptr;      ///< of a message or a request
  TextOf response = nullptr;  ///< of a service's response
};

template <class Message, class Response = Message>
consteval Entry entry() {
  constexpr auto kDefinition = Message::kDefinition;
  return {{kDefinition.kind, kDefinition.id, kDefinition.name, kDefinition.signature},
          text_of<Message>,
          text_of<Response>};
}

/// The table: what is here is in use.
constexpr std::array kEntries{entry<NodeStatus>(), entry<Targetted>(), entry<NotifyState>(),
                              entry<GetNodeInfoRequest, GetNodeInfoResponse>()};
constexpr auto kTypes = [] {
  std::array<TypeInfo, kEntries.size()> infos;
  for (std::size_t i = 0; i < infos.size(); ++i) infos.at(i) = kEntries.at(i).info;
  return infos;
}();

template <class Number>
void append_number(std::string& text, Number value) {
  std::array<char, 24> digits{};
  text.append(digits.data(),
              std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
}

void append_hex(std::string& text, std::span<const std::uint8_t> bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  for (const std::uint8_t byte : bytes) {
    text += kDigits[byte >> 4U];
    text += kDigits[byte & 0xFU];
  }
}

void append_name(std::string& text, std::string_view name) {
  text += ' ';
  text += name;
  text += '=';
}

}  // namespace

namespace wire {

void append(std::string& text, std::string_view name, std::int64_t value) {
  append_name(text, name);
  append_number(text, value);
}

void append(std::string& text, std::string_view name, std::uint64_t value) {
  append_name(text, name);
  append_number(text, value);
}

/// As text where all of it is, so that names can be read.
void append(std::string& text, std::string_view name, std::span<const std::uint8_t> bytes) {
  append_name(text, name);
  const bool plain = !bytes.empty() && std::ranges::all_of(bytes, [](std::uint8_t byte) {
    return byte >= 0x20 && byte < 0x7F && byte != '"';
  });
  if (!plain) {
    append_hex(text, bytes);
    return;
  }
  text += '"';
  text.append(bytes.begin(), bytes.end());
  text += '"';
}

}  // namespace wire

std::span<const TypeInfo> types() { return kTypes; }

const TypeInfo* find_type(TypeKind kind, std::uint16_t id) {
  const auto* found = std::ranges::find_if(
      kTypes, [&](const TypeInfo& type) { return type.kind == kind && type.id == id; });
  return found == kTypes.end() ? nullptr : found;
}

std::string to_text(const Transfer& transfer) {
  const Header& header = transfer.header;
  const bool is_service =
      header.kind == TransferKind::request || header.kind == TransferKind::response;
  const TypeKind kind = is_service ? TypeKind::service : TypeKind::message;
  const auto* found = std::ranges::find_if(kEntries, [&](const Entry& candidate) {
    return candidate.info.kind == kind && candidate.info.id == header.type &&
           header.kind != TransferKind::anonymous;
  });
  std::string text;
  if (found != kEntries.end()) {
    text = found->info.name;
    if (header.kind == TransferKind::request) text += " request";
    if (header.kind == TransferKind::response) text += " response";
    const TextOf text_of = header.kind == TransferKind::response ? found->response : found->text;
    if (text_of(transfer, text)) return text;
    text += " not decodable,";
  } else {
    text = is_service ? "service " : "message ";
    append_number(text, header.type);
  }
  text += " bytes ";
  append_hex(text, transfer.payload);
  return text;
}

}  // namespace skein::dronecan
