// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "skein/base/time.hpp"
#include "skein/process/mission_clock.hpp"

namespace skein::process {

/// What the program returns to the shell.
inline constexpr int kExitBadInput = 2;     ///< arguments or configuration
inline constexpr int kExitCannotStart = 3;  ///< network, recordings
inline constexpr int kExitBrokenInvariant = 70;

/// Sends spdlog's default logger to stdout, one line an event: mission time, level, text; to the
/// journal, where stdout is its stream. `clock`
/// must outlive every log line. Broken invariants from now on are logged and end the process with
/// kExitBrokenInvariant at once: on a vehicle the flight controller's failsafe takes over.
void start_log(const MissionClock& clock);

/// "12.345 s", for log lines.
[[nodiscard]] std::string text_of(Instant t);

}  // namespace skein::process
