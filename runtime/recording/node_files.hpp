// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <vector>

#include "channel_book.hpp"
#include "skein/mcap/reader.hpp"
#include "skein/recording/recording.hpp"

namespace skein::recording {

/// A file of a recording, with what its channels carry.
struct NodeFile {
  mcap::Reader reader;
  std::map<std::uint16_t, KnownChannel> channels;
  std::vector<Session> sessions;  ///< at least one
};

/// Fails where the file is of another version of Skein, or no recording.
[[nodiscard]] Result<NodeFile> known_file(mcap::Reader reader);
[[nodiscard]] Result<NodeFile> open_file(const std::filesystem::path& path);

/// The files of the newest process in a node's folder, the older first.
[[nodiscard]] Result<std::vector<NodeFile>> open_node(const std::filesystem::path& folder);
/// Those of all processes of that node in the mission with that epoch (without one: in any); none
/// that cannot be read.
[[nodiscard]] std::vector<NodeFile> open_mission(const std::filesystem::path& folder,
                                                 VehicleId node,
                                                 std::optional<std::int64_t> epoch_unix_ns);

/// The folders in that of a run that have a recording, by name.
[[nodiscard]] Result<std::vector<std::filesystem::path>> node_folders(
    const std::filesystem::path& run);

}  // namespace skein::recording
