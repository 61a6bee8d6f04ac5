// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

/// Other processes, by /proc.
namespace skein::isolation {

/// Those that are not dead.
[[nodiscard]] std::vector<pid_t> children_of(pid_t parent);
/// /proc/PID/status; empty of a process that is gone.
[[nodiscard]] std::map<std::string, std::string> status_of(pid_t process);
[[nodiscard]] std::uint64_t resident_bytes(pid_t process);

}  // namespace skein::isolation
