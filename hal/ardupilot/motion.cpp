// SPDX-License-Identifier: Apache-2.0
#include "skein/ardupilot/motion.hpp"

#include <algorithm>
#include <cmath>

#include "skein/base/angles.hpp"

namespace skein::ardupilot {
namespace {

/// Below it the direction of motion is noise.
constexpr double kCourseKnownAbove_mps = 1.0;
/// Two positions further apart in time are not joined to a distance flown.
constexpr Duration kGapMax = std::chrono::seconds{2};
/// Of angles in rad and rates in rad/s; what is beyond is no attitude.
constexpr float kAttitudeMax = 100.0F;
constexpr std::int32_t kLatitudeMax_e7 = 900'000'000;
constexpr std::int32_t kLongitudeMax_e7 = 1'800'000'000;
constexpr float kAirspeedMax_mps = 1000.0F;
/// Airspeed changes slowly; one that is older makes the state as old as itself.
constexpr Duration kAirspeedAgeMax = std::chrono::seconds{1};

/// Along the arc, forwards or backwards.
VehicleState moved(const MotionSample& sample, Duration by) {
  VehicleState state = sample.state;
  const double seconds = to_seconds(by);
  const double turned = sample.turn_rate_radps * seconds;
  const double metres = state.groundspeed_mps * seconds;
  const Vec2 way = metres * unit_vector(state.course_rad + turned / 2.0);
  state.time += by;
  state.x_m += way.x();
  state.y_m += way.y();
  state.z_m += state.climb_mps * seconds;
  state.heading_rad = wrap_pi(state.heading_rad + turned);
  state.course_rad = wrap_pi(state.course_rad + turned);
  state.distance_flown_m += metres;
  return state;
}

}  // namespace

VehicleState carried_to(const MotionSample& sample, Instant now) {
  return moved(sample, std::clamp(now - sample.state.time, Duration{}, kCarryMax));
}

void Motion::on_attitude(const mavlink::Attitude& attitude, Instant measured) {
  for (const float value :
       {attitude.yaw, attitude.roll, attitude.pitch, attitude.pitchspeed, attitude.yawspeed}) {
    if (!(std::abs(value) <= kAttitudeMax)) return;  // NaN neither
  }
  has_attitude_ = true;
  attitude_at_ = measured;
  heading_rad_ = heading_from_yaw(attitude.yaw);
  // Body rates to the rate of yaw (Beard and McLain, eq. 3.3); yaw is clockwise, heading is not.
  const double roll = attitude.roll;
  const double pitch = std::clamp(double{attitude.pitch}, -1.4, 1.4);
  turn_rate_radps_ =
      -(double{attitude.pitchspeed} * std::sin(roll) + double{attitude.yawspeed} * std::cos(roll)) /
      std::cos(pitch);
}

void Motion::on_position(const mavlink::GlobalPositionInt& position, Instant measured) {
  // An ArduPilot that does not know where it is tells 0, 0.
  if (position.lat == 0 && position.lon == 0) return;
  if (position.lat < -kLatitudeMax_e7 || position.lat > kLatitudeMax_e7 ||
      position.lon < -kLongitudeMax_e7 || position.lon > kLongitudeMax_e7) {
    return;
  }
  const auto enu = origin_.to_enu({position.lat * 1e-7, position.lon * 1e-7,
                                   static_cast<double>(position.alt) * 1e-3 + geoid_height_m_});
  const Eigen::Vector3d velocity =
      enu_from_ned({position.vx * 0.01, position.vy * 0.01, position.vz * 0.01});
  const Vec2 over_ground = velocity.head<2>();
  const Duration since = measured - state_.time;
  if (has_position_ && since > Duration{} && since <= kGapMax && measured > Instant{}) {
    state_.distance_flown_m += over_ground.norm() * to_seconds(since);
  }
  has_position_ = true;
  state_.time = measured;
  state_.x_m = enu.x();
  state_.y_m = enu.y();
  state_.z_m = enu.z();
  state_.groundspeed_mps = over_ground.norm();
  const double known_above_mps = hovers_ ? 0.0 : kCourseKnownAbove_mps;
  if (state_.groundspeed_mps > known_above_mps) {
    state_.course_rad = std::atan2(over_ground.y(), over_ground.x());
  } else {
    state_.course_rad = heading_rad_;
  }
  state_.climb_mps = velocity.z();
  relative_height_m_ = position.relative_alt * 1e-3;
}

void Motion::on_hud(const mavlink::VfrHud& hud, Instant now) {
  if (!(std::abs(hud.airspeed) <= kAirspeedMax_mps)) return;
  has_hud_ = true;
  airspeed_mps_ = hud.airspeed;
  hud_at_ = now;
}

void Motion::forget() {
  has_attitude_ = false;
  has_position_ = false;
  has_hud_ = false;
}

std::optional<MotionSample> Motion::sample() const {
  if (!has_attitude_ || !has_position_ || !has_hud_) return std::nullopt;
  MotionSample sample{state_, turn_rate_radps_};
  if (hovers_) {
    const bool moves = state_.groundspeed_mps > kCourseKnownAbove_mps;
    sample.state.heading_rad = moves ? state_.course_rad : heading_rad_;
    sample.state.airspeed_mps = state_.groundspeed_mps;
    // Its body may turn as it likes.
    sample.turn_rate_radps = 0.0;
    return sample;
  }
  const Duration apart = std::clamp(state_.time - attitude_at_, -kCarryMax, kCarryMax);
  sample.state.heading_rad = wrap_pi(heading_rad_ + turn_rate_radps_ * to_seconds(apart));
  sample.state.airspeed_mps = airspeed_mps_;
  // An attitude that comes no more makes the state old, though positions go on coming.
  if (apart > Duration{}) sample.state = moved(sample, -apart);
  sample.state.time = std::min(sample.state.time, attitude_at_);
  if (state_.time - hud_at_ > kAirspeedAgeMax) {
    sample.state.time = std::min(sample.state.time, hud_at_);
  }
  return sample;
}

}  // namespace skein::ardupilot
