// SPDX-License-Identifier: Apache-2.0
#include "skein/ardupilot/motion.hpp"

#include <algorithm>
#include <cmath>

#include "skein/base/angles.hpp"
#include "skein/base/atmosphere.hpp"
#include "skein/base/attitude.hpp"

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
/// Slower ones are on the ground, or hardly measured.
constexpr double kFliesAbove_mps = 8.0;
constexpr double kBankMost_rad = radians(75.0);

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
  nose_rad_ = heading_from_yaw(attitude.yaw);
  // Body rates to the rate of yaw (Beard and McLain, eq. 3.3); yaw is clockwise, heading is not.
  const double roll = attitude.roll;
  bank_rad_ = wrap_pi(roll);
  const double pitch = std::clamp(double{attitude.pitch}, -1.4, 1.4);
  nose_rate_radps_ =
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
    state_.course_rad = nose_rad_;
  }
  state_.climb_mps = velocity.z();
  true_per_equivalent_ = true_per_equivalent_airspeed(static_cast<double>(position.alt) * 1e-3);
  if (since > Duration{}) learn(over_ground, since <= kGapMax ? since : Duration{}, measured);
  over_ground_mps_ = over_ground;
  relative_height_m_ = position.relative_alt * 1e-3;
}

void Motion::learn(const Vec2& over_ground_mps, Duration since, Instant measured) {
  if (hovers_ || !has_attitude_ || !has_hud_ || airspeed_mps() < kFliesAbove_mps) return;
  const Duration apart = std::clamp(measured - attitude_at_, -kCarryMax, kCarryMax);
  const double nose = nose_rad_ + nose_rate_radps_ * to_seconds(apart);
  wind_.on_measurement(measured, over_ground_mps - airspeed_mps() * unit_vector(nose));
  if (since <= Duration{}) return;
  const Vec2 through_air = over_ground_mps - *wind_.mean_mps();
  const Vec2 change = (over_ground_mps - over_ground_mps_) / to_seconds(since);
  // To the right, as banks are.
  turn_ability_.on_measurement(measured, -left_of(through_air).normalized().dot(change), bank_rad_);
}

double Motion::airspeed_mps() const { return equivalent_airspeed_mps_ * true_per_equivalent_; }

/// Turns count counter-clockwise, banks to the right.
double Motion::turn_rate_radps() const {
  const double bank = std::clamp(bank_rad_, -kBankMost_rad, kBankMost_rad);
  return -turn_ability_.share() * kGravity_mps2 * std::tan(bank) /
         std::max(airspeed_mps(), kFliesAbove_mps);
}

void Motion::on_hud(const mavlink::VfrHud& hud, Instant now) {
  if (!(std::abs(hud.airspeed) <= kAirspeedMax_mps)) return;
  has_hud_ = true;
  equivalent_airspeed_mps_ = hud.airspeed;
  hud_at_ = now;
}

void Motion::forget() {
  has_attitude_ = false;
  has_position_ = false;
  has_hud_ = false;
}

std::optional<MotionSample> Motion::sample() const {
  if (!has_attitude_ || !has_position_ || !has_hud_) return std::nullopt;
  MotionSample sample{state_, 0.0, turn_ability_.share(), true_per_equivalent_};
  if (hovers_) {
    const bool moves = state_.groundspeed_mps > kCourseKnownAbove_mps;
    sample.state.heading_rad = moves ? state_.course_rad : nose_rad_;
    sample.state.airspeed_mps = state_.groundspeed_mps;
    return sample;  // its body may turn as it likes
  }
  const Duration apart = std::clamp(state_.time - attitude_at_, -kCarryMax, kCarryMax);
  sample.state.airspeed_mps = airspeed_mps();
  if (airspeed_mps() >= kFliesAbove_mps) sample.turn_rate_radps = turn_rate_radps();
  const Vec2 through_air = over_ground_mps_ - wind_.mean_mps().value_or(Vec2{0.0, 0.0});
  if (wind_.mean_mps() && airspeed_mps() >= kFliesAbove_mps &&
      through_air.norm() > kFliesAbove_mps / 2.0) {
    sample.state.heading_rad = std::atan2(through_air.y(), through_air.x());
    sample.state.airspeed_mps = through_air.norm();
  } else {
    sample.state.heading_rad = wrap_pi(nose_rad_ + nose_rate_radps_ * to_seconds(apart));
  }
  // An attitude that comes no more makes the state old, though positions go on coming.
  if (apart > Duration{}) sample.state = moved(sample, -apart);
  sample.state.time = std::min(sample.state.time, attitude_at_);
  if (state_.time - hud_at_ > kAirspeedAgeMax) {
    sample.state.time = std::min(sample.state.time, hud_at_);
  }
  return sample;
}

}  // namespace skein::ardupilot
