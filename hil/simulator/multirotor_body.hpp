// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "skein/base/attitude.hpp"
#include "skein/base/random.hpp"
#include "skein/base/time.hpp"
#include "skein/hal/flight_controller.hpp"

namespace skein::hil {

/// A multirotor under position control as a mass on a damped spring that its reference pulls, and
/// gusts push: an acceleration that wanders (Ornstein and Uhlenbeck) and is never so strong that
/// the body rests more than 0.3 m off. Its nose is where it should be at once. On the ground it
/// stands until it is lifted.
class MultirotorBody final : public hal::FlightController {
 public:
  /// Higher, it flies.
  static constexpr double kAirborne_m = 0.05;

  /// On the ground; it is there at `start`.
  MultirotorBody(const Pose2& place, double gust_error_m, Random random, Instant start);

  [[nodiscard]] std::optional<VehicleState> state(Instant now) override;
  void command(const Demand& demand, Instant now) override;

 private:
  void step();
  void gust();

  Vec3 position_;
  Vec3 velocity_ = Vec3::Zero();
  Vec3 gust_ = Vec3::Zero();
  double gust_error_m_;
  Random random_;
  PositionSetpoint setpoint_;
  Instant setpoint_at_;
  Instant flown_to_;
  double distance_flown_m_ = 0.0;
};

}  // namespace skein::hil
