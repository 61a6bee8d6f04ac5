// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>

#include "skein/base/result.hpp"

namespace skein::identity {

/// Must a file outlast a loss of power? Not where it is for one run of the bench.
enum class Durable : std::uint8_t { no, yes };

/// While it lives, no other process has the folder; a process that dies gives it back.
class FolderLock {
 public:
  /// A command needs it for some milliseconds.
  static constexpr std::chrono::milliseconds kWithin{5000};
  /// Fails where another has it for so long.
  [[nodiscard]] static Result<FolderLock> take(const std::filesystem::path& folder,
                                               std::chrono::milliseconds within = kWithin);
  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept;
  FolderLock& operator=(FolderLock&& other) noexcept;
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  explicit FolderLock(int descriptor) : descriptor_{descriptor} {}
  int descriptor_ = -1;
};

}  // namespace skein::identity
