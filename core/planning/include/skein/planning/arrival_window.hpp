// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/base/time.hpp"
#include "skein/domain/path.hpp"
#include "skein/domain/vehicle.hpp"

namespace skein::planning {

/// When a vehicle can be at a point of its path.
struct ArrivalWindow {
  Instant earliest{};  ///< at its greatest airspeed all the way
  Instant latest{};    ///< at its least
};

/// For the point `distance_m` along the plan, from where the vehicle is now, in the wind of this
/// moment: velocity over the ground less velocity through the air. Both `now` when it is past that
/// point. A time outside the window is met by another path only. Pure; allocates nothing; bounded
/// time.
[[nodiscard]] ArrivalWindow arrival_window(const VehicleSpec& vehicle, const TimedPath& plan,
                                           const VehicleState& state, double distance_m,
                                           Instant now);

}  // namespace skein::planning
