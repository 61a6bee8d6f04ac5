// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "skein/base/result.hpp"
#include "skein/recording/recording.hpp"

namespace skein::recording {

/// Writes one node's recording. What is written reaches the system within a second of log time, at
/// flush() and on destruction; so a process that is killed loses a second at most, if it flushes
/// that often. Never throws; a disk error is kept and told by flush(). For one thread, and not a
/// real-time one.
class Writer {
 public:
  struct Options {
    Session session;
    /// Of both files together. At half of it a new file is begun, and the last but one gives way:
    /// the newest half of this, at least, is always there.
    std::uint64_t bytes_max = 1'000'000'000;
    bool compress = true;
  };

  /// Makes `folder` with its parents, and the file in it. That of an earlier process becomes the
  /// older file. Fails with the path and the system's reason.
  [[nodiscard]] static Result<Writer> open(const std::filesystem::path& folder,
                                           const Options& options);
  [[nodiscard]] static Result<Writer> open(const std::filesystem::path& folder);
  ~Writer();
  Writer(Writer&&) noexcept;
  Writer& operator=(Writer&&) noexcept;
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  void write(const TrackPoint& point);
  void write(const mission::MissionEvent& event);
  void write(const PlanRecord& plan);
  void write(const PlaceRecord& place);
  /// As it was sent by this node, or given to its agent, `now`. A message that cannot be sent, for
  /// a value out of its range, is not written.
  void write(const mission::Message& message, VehicleId sender, Instant now);
  void write(const AgentRecord& record);
  void write(const Gap& gap);

  /// To the system. Fails if this or any earlier write failed.
  [[nodiscard]] Result<void> flush();

 private:
  class Impl;
  explicit Writer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace skein::recording
