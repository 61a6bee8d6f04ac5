// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/configuration/ground_config.hpp"

namespace skein::groundstation {

/// A line that moves a replay.
struct ReplayOrder {
  enum class Kind { play, pause, speed, seek } kind = Kind::play;
  double value = 0.0;  ///< of speed and seek
};
/// Fails with what is wrong and what would be right.
[[nodiscard]] Result<ReplayOrder> parse_replay_order(const std::string& line);

/// Shows a recording in the console until the process is asked to end, and says on standard output
/// where; lines on standard input move it as those of the page do. It begins to play, or waits at
/// a moment that is given. Gives the exit status.
int replay(const std::filesystem::path& path, const configuration::ConsoleConfig& console,
           double speed, std::optional<Instant> at);

}  // namespace skein::groundstation
