// SPDX-License-Identifier: Apache-2.0
#include "foxglove.hpp"

#include "skein/codec/json_text.hpp"

namespace skein::console {
namespace {

using codec::Json;
using codec::ParsedJson;

constexpr char kMessageData = 0x01;

void append_little_endian(std::string& bytes, std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i) bytes.push_back(static_cast<char>((value >> (8 * i)) & 0xFFU));
}

std::optional<std::uint32_t> number(const ParsedJson& json) {
  if (!json.is_number_unsigned() || json.get<std::uint64_t>() > UINT32_MAX) return std::nullopt;
  return json.get<std::uint32_t>();
}

std::optional<std::uint32_t> number(const ParsedJson& json, const char* key) {
  const auto found = json.find(key);
  return found == json.end() ? std::nullopt : number(*found);
}

}  // namespace

std::string FoxgloveSession::server_info(const std::string& name, const std::string& run) {
  return codec::json_text({{"op", "serverInfo"},
                           {"name", name},
                           {"capabilities", Json::array()},
                           {"supportedEncodings", {"cdr"}},
                           {"metadata", Json::object()},
                           {"sessionId", run}});
}

std::string FoxgloveSession::advertise(std::span<const LiveChannel> channels) {
  Json json{{"op", "advertise"}, {"channels", Json::array()}};
  for (const LiveChannel& channel : channels) {
    json["channels"].push_back({{"id", channel.id},
                                {"topic", channel.topic},
                                {"encoding", "cdr"},
                                {"schemaName", channel.schema_name},
                                {"schema", channel.schema},
                                {"schemaEncoding", "ros2msg"}});
  }
  return codec::json_text(json);
}

bool FoxgloveSession::on_text(const std::string& text) {
  const ParsedJson json = codec::parse_json(text);
  if (!json.is_object() || !json.contains("op") || !json["op"].is_string()) return false;
  if (json["op"] == "subscribe") {
    const auto asked = json.find("subscriptions");
    if (asked == json.end() || !asked->is_array()) return false;
    for (const ParsedJson& one : *asked) {
      if (!one.is_object()) return false;
      const auto id = number(one, "id");
      const auto channel = number(one, "channelId");
      if (!id || !channel || subscriptions_.size() >= kSubscriptionsMax) return false;
      subscriptions_[*channel] = *id;
    }
  } else if (json["op"] == "unsubscribe") {
    const auto ids = json.find("subscriptionIds");
    if (ids == json.end() || !ids->is_array()) return false;
    for (const ParsedJson& one : *ids) {
      const auto id = number(one);
      if (!id) return false;
      std::erase_if(subscriptions_, [&](const auto& entry) { return entry.second == *id; });
    }
  }
  return true;
}

std::optional<std::string> FoxgloveSession::record(std::uint32_t channel, std::uint64_t time_ns,
                                                   std::span<const std::uint8_t> bytes) const {
  const auto found = subscriptions_.find(channel);
  if (found == subscriptions_.end()) return std::nullopt;
  std::string message;
  message.reserve(1 + 4 + 8 + bytes.size());
  message.push_back(kMessageData);
  append_little_endian(message, found->second, 4);
  append_little_endian(message, time_ns, 8);
  for (const std::uint8_t byte : bytes) message.push_back(static_cast<char>(byte));
  return message;
}

}  // namespace skein::console
