// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/configuration/differences.hpp"
#include "skein/fleet/fleet.hpp"

namespace skein::fleet {

/// How `script` (of a POSIX shell) is run on the host: by ssh where it names one, otherwise here;
/// after the words of `run`. Every command on a host goes this way.
[[nodiscard]] std::vector<std::string> command_on(const configuration::Host& host,
                                                  const std::string& script);

/// Puts the program's configuration and its other files in place, each complete or not at all, once
/// the host's own program has found the configuration good. Fails where the program runs: a vehicle
/// that flies is not given another configuration, unless `force`.
[[nodiscard]] Result<void> push(const Program& program, bool force);

/// Starts the program; one that runs already is left alone. Fails where it does not stay.
[[nodiscard]] Result<void> start(const Program& program);
/// Asks the program to end, and waits until it has. One that does not run is left alone. Fails for
/// a unit of systemd whose vehicle says that it flies, unless `force`.
[[nodiscard]] Result<void> stop(const Program& program, bool force);

/// What a host says of its program.
struct Status {
  bool reachable = false;
  std::string trouble;  ///< why it is not reachable
  bool running = false;
  std::string state;    ///< running, stopped; of systemd: active, inactive, failed, ...
  std::string version;  ///< as the program says it; empty: it is not there
  bool configured = false;
  std::string unreadable;  ///< why its configuration cannot be read; empty: it can
  /// First: there; second: by the fleet's file.
  std::vector<configuration::Difference> drift;
  bool outdated = false;        ///< it runs with an older configuration than the one that is there
  double clock_offset_s = 0.0;  ///< of its clock to ours, less the time that its answer took

  [[nodiscard]] bool as_the_file() const {
    return reachable && configured && unreadable.empty() && drift.empty() && !outdated;
  }
};
[[nodiscard]] Status status(const Program& program);

/// Fetches a folder of the host into `folder`, which is made.
[[nodiscard]] Result<void> collect(const configuration::Host& host, const std::string& from,
                                   const std::filesystem::path& folder);
/// Removes a folder of the host that was collected.
[[nodiscard]] Result<void> remove(const configuration::Host& host, const std::string& folder);

}  // namespace skein::fleet
