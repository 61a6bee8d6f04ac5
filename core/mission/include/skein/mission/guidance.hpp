// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <variant>

#include "skein/base/time.hpp"
#include "skein/domain/motion_track.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/mission/messages.hpp"
#include "skein/planning/path_follower.hpp"

namespace skein::mission {

/// What control follows: a path, of a vehicle that is flown by its heading and speed, or a point
/// that moves, of one that is flown by its position. Each ends in a hold. A newer one replaces an
/// older one of either kind. Trivially copyable.
using Guidance = std::variant<FlightPlan, MotionTrack>;

/// Without a state for so long the flight controller is silent: nothing is asked of it.
inline constexpr Duration kFlightControllerSilence = std::chrono::milliseconds{500};

/// What is asked of the flight controller at `now`, to follow it. Allocates nothing and takes
/// bounded time.
[[nodiscard]] Demand follow(const Guidance& guidance, const planning::PathFollowerParams& params,
                            const VehicleSpec& vehicle, const VehicleState& state, Instant now);

/// How far from it a vehicle is at `now`.
struct Deviation {
  std::uint32_t number = 0;    ///< of the flight plan, or of what the track is a part of
  double along_error_m = 0.0;  ///< of a path: positive when ahead of time
  double cross_error_m = 0.0;  ///< positive when left of the path; of a track: the distance
};
[[nodiscard]] Deviation deviation(const Guidance& guidance, const VehicleState& state, Instant now);

}  // namespace skein::mission
