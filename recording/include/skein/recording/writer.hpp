// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "skein/base/result.hpp"
#include "skein/recording/recording.hpp"

namespace skein::recording {

/// Writes one node's recording. Buffered: what is written reaches the disk when a buffer fills, at
/// flush() and on destruction. Never throws; a disk error is kept and told by flush().
/// For one thread, and not a real-time one.
class Writer {
 public:
  /// Makes `folder` (with its parents) and the three files with their headers; files of an earlier
  /// run are replaced. Fails with the path and the system's reason.
  [[nodiscard]] static Result<Writer> open(const std::filesystem::path& folder);

  void write(const TrackPoint& point);
  void write(const mission::MissionEvent& event);
  void write(const PlanRecord& plan);
  void write(const PlaceRecord& place);

  /// To the disk. Fails if this or any earlier write failed.
  [[nodiscard]] Result<void> flush();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  struct File {
    std::string path;
    std::unique_ptr<std::FILE, Close> handle;
    int error = 0;  ///< errno of the first failure

    void put(const std::string& line);
  };

  Writer() = default;
  [[nodiscard]] static Result<File> open_file(const std::filesystem::path& path,
                                              const std::string& header);

  File track_;
  File events_;
  File plans_;
  File places_;  ///< begun with the first
  std::filesystem::path folder_;
  std::string line_;
};

}  // namespace skein::recording
