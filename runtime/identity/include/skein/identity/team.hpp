// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "skein/base/ids.hpp"
#include "skein/base/result.hpp"

namespace skein::identity {

/// A whole mission at once, for a bench on which all nodes are one user's: in `folder`, which is
/// not there yet or empty, `ground` with the authority and a folder for each vehicle
/// (node_folder()). They are fresh at each call; nothing of it outlasts a loss of power.
[[nodiscard]] Result<void> make_team(const std::filesystem::path& folder,
                                     std::span<const VehicleId> vehicles, std::int64_t now_unix_s);
/// The operator of such a mission, and where (in the ground station's folder) his password lies.
inline constexpr const char* kBenchOperator = "rehearsal";
inline constexpr const char* kBenchPasswordFile = "rehearsal.password";
[[nodiscard]] std::filesystem::path node_folder(const std::filesystem::path& folder,
                                                VehicleId node);

}  // namespace skein::identity
