// SPDX-License-Identifier: Apache-2.0
#include "landing.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "skein/base/angles.hpp"
#include "skein/planning/avoidance.hpp"

namespace skein::mission {
namespace {

constexpr formation::MotionLimits kAcross{
    .speed_mps = 4.0, .acceleration_mps2 = 1.5, .jerk_mps3 = 3.0};
/// ArduCopter sinks by 1.5 m/s at most where nobody has set it otherwise.
constexpr formation::MotionLimits kDown{
    .speed_mps = 1.5, .acceleration_mps2 = 0.5, .jerk_mps3 = 1.0};
constexpr double kOver_m = 1.0;    ///< so near to the place it is over it
constexpr double kAstray_m = 5.0;  ///< so far from its reference it does not follow it

}  // namespace

Landing landing_of(const VehicleSpec& vehicle, const Pose2& start) {
  const LandingSpec& spec = vehicle.landing;
  Landing landing;
  landing.x_m = spec.x_m.value_or(start.x_m);
  landing.y_m = spec.y_m.value_or(start.y_m);
  landing.heading_rad = wrap_pi(spec.heading_rad.value_or(start.heading_rad));
  landing.approach_m = spec.approach_m;
  landing.approach_height_m = std::min(spec.approach_height_m, vehicle.height_m);
  landing.radius_m = vehicle.planning_radius_m();
  return landing;
}

Landing landing_after(const VehicleSpec& vehicle, const Pose2& begin) {
  VehicleSpec here = vehicle;
  const double ahead_m = vehicle.is_copter() ? 0.0 : vehicle.landing.approach_m;
  const Vec2 down = begin.position() + ahead_m * unit_vector(begin.heading_rad);
  here.landing.x_m = down.x();
  here.landing.y_m = down.y();
  here.landing.heading_rad = begin.heading_rad;
  return landing_of(here, begin);
}

bool is_open(const Landing& landing, const std::vector<Hazard>& hazards, double margin_m,
             const Fence& fence) {
  std::vector<Hazard> wide = hazards;
  for (Hazard& hazard : wide) hazard.radius_m += margin_m;
  const Vec2 begin = approach_begin(landing);
  Path down{{begin.x(), begin.y(), landing.heading_rad}, {}};
  return down.append(Segment{1.0 / landing.radius_m, kTwoPi * landing.radius_m}) &&
         down.append(Segment{0.0, landing.approach_m}) && planning::is_clear(down, wide) &&
         fence.holds(down);
}

void Descent::begin(const Vec3& from, Instant now) {
  sinks_ = (from - over_).head<2>().norm() <= kOver_m;
  formation::Change change;
  change.start = now;
  change.limits = sinks_ ? kDown : kAcross;
  formation::Mover& mover = change.movers.emplace_back();
  mover.points = {from, sinks_ ? Vec3{over_.x(), over_.y(), ground_m_} : over_};
  passage_.reset();
  if (!formation::valid(change)) return;  // no place from which one comes down
  passage_.emplace(change, 0, formation::PassageParams{}, now);
}

void Descent::step(const VehicleState& state, Instant now) {
  if (state.on_ground()) return;
  const Vec3 here = state.position().metres();
  if (passage_) passage_->step(now);
  const bool follows = passage_ && (here - passage_->reference(now).position_m).norm() <= kAstray_m;
  const bool is_over =
      follows && !sinks_ && passage_->finished() && (here - over_).head<2>().norm() <= kOver_m;
  if (!follows || is_over) {
    begin(here, now);
    if (passage_) passage_->step(now);
  }
  if (passage_) track_ = passage_->track();
}

std::optional<MotionTrack> Descent::poll_track() { return std::exchange(track_, std::nullopt); }

}  // namespace skein::mission
