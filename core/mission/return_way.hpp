// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "flight.hpp"
#include "skein/domain/hazard.hpp"
#include "skein/domain/path.hpp"
#include "skein/domain/vehicle.hpp"

namespace skein::mission {

/// Does the vehicle leave its own way home for that one, that the ground station has planned? Only
/// while it is on its way home: one that begins ahead of it on its plan, turns no tighter than its
/// own, keeps its distance from hazards that it knows, leads home, and takes no more than
/// `range_m`.
[[nodiscard]] bool is_way_home(const TimedPath& way, const VehicleSpec& vehicle,
                               const Flight& flight, const std::vector<Hazard>& hazards,
                               double range_m, Instant now);

}  // namespace skein::mission
