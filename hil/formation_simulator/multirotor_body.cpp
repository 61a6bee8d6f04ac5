// SPDX-License-Identifier: Apache-2.0
#include "multirotor_body.hpp"

#include <algorithm>
#include <cmath>

#include "skein/base/shortened.hpp"

namespace skein::hil {
namespace {

constexpr double kStiffness_radps = 2.5;
constexpr double kDamping = 0.9;
constexpr double kGustTime_s = 1.5;
constexpr double kGustErrorMax_m = 0.3;
constexpr double kAccelerationMax_mps2 = 8.0;
constexpr double kSink_mps = 1.0;

}  // namespace

void MultirotorBody::gust(double seconds) {
  const double spring = kStiffness_radps * kStiffness_radps;
  const double deviation = spring * gust_error_m_ * std::sqrt(2.0 * seconds / kGustTime_s);
  for (int axis = 0; axis < 3; ++axis) {
    gust_[axis] += -seconds / kGustTime_s * gust_[axis] + random_.normal(0.0, deviation);
  }
  gust_ = shortened(gust_, spring * kGustErrorMax_m);
}

void MultirotorBody::step(const MotionTrack::Moment& reference, Duration step) {
  const double seconds = to_seconds(step);
  gust(seconds);
  // The reference may end a hair above the ground; who stands there stays.
  if (!airborne() && reference.position_m.z() < kAirborne_m) {
    velocity_ = Vec3::Zero();
    return;
  }
  const Vec3 wanted = reference.acceleration_mps2 +
                      2.0 * kDamping * kStiffness_radps * (reference.velocity_mps - velocity_) +
                      kStiffness_radps * kStiffness_radps * (reference.position_m - position_);
  velocity_ += seconds * (shortened(wanted, kAccelerationMax_mps2) + gust_);
  position_ += seconds * velocity_;
  if (position_.z() >= 0.0) return;
  position_.z() = 0.0;
  velocity_ = Vec3::Zero();
}

void MultirotorBody::sink(Duration step) {
  const double seconds = to_seconds(step);
  velocity_ = airborne() ? Vec3{0.0, 0.0, -kSink_mps} : Vec3{0.0, 0.0, 0.0};
  position_ += seconds * velocity_;
  position_.z() = std::max(0.0, position_.z());
}

}  // namespace skein::hil
