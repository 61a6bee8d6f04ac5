// SPDX-License-Identifier: Apache-2.0
#include "channel_book.hpp"

#include <charconv>

namespace skein::recording {
namespace {

template <class Number>
bool parse_number(const std::string& text, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

std::string two_digits(VehicleId vehicle) {
  const std::string number = std::to_string(vehicle.value);
  return (number.size() < 2 ? "0" : "") + number;
}

}  // namespace

std::string folder_name(VehicleId vehicle) {
  return vehicle == kGroundStation ? "ground" : "vehicle-" + two_digits(vehicle);
}

std::string topic_of(VehicleId sender, const RecordKind& kind) {
  return (sender == kGroundStation ? "/ground/" : "/vehicle_" + two_digits(sender) + "/") +
         kind.name;
}

mcap::Metadata metadata_of(const Session& session) {
  return {kSessionName,
          {{"node", std::to_string(session.node.value)},
           {"instance", std::to_string(session.instance.value)},
           {"program", session.program},
           {"version", session.version},
           {"epoch_unix_ns", std::to_string(session.epoch_unix_ns)},
           {"configuration", session.configuration}}};
}

std::optional<Session> session_of(const mcap::Metadata& metadata) {
  if (metadata.name != kSessionName) return std::nullopt;
  const auto entry = [&metadata](const char* key) {
    const auto found = metadata.entries.find(key);
    return found == metadata.entries.end() ? std::string{} : found->second;
  };
  Session session;
  if (!parse_number(entry("node"), session.node.value) ||
      !parse_number(entry("instance"), session.instance.value) ||
      !parse_number(entry("epoch_unix_ns"), session.epoch_unix_ns)) {
    return std::nullopt;
  }
  session.program = entry("program");
  session.version = entry("version");
  session.configuration = entry("configuration");
  return session;
}

std::uint64_t log_time(Instant t, std::int64_t epoch_unix_ns) {
  return static_cast<std::uint64_t>(epoch_unix_ns) +
         static_cast<std::uint64_t>(t.time_since_epoch().count());
}

Instant instant_of(std::uint64_t log_time_ns, std::int64_t epoch_unix_ns) {
  const std::uint64_t since = log_time_ns - static_cast<std::uint64_t>(epoch_unix_ns);
  return Instant{Duration{static_cast<std::int64_t>(since)}};
}

std::uint16_t ChannelBook::channel(mcap::Writer& file, VehicleId sender, const RecordKind& kind) {
  const std::pair key{sender, &kind};
  if (const auto known = channels_.find(key); known != channels_.end()) return known->second;
  const schemas::Schema& schema = *kind.schema;
  auto known_schema = schemas_.find(schema.name);
  if (known_schema == schemas_.end()) {
    const auto number =
        file.add(mcap::Schema{std::string{schema.name}, kSchemaEncoding, std::string{schema.text}});
    known_schema = schemas_.emplace(schema.name, number).first;
  }
  const auto number = file.add(mcap::Channel{known_schema->second,
                                             topic_of(sender, kind),
                                             kMessageEncoding,
                                             {{"sender", std::to_string(sender.value)}}});
  channels_.emplace(key, number);
  return number;
}

Result<std::optional<KnownChannel>> known_channel(const mcap::Reader& file,
                                                  const mcap::Channel& channel) {
  const std::optional<KnownChannel> none;
  const auto schema = file.schemas().find(channel.schema);
  const auto sender = channel.metadata.find("sender");
  if (schema == file.schemas().end() || sender == channel.metadata.end()) return none;
  KnownChannel known;
  known.kind = kind_named(schema->second.name);
  if (known.kind == nullptr || !parse_number(sender->second, known.sender.value)) return none;
  if (schema->second.text != known.kind->schema->text ||
      schema->second.encoding != kSchemaEncoding || channel.encoding != kMessageEncoding) {
    return Error{file.name() + ": " + channel.topic + " is of another version of Skein (" +
                 file.library() + "); read it with that one"};
  }
  return std::optional{known};
}

}  // namespace skein::recording
