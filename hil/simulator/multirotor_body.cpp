// SPDX-License-Identifier: Apache-2.0
#include "multirotor_body.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "skein/base/shortened.hpp"

namespace skein::hil {
namespace {

constexpr Duration kStep = std::chrono::milliseconds{20};
constexpr double kStep_s = to_seconds(kStep);
constexpr double kStiffness_radps = 2.5;
constexpr double kDamping = 0.9;
constexpr double kGustTime_s = 1.5;
constexpr double kGustErrorMax_m = 0.3;
constexpr double kAccelerationMax_mps2 = 8.0;

}  // namespace

MultirotorBody::MultirotorBody(const Pose2& place, double gust_error_m, Random random,
                               Instant start)
    : position_{place.x_m, place.y_m, 0.0},
      gust_error_m_{gust_error_m},
      random_{random},
      setpoint_at_{start},
      flown_to_{start} {
  setpoint_.x_m = place.x_m;
  setpoint_.y_m = place.y_m;
  setpoint_.yaw_rad = place.heading_rad;
}

std::optional<VehicleState> MultirotorBody::state(Instant now) {
  while (flown_to_ + kStep <= now) step();
  VehicleState state;
  state.time = flown_to_;
  state.x_m = position_.x();
  state.y_m = position_.y();
  state.z_m = position_.z();
  state.heading_rad = setpoint_.yaw_rad;
  state.groundspeed_mps = std::hypot(velocity_.x(), velocity_.y());
  state.airspeed_mps = state.groundspeed_mps;  // it knows no wind
  state.course_rad = std::atan2(velocity_.y(), velocity_.x());
  state.climb_mps = velocity_.z();
  state.distance_flown_m = distance_flown_m_;
  return state;
}

void MultirotorBody::command(const Demand& demand, Instant now) {
  const auto* setpoint = std::get_if<PositionSetpoint>(&demand);
  if (setpoint == nullptr) return;
  setpoint_ = *setpoint;
  setpoint_at_ = now;
}

void MultirotorBody::gust() {
  const double spring = kStiffness_radps * kStiffness_radps;
  const double deviation = spring * gust_error_m_ * std::sqrt(2.0 * kStep_s / kGustTime_s);
  for (int axis = 0; axis < 3; ++axis) {
    gust_[axis] += -kStep_s / kGustTime_s * gust_[axis] + random_.normal(0.0, deviation);
  }
  gust_ = shortened(gust_, spring * kGustErrorMax_m);
}

void MultirotorBody::step() {
  flown_to_ += kStep;
  gust();
  const PositionSetpoint reference = setpoint_.carried_on(to_seconds(flown_to_ - setpoint_at_));
  // The reference may end a hair above the ground; who stands there stays.
  if (position_.z() <= kAirborne_m && reference.z_m < kAirborne_m) {
    velocity_ = Vec3::Zero();
    return;
  }
  const Vec3 wanted = reference.acceleration_mps2() +
                      2.0 * kDamping * kStiffness_radps * (reference.velocity_mps() - velocity_) +
                      kStiffness_radps * kStiffness_radps * (reference.position_m() - position_);
  velocity_ += kStep_s * (shortened(wanted, kAccelerationMax_mps2) + gust_);
  position_ += kStep_s * velocity_;
  distance_flown_m_ += kStep_s * std::hypot(velocity_.x(), velocity_.y());
  if (position_.z() >= 0.0) return;
  position_.z() = 0.0;
  velocity_ = Vec3::Zero();
}

}  // namespace skein::hil
