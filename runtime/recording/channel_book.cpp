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

/// Of a type, as its schema begins; "none" where it says none.
std::string version_in(std::string_view schema) {
  constexpr std::string_view kVersion = "uint16 VERSION=";
  if (!schema.starts_with(kVersion)) return "none";
  return std::string{schema.substr(kVersion.size(), schema.find('\n') - kVersion.size())};
}

std::string two_digits(VehicleId vehicle) {
  const std::string number = std::to_string(vehicle.value);
  return (number.size() < 2 ? "0" : "") + number;
}

}  // namespace

std::string older_file_name(int age) { return "recording." + std::to_string(age) + ".mcap"; }

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

std::uint16_t ChannelBook::channel(mcap::Writer& file, VehicleId sender, const RecordKind& kind,
                                   std::string_view schema) {
  const std::tuple seen{sender, &kind, schema.data()};
  if (const auto known = known_.find(seen); known != known_.end()) return known->second;
  const std::string_view name = kind.schema->name;
  auto known_schema = schemas_.find({name, std::string{schema}});
  if (known_schema == schemas_.end()) {
    const auto number =
        file.add(mcap::Schema{std::string{name}, kSchemaEncoding, std::string{schema}});
    known_schema = schemas_.emplace(std::pair{name, std::string{schema}}, number).first;
  }
  const std::tuple key{sender, &kind, known_schema->second};
  auto known = channels_.find(key);
  if (known == channels_.end()) {
    const auto number = file.add(mcap::Channel{known_schema->second,
                                               topic_of(sender, kind),
                                               kMessageEncoding,
                                               {{"sender", std::to_string(sender.value)}}});
    known = channels_.emplace(key, number).first;
  }
  known_.emplace(seen, known->second);
  return known->second;
}

Result<std::optional<KnownChannel>> known_channel(const mcap::Reader& file,
                                                  const mcap::Channel& channel) {
  const std::optional<KnownChannel> none;
  const auto schema = file.schemas().find(channel.schema);
  const auto sender = channel.metadata.find("sender");
  if (schema == file.schemas().end() || sender == channel.metadata.end()) return none;
  KnownChannel known;
  // "/vehicle_07/coalition/bid"
  const std::string_view topic = channel.topic;
  const auto words = topic.find('/', 1);
  if (words != std::string_view::npos) known.kind = kind_named(topic.substr(words + 1));
  if (known.kind == nullptr || schema->second.name != known.kind->schema->name ||
      !parse_number(sender->second, known.sender.value))
    return none;
  const std::string theirs = version_in(schema->second.text);
  const std::string ours = std::to_string(known.kind->schema->version);
  if (theirs != ours || schema->second.encoding != kSchemaEncoding ||
      channel.encoding != kMessageEncoding) {
    return Error{file.name() + ": " + channel.topic + " is of version " + theirs +
                 ", ours of version " + ours + "; read it with the Skein that wrote it (" +
                 file.library() + ")"};
  }
  known.schema = schema->second.text;
  return std::optional{known};
}

}  // namespace skein::recording
