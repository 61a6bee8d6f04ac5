// SPDX-License-Identifier: Apache-2.0
#include "skein/codec/codec.hpp"

#include <utility>

#include "skein/idl/autopilot_fields.hpp"
#include "skein/idl/coalition_fields.hpp"
#include "skein/idl/domain_fields.hpp"
#include "skein/idl/events_fields.hpp"
#include "skein/idl/formation_fields.hpp"
#include "skein/idl/mission_fields.hpp"

namespace skein::codec {
namespace {

/// What later releases may append to a type of one version, in all.
constexpr std::size_t kRoomToGrow = 512;

}  // namespace

std::optional<Bytes> encode(const mission::Message& message) {
  return std::visit([](const auto& m) { return to_cdr(m); }, message);
}

std::variant<mission::Message, Refusal> decode(Topic topic, std::span<const std::uint8_t> bytes) {
  if (bytes.size() > encoded_size_max(topic)) return Refusal{Fault::malformed};
  std::variant<mission::Message, Refusal> result;
  auto& message = std::get<mission::Message>(result);
  CdrReader reader{bytes};
  with_alternative<mission::Message>(static_cast<std::size_t>(topic), [&]<class T>() {
    reader.whole(message.template emplace<T>());
  });
  if (reader.refusal()) result = *reader.refusal();
  return result;
}

std::size_t encoded_size_max(Topic topic) {
  return (info(topic).size_max + kRoomToGrow + 3) / 4 * 4;
}

std::string text_of(const Refusal& refusal, Topic topic) {
  return "its " + std::string{info(topic).type} + " is of version " +
         std::to_string(refusal.version) + ", ours of version " +
         std::to_string(info(topic).version);
}

std::string wire_versions() {
  std::string text;
  for (const TopicInfo& topic : kTopics) {
    text.append(topic.type).append(" ").append(std::to_string(topic.version)).append("; ");
  }
  return text;
}

}  // namespace skein::codec
