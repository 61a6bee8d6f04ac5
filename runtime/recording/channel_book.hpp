// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "records.hpp"
#include "skein/mcap/reader.hpp"
#include "skein/mcap/writer.hpp"
#include "skein/recording/recording.hpp"

/// How a recording uses MCAP: a channel for each sender and kind of record, the sender's number in
/// the channel's metadata, and a metadata record for the session.
namespace skein::recording {

inline constexpr const char* kProfile = "ros2";
inline constexpr const char* kMessageEncoding = "cdr";
inline constexpr const char* kSchemaEncoding = "ros2msg";
inline constexpr const char* kSessionName = "skein";

/// "/vehicle_07/telemetry", "/ground/command"
[[nodiscard]] std::string topic_of(VehicleId sender, const RecordKind& kind);

[[nodiscard]] mcap::Metadata metadata_of(const Session& session);
/// None where it is not that of a session.
[[nodiscard]] std::optional<Session> session_of(const mcap::Metadata& metadata);

/// Instants as log times, and back: with a session's epoch, modulo 2^64 ns.
[[nodiscard]] std::uint64_t log_time(Instant t, std::int64_t epoch_unix_ns);
[[nodiscard]] Instant instant_of(std::uint64_t log_time_ns, std::int64_t epoch_unix_ns);

/// The channels of a file that is being written, each added with its first record.
class ChannelBook {
 public:
  [[nodiscard]] std::uint16_t channel(mcap::Writer& file, VehicleId sender,
                                      const RecordKind& kind) {
    return channel(file, sender, kind, kind.schema->text);
  }
  /// Where the bytes are of an older or later release, whose schema has other fields at its end.
  [[nodiscard]] std::uint16_t channel(mcap::Writer& file, VehicleId sender, const RecordKind& kind,
                                      std::string_view schema);

 private:
  std::map<std::pair<std::string_view, std::string>, std::uint16_t> schemas_;
  std::map<std::tuple<VehicleId, const RecordKind*, std::uint16_t>, std::uint16_t> channels_;
  /// By where the schema's text stands, which spares comparing it.
  std::map<std::tuple<VehicleId, const RecordKind*, const char*>, std::uint16_t> known_;
};

/// What a channel of a file that is being read carries.
struct KnownChannel {
  const RecordKind* kind = nullptr;
  VehicleId sender;
  std::string schema;  ///< as the file has it
};
/// None where it is no channel of a recording; fails where its schema is not ours.
[[nodiscard]] Result<std::optional<KnownChannel>> known_channel(const mcap::Reader& file,
                                                                const mcap::Channel& channel);

}  // namespace skein::recording
