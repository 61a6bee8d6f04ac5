// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "skein/base/result.hpp"
#include "skein/recording/recording.hpp"

namespace skein::recording {

/// Reads what one process recorded into a node's folder, in the order in which it was written; what
/// an earlier process left there is not of it. Damaged parts are left out and counted. Fails where
/// there is no file, or it is of another version of Skein.
[[nodiscard]] Result<Recording> read(const std::filesystem::path& folder, VehicleId vehicle);

/// What each process has recorded that had a node's folder, the first of them first; none that
/// cannot be read.
struct SessionRecording {
  Session session;
  Recording recording;
};
[[nodiscard]] std::vector<SessionRecording> read_sessions(const std::filesystem::path& folder,
                                                          VehicleId vehicle);

/// Every node's recording in the folder of a run, ascending by id (the ground station, 0, first).
/// Folders of other names are passed over. Fails where one cannot be read.
[[nodiscard]] Result<std::vector<Recording>> read_run(const std::filesystem::path& folder);

}  // namespace skein::recording
