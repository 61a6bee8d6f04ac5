// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "skein/base/ids.hpp"
#include "skein/base/result.hpp"
#include "skein/configuration/deployment.hpp"

namespace skein::hil {

/// Keys of a mission of its own for each run, so that it is flown sealed as in the field; below the
/// run's folder, while it lasts. `nodes`: the ground station first, then all others.
[[nodiscard]] Result<void> make_run_keys(const std::filesystem::path& run_folder,
                                         const std::vector<VehicleId>& nodes);
void use_run_keys(configuration::Deployment& deployment, const std::filesystem::path& run_folder,
                  const std::vector<VehicleId>& nodes);
void remove_run_keys(const std::filesystem::path& run_folder);

}  // namespace skein::hil
