// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/base/time.hpp"
#include "skein/domain/site.hpp"
#include "skein/domain/task.hpp"
#include "skein/idl/coalition.hpp"

namespace skein::coalition {

/// The coalition stands, and its leader has its electors behind it.
[[nodiscard]] inline bool stands(const LeaseRenewal& renewal) {
  return !renewal.electors.empty() && renewal.lease_until > renewal.sent_at;
}

/// Paths can be planned for who bids that. Lower than any vehicle's, so that lengths over speeds,
/// and turns on radii, stay numbers.
[[nodiscard]] inline bool makes_sense(const Bid& bid) {
  constexpr double kSpeedMin_mps = 0.1;
  constexpr double kRadiusMin_m = 0.1;
  return bid.speed_mps >= kSpeedMin_mps && bid.planning_radius_m >= kRadiusMin_m;
}

/// What the bidder's final approach takes at most.
[[nodiscard]] inline Duration approach_time(const Bid& bid) {
  const Duration in_still_air = from_seconds(bid.final_approach_m / bid.speed_mps);
  return bid.approach > in_still_air ? bid.approach : in_still_air;
}

/// Its times are in order, and it keeps nobody waiting for longer than a coalition takes to form.
[[nodiscard]] inline bool makes_sense(const Announcement& announcement, Instant now) {
  constexpr Duration kFormsWithin = std::chrono::minutes{10};
  return announcement.bids_until <= announcement.formed_at &&
         announcement.formed_at <= now + kFormsWithin;
}

}  // namespace skein::coalition
