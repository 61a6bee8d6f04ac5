// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include "skein/base/time.hpp"
#include "skein/domain/motion_track.hpp"
#include "skein/domain/vehicle.hpp"
#include "skein/mission/messages.hpp"
#include "skein/planning/path_follower.hpp"

namespace skein::mission {

/// What control follows: a path at a speed, at the vehicle's height or what the plan says off it,
/// or a point that moves, of one that is flown by its position. Each ends in a hold. A newer one
/// replaces an older one of either kind. Trivially copyable.
using Guidance = std::variant<FlightPlan, MotionTrack>;

/// A plan's height changes at that rate, of every vehicle.
inline constexpr double kHeightRate_mps = 2.0;
/// From the vehicle's layer, at that time.
[[nodiscard]] double height_offset_m(const FlightPlan& plan, Instant at);

/// Without a state for so long the flight controller is silent: nothing is asked of it.
inline constexpr Duration kFlightControllerSilence = std::chrono::milliseconds{500};

/// Guidance that is followed for many control periods: what stays the same of it is worked out
/// once. Trivially copyable.
struct HeldGuidance {
  explicit HeldGuidance(const Guidance& held);

  Guidance guidance;
  std::optional<planning::PieceStarts> starts;  ///< of a flight plan
};

/// What is asked of the flight controller at `now`, to follow it: of a plane's, to fly a heading
/// and a speed that lead it back to its path and time; of a copter's, to be where the path is now,
/// its nose along it, once it is within 5 m of its height, and before that to come there where it
/// is. Allocates nothing and takes bounded time.
[[nodiscard]] Demand follow(const HeldGuidance& held, const planning::PathFollowerParams& params,
                            const VehicleSpec& vehicle, const VehicleState& state, Instant now);

/// How far from it a vehicle is at `now`.
struct Deviation {
  std::uint32_t number = 0;    ///< of the flight plan, or of what the track is a part of
  double along_error_m = 0.0;  ///< of a path: positive when ahead of time
  double cross_error_m = 0.0;  ///< positive when left of the path; of a track: the distance
};
[[nodiscard]] Deviation deviation(const HeldGuidance& held, const VehicleSpec& vehicle,
                                  const VehicleState& state, Instant now);

}  // namespace skein::mission
