// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "skein/hil/emulator_config.hpp"

namespace skein::hil {

/// A line for EmulatedFlightController::interfere, so long after the start.
struct TimedLine {
  Duration after{};
  std::string line;
};

/// What skein-fc was started with.
struct FcArguments {
  std::string bus = "mcast:0";
  std::optional<std::int64_t> hold_until_unix_ns;
  std::vector<TimedLine> script;
  std::optional<std::uint16_t> truth_port;
  EmulatorConfig config;  ///< hold_until and unix_us are the caller's to set
};

/// The arguments, or the status to end with: all has been said.
[[nodiscard]] std::variant<FcArguments, int> parse_arguments(int argc, char** argv);

}  // namespace skein::hil
