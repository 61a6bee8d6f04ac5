// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/base/geometry.hpp"
#include "skein/base/time.hpp"
#include "skein/domain/path.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/planning/path_follower.hpp"

namespace skein::planning {

/// How a vehicle that follows its plan by speed alone will stand to it.
struct ArrivalForecast {
  double along_m = 0.0;   ///< at the end; positive when ahead of time
  double astray_m = 0.0;  ///< the most that it is ahead or behind on the way
};

/// The wind, from the difference of velocity over the ground and through the air.
[[nodiscard]] Vec2 wind_of(const VehicleState& state);

/// From `now`, when the vehicle is `along_m` ahead of its plan, until `until`, in a steady wind:
/// the follower asks for the speed that makes up for it, and gets what the vehicle's limits and the
/// wind leave of that, the nose turned into the wind as far as it takes. What is not met so is met
/// by another path only. Pure; allocates nothing; bounded time.
[[nodiscard]] ArrivalForecast forecast_arrival(const PathFollowerParams& params,
                                               const VehicleSpec& vehicle, const TimedPath& plan,
                                               double along_m, const Vec2& wind_mps, Instant now,
                                               Instant until);

}  // namespace skein::planning
