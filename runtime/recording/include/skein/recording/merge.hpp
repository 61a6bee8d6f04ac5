// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "skein/base/result.hpp"

namespace skein::recording {

/// Makes kRunFileName in the folder of a run, of the files in the folders of its nodes: each record
/// once, as its sender recorded it, by time, under the sender's topics. Gives the number of
/// records. Fails where there is nothing to merge, or the file cannot be written.
[[nodiscard]] Result<std::uint64_t> merge_run(const std::filesystem::path& folder);

}  // namespace skein::recording
