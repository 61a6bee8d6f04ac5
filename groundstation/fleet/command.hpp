// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/result.hpp"

namespace skein::fleet {

struct CommandOutcome {
  int status = 0;  ///< 128 + the signal's number where one ended it
  std::string output;
  std::string errors;
  std::chrono::system_clock::time_point first_output;  ///< when the first byte came
};

/// Runs a command (found in PATH) with `input` to its end. Its output is in the outcome, or in
/// `into` where that names a file. Fails where it cannot be started, or takes longer than `within`;
/// then it is ended.
[[nodiscard]] Result<CommandOutcome> run_command(const std::vector<std::string>& command,
                                                 std::string_view input,
                                                 std::chrono::milliseconds within,
                                                 const std::filesystem::path& into = {});

}  // namespace skein::fleet
