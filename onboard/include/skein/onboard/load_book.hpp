// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "skein/base/result.hpp"

namespace skein::onboard {

/// How many loads a vehicle has used in a mission: a small file beside its recording, which its
/// next program reads, should this one end in flight. Of a recording, which may be long and has
/// older parts deleted, that would take too long then.
class LoadBook {
 public:
  /// Nothing is known of another mission; without a folder nothing is kept.
  LoadBook(const std::filesystem::path& folder, std::int64_t epoch_unix_ns);

  [[nodiscard]] std::size_t used() const { return used_; }
  /// Fails where it cannot be written; it counts in any case.
  [[nodiscard]] Result<void> use();

 private:
  std::filesystem::path file_;
  std::int64_t epoch_unix_ns_;
  std::size_t used_ = 0;
};

}  // namespace skein::onboard
