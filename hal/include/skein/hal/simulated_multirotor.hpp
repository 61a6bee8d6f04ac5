// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "skein/autopilot/hexarotor_loops.hpp"
#include "skein/base/frames.hpp"
#include "skein/hal/flight_controller.hpp"
#include "skein/models/dryden_gusts.hpp"
#include "skein/models/hexarotor.hpp"
#include "skein/models/sensors.hpp"

namespace skein::hal {

struct SimulatedMultirotorParams {
  Position<MissionEnu> start;  ///< on the ground, which is level there
  double yaw_rad = 0.0;        ///< at the start, from east, counter-clockwise
  Vec2 wind_mps{0.0, 0.0};     ///< steady; where the air moves to, mission frame
  double gust_mps = 0.0;       ///< standard deviation of the horizontal gusts 6 m above the ground
  std::uint64_t seed = 1;      ///< of the gusts and the navigation errors
  autopilot::HexarotorTuning tuning{};
  /// The errors of what it knows of its position and velocity: ten fixes a second, smoothed over a
  /// second as a filter does. Without, it knows them exactly.
  std::optional<models::GnssParams> gnss{};
};

/// A flight controller with its hexarotor, in this process: models::firefly() in the gusts of
/// models::DrydenGusts, under autopilot::HexarotorLoops, both advanced in steps of kStep up to
/// `now` whenever it is asked. What it does depends on the setpoints and their times alone, not on
/// how often it is asked.
///
/// It stands on the ground with its motors off until mission time 0 and until a setpoint lifts it.
/// A setpoint that is not renewed moves on for kSetpointAgeMax and is then brought to rest at
/// kBrake_mps2: there the vehicle stays. Where the setpoint is at the ground or below, it comes
/// down to it, and after kLanded on the ground its motors stop. Setpoints of a fixed wing, and
/// those with a number that is not finite, have no effect.
class SimulatedMultirotor final : public FlightController {
 public:
  static constexpr Duration kStep = std::chrono::microseconds{2500};
  static constexpr Duration kSetpointAgeMax = std::chrono::milliseconds{500};
  static constexpr Duration kLanded = std::chrono::seconds{1};
  static constexpr double kBrake_mps2 = 2.0;

  explicit SimulatedMultirotor(const SimulatedMultirotorParams& params);

  /// z counts from the vehicle's feet; the airspeed is that through the air with its gusts.
  [[nodiscard]] std::optional<VehicleState> state(Instant now) override;
  void command(const Demand& demand, Instant now) override;

  /// The motors turn.
  [[nodiscard]] bool flying() const { return flying_; }
  [[nodiscard]] Airborne airborne() const override {
    return flying_ ? Airborne::yes : Airborne::no;
  }
  /// Where it really is, as of the last call.
  [[nodiscard]] Position<MissionEnu> true_position() const;

 private:
  void advance_to(Instant now);
  void step();
  void rest();
  void sense();
  /// The point that is followed, at the end of the last step.
  [[nodiscard]] PositionSetpoint point() const;
  [[nodiscard]] autopilot::MotionDemand demand(const PositionSetpoint& point) const;
  [[nodiscard]] double height_m() const;  ///< of the feet above the ground

  SimulatedMultirotorParams params_;
  models::HexarotorParams airframe_;
  models::Hexarotor vehicle_;
  autopilot::HexarotorLoops loops_;
  models::DrydenGusts gusts_;
  std::optional<models::Gnss> gnss_;
  Vec3 position_error_m_ = Vec3::Zero();
  Vec3 velocity_error_mps_ = Vec3::Zero();
  Vec3 wind_ned_mps_;
  Instant flown_to_{};
  Duration until_fix_{};
  Duration grounded_{};  ///< how long it has stood where it is to land
  PositionSetpoint setpoint_;
  std::optional<Instant> setpoint_at_;
  double distance_flown_m_ = 0.0;
  bool flying_ = false;
};

}  // namespace skein::hal
