// SPDX-License-Identifier: Apache-2.0
#include "take_off.hpp"

#include <cmath>
#include <utility>

namespace skein::mission {
namespace {

/// ArduCopter climbs by 2.5 m/s and 1 m/s^2 at most where nobody has set it otherwise.
constexpr formation::MotionLimits kClimb{
    .speed_mps = 2.0, .acceleration_mps2 = 0.8, .jerk_mps3 = 2.0};
constexpr double kAtHeight_m = 1.0;
constexpr double kLevel_mps = 0.5;
/// So far from its reference it does not follow it.
constexpr double kAstray_m = 5.0;

}  // namespace

bool TakeOff::at_height(const VehicleState& state) const {
  return std::abs(state.z_m - vehicle_.height_m) < kAtHeight_m &&
         std::abs(state.climb_mps) < kLevel_mps;
}

void TakeOff::begin(const Vec3& from, Instant now) {
  formation::Change change;
  change.start = now;
  change.limits = kClimb;
  formation::Mover& mover = change.movers.emplace_back();
  mover.vehicle = vehicle_.id;
  mover.points = {from, Vec3{from.x(), from.y(), vehicle_.height_m}};
  climb_.reset();
  if (!formation::valid(change)) return;  // no place from which one climbs
  climb_.emplace(change, 0, formation::PassageParams{}, now);
}

bool TakeOff::done(const VehicleState& state, Instant now) {
  if (!vehicle_.is_copter()) return true;
  if (at_height(state)) {
    climb_.reset();
    return true;
  }
  const Vec3 here = state.position().metres();
  if (climb_) climb_->step(now);
  if (!climb_ || (here - climb_->reference(now).position_m).norm() > kAstray_m) {
    begin(here, now);
    if (climb_) climb_->step(now);
  }
  if (climb_) track_ = climb_->track();
  return false;
}

std::optional<MotionTrack> TakeOff::poll_track() { return std::exchange(track_, std::nullopt); }

}  // namespace skein::mission
