// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/result.hpp"

namespace skein::hil {

/// One program that the bench started. It is ended by its process id when the object goes, and by
/// the kernel if the bench itself dies. Not copyable, movable.
class ChildProcess {
 public:
  /// Starts argv[0] (a path) with `environment` added to ours, its output appended to `log`; an
  /// empty `log` gives it our terminal, input and output. `input`, where it is one, is its input;
  /// else there is nothing to read. `file_bytes_max`: as limit_files(), from its start.
  [[nodiscard]] static Result<ChildProcess> start(
      const std::vector<std::string>& argv, const std::filesystem::path& log,
      const std::map<std::string, std::string>& environment, int input = -1,
      std::optional<std::size_t> file_bytes_max = {});
  ~ChildProcess();
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&& other) noexcept;
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  [[nodiscard]] pid_t pid() const { return pid_; }
  /// How it ended ("exit status 2", "signal 9 (Killed)"), or nothing while it runs. Does not block.
  [[nodiscard]] std::optional<std::string> ended();
  /// Did it end by itself with status 0? Precondition: ended().
  [[nodiscard]] bool clean() const { return status_ == 0; }
  void signal(int number) const;
  /// It, and what it has started that is still of its group.
  void signal_group(int number) const;
  /// From now on the kernel refuses what it writes beyond that length of a file (EFBIG), as a full
  /// disk does. Where we may not, nothing changes.
  void limit_files(std::size_t bytes_max) const;
  /// Before all that is not real-time, as a machine of its own would be; without the right to it,
  /// as before.
  void make_realtime() const;
  /// Waits for the end, at most that long; false when it still runs.
  [[nodiscard]] bool wait(std::chrono::milliseconds at_most);

 private:
  explicit ChildProcess(pid_t pid) : pid_{pid} {}
  void end_now();

  pid_t pid_ = -1;
  std::optional<int> status_;
};

/// SIGTERM to all, then SIGKILL to those that have not ended in time. True when all ended cleanly.
bool stop_all(const std::vector<ChildProcess*>& processes, std::chrono::milliseconds at_most);

}  // namespace skein::hil
