// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/recording/recording.hpp"

namespace skein::recording {

/// Whatever is in a file. An event is what a node noted of itself, or the ground station of others;
/// as a message it is what was sent.
using Content = std::variant<mission::Message, TrackPoint, mission::MissionEvent, PlanRecord,
                             PlaceRecord, Gap, AgentStart, StateGiven, PlanningGiven, TimeoutGiven,
                             NoticeGiven, ConditionGiven, NamesakeHeard, PlanMade, TrackMade>;

struct Entry {
  Instant time{};          ///< sent, given or noted
  VehicleId sender;        ///< of a message; of anything else, whose it is
  VehicleId node;          ///< who recorded it
  std::string_view topic;  ///< "/vehicle_07/telemetry"; good as long as the log
  Content content;
};

/// The record's bytes as they stand in files. Empty where a value is out of its range.
[[nodiscard]] std::vector<std::uint8_t> bytes_of(const Content& content);
/// All of it for people, in one line of JSON.
[[nodiscard]] std::string text_of(const Content& content);
/// The name of its type in tools, such as skein::wire::Telemetry.
[[nodiscard]] std::string type_of(const Content& content);

/// What a file has of one topic.
struct TopicCount {
  std::string topic;
  VehicleId sender;
  std::uint64_t records = 0;
};

/// Reads recordings, for replay and for looking at them: one file, the files of a node's folder, or
/// those of a whole run. Of a run it gives each record once, as its sender recorded it. Records
/// that cannot be read are passed over and counted. Any bytes are safe. For one thread.
class Log {
 public:
  /// `path` is a file, a node's folder, or a run's folder (whose merged file is used if it has
  /// one). Fails where nothing is there that can be read, or it is of another version of Skein.
  [[nodiscard]] static Result<Log> open(const std::filesystem::path& path);
  /// What all processes of that node have recorded in its folder in the mission with that epoch.
  [[nodiscard]] static Result<Log> of_mission(const std::filesystem::path& folder, VehicleId node,
                                              std::int64_t epoch_unix_ns);
  /// One file's bytes, which outlive it.
  [[nodiscard]] static Result<Log> of_bytes(std::span<const std::uint8_t> bytes,
                                            const std::string& name);
  ~Log();
  Log(Log&&) noexcept;
  Log& operator=(Log&&) noexcept;
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;

  /// The processes that recorded, each once; mission time is by the epoch of the first.
  [[nodiscard]] const std::vector<Session>& sessions() const;
  /// Of the first and the last record, as the files say it; both 0 where there is none.
  [[nodiscard]] Instant begin() const;
  [[nodiscard]] Instant end() const;
  /// Parts of files and records that could not be read so far.
  [[nodiscard]] std::size_t damaged() const;
  /// Every file was closed by its process.
  [[nodiscard]] bool is_complete() const;
  /// Reads everything. By topic.
  [[nodiscard]] std::vector<TopicCount> topics();

  /// next() goes on with the first record at or after that time.
  void seek(Instant time);
  /// By time; none at the end.
  [[nodiscard]] std::optional<Entry> next();
  /// Everything in the order in which it was written, file after file; false from `take` ends it.
  void for_each_written(const std::function<bool(Entry)>& take);

 private:
  class Impl;
  explicit Log(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace skein::recording
