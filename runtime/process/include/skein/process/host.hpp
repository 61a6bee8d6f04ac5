// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>

namespace skein::process {

/// What the kernel knows of this machine's clock; whoever synchronises it (chrony, timesyncd, a
/// GNSS receiver) tells it.
struct ClockState {
  bool synchronised = false;
  std::chrono::microseconds error_max{
      0};  ///< as far as it may be off; counts up while nobody tells
};
/// None where the kernel does not say.
[[nodiscard]] std::optional<ClockState> clock_state();

/// What the file system of that folder has left for this process; none where it does not say.
[[nodiscard]] std::optional<std::uint64_t> free_bytes(const std::filesystem::path& folder);
/// Of the files in that folder, without those of folders in it; 0 where there is none.
[[nodiscard]] std::uint64_t bytes_in(const std::filesystem::path& folder);

}  // namespace skein::process
