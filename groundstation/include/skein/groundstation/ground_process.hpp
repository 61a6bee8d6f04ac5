// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "skein/configuration/ground_config.hpp"

namespace skein::groundstation {

/// Who decides at the prompt and the command line.
struct Login {
  std::string name;
  std::optional<std::string> password;  ///< unlocks his key (OperatorKeys)
};

/// Runs the ground station until SIGINT, SIGTERM or `quit`: one thread for network, agent and
/// recording, one that reads the prompt. Call it once, from a process without other threads. Gives
/// the exit code: 0, or process::kExitCannotStart with the reason in the log.
[[nodiscard]] int run(const configuration::GroundConfig& config, const Login& login);

/// Where that ground station takes orders from other programs.
[[nodiscard]] std::string control_socket_of(const configuration::GroundConfig& config);

}  // namespace skein::groundstation
