// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>

#include "skein/mission/ground_node.hpp"

namespace skein::groundstation {

using Recalled = std::function<void(const mission::Message& message, VehicleId sender, Instant at)>;

/// Has the node recall what earlier processes of this ground station recorded in the folder of the
/// mission with that epoch; `node` is as it was made. How many messages those are: 0 where there is
/// no such recording, or it cannot be read. `also` is told of each.
std::size_t recall(const std::filesystem::path& folder, std::int64_t epoch_unix_ns,
                   mission::GroundNode& node, const Recalled& also = {});

}  // namespace skein::groundstation
