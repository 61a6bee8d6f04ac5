// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/base/attitude.hpp"
#include "skein/base/random.hpp"
#include "skein/base/time.hpp"
#include "skein/domain/motion_track.hpp"

namespace skein::hil {

/// A multirotor under position control as a mass on a damped spring that its reference pulls, and
/// gusts push: an acceleration that wanders (Ornstein and Uhlenbeck) and is never so strong that
/// the body rests more than 0.3 m off. On the ground it stands until it is lifted.
class MultirotorBody {
 public:
  MultirotorBody(const Vec3& position_m, double gust_error_m, Random random)
      : position_{position_m}, gust_error_m_{gust_error_m}, random_{random} {}

  /// Follows the reference for one step.
  void step(const MotionTrack::Moment& reference, Duration step);
  /// Comes down where it is, in still air.
  void sink(Duration step);

  [[nodiscard]] const Vec3& position_m() const { return position_; }
  [[nodiscard]] const Vec3& velocity_mps() const { return velocity_; }
  [[nodiscard]] bool airborne() const { return position_.z() > kAirborne_m; }

 private:
  static constexpr double kAirborne_m = 0.05;

  void gust(double seconds);

  Vec3 position_;
  Vec3 velocity_ = Vec3::Zero();
  Vec3 gust_ = Vec3::Zero();
  double gust_error_m_;
  Random random_;
};

}  // namespace skein::hil
