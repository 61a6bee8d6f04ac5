// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "skein/configuration/ground_config.hpp"

namespace skein::groundstation {

/// Runs the ground station until SIGINT, SIGTERM or `quit`: one thread for network, agent and
/// recording, one that reads the prompt. Call it once, from a process without other threads. Gives
/// the exit code: 0, or process::kExitCannotStart with the reason in the log.
/// `operator_name` is who decides at the prompt.
[[nodiscard]] int run(const configuration::GroundConfig& config, const std::string& operator_name);

/// Where that ground station takes orders from other programs.
[[nodiscard]] std::string control_socket_of(const configuration::GroundConfig& config);

}  // namespace skein::groundstation
