// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
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
  [[nodiscard]] std::uint16_t channel(mcap::Writer& file, VehicleId sender, const RecordKind& kind);

 private:
  std::map<std::string_view, std::uint16_t> schemas_;
  std::map<std::pair<VehicleId, const RecordKind*>, std::uint16_t> channels_;
};

/// What a channel of a file that is being read carries.
struct KnownChannel {
  const RecordKind* kind = nullptr;
  VehicleId sender;
};
/// None where it is no channel of a recording; fails where its schema is not ours.
[[nodiscard]] Result<std::optional<KnownChannel>> known_channel(const mcap::Reader& file,
                                                                const mcap::Channel& channel);

}  // namespace skein::recording
