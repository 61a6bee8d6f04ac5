// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "skein/base/result.hpp"
#include "skein/shards/shard.hpp"

namespace skein::shards {

/// What the runs in a folder are, as far as its scenario and its experiment do not say it.
struct Series {
  std::string kind;     ///< sweep, sites, formation
  std::string program;  ///< its version(): another one may fly otherwise
  std::string file;     ///< the scenario or experiment, as the command line named it
  std::string faults = "none";
  std::string plan;  ///< of tasks, flown from the begin, as --routes named it; empty: none
  std::uint64_t first_seed = 1;
  std::size_t runs = 1;  ///< of a sweep: of each cell
  Shard shard;
  double separation_m = 0.0;  ///< that a formation wants
};

/// What its runs are flown with besides, for a command line: " --faults mixed --routes plan.yaml".
[[nodiscard]] std::string options_of(const Series& series);

/// Whether two are of one experiment; names of files, runs and shard may differ. Fails with what
/// differs; `here` and `there` are where they were read.
[[nodiscard]] Result<void> same_series(const Series& series, const std::string& here,
                                       const Series& other, const std::string& there);

/// A folder whose runs one program at a time adds to, as far as the file system can tell: movable.
class RunFolder {
 public:
  /// Makes the folder, or takes it up where its series is the same. Fails where it is not, where
  /// another program is at work in it, or where nothing can be written.
  [[nodiscard]] static Result<RunFolder> open(const std::filesystem::path& folder,
                                              const Series& series);
  RunFolder(RunFolder&& other) noexcept;
  RunFolder& operator=(RunFolder&& other) noexcept;
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;
  ~RunFolder();

 private:
  explicit RunFolder(int lock) : lock_{lock} {}
  int lock_ = -1;
};

/// Writes FOLDER/series.txt: last of what says of what the folder is, so that what is refused for
/// its scenario has changed nothing.
[[nodiscard]] Result<void> keep_series(const std::filesystem::path& folder, const Series& series);
/// FOLDER/series.txt. Fails where there is none.
[[nodiscard]] Result<Series> read_series(const std::filesystem::path& folder);

/// Empty where the file cannot be read.
[[nodiscard]] std::string text_of(const std::filesystem::path& file);
/// Writes the whole text in place of the file, at once or not at all.
[[nodiscard]] Result<void> put_text(const std::filesystem::path& file, const std::string& text);
/// Writes the text where there is no file yet; fails where the file has another text. `what` is it
/// of which it is told: "scenario".
[[nodiscard]] Result<void> keep_text(const std::filesystem::path& file, const std::string& text,
                                     std::string_view what);
/// For a folder whose `what` is not what it was.
[[nodiscard]] Error has_changed(const std::filesystem::path& file, std::string_view what);

}  // namespace skein::shards
