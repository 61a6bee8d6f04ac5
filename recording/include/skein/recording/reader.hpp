// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/recording/recording.hpp"

namespace skein::recording {

/// Reads one node's folder, in the order in which it was written. A last line that was cut off is
/// left out and counted; any other damage fails with "file:line: what is wrong".
[[nodiscard]] Result<Recording> read(const std::filesystem::path& folder, VehicleId vehicle);

/// Every node's recording in the folder of a run, ascending by id (the ground station, 0, first).
/// Folders of other names are passed over. Fails where a node's folder is damaged.
[[nodiscard]] Result<std::vector<Recording>> read_run(const std::filesystem::path& folder);

}  // namespace skein::recording
