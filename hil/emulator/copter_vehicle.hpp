// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "autopilot_vehicle.hpp"
#include "skein/autopilot/copter_autopilot.hpp"
#include "skein/hil/emulator_config.hpp"
#include "skein/models/hexarotor.hpp"

namespace skein::hil {

/// models::firefly() under autopilot::CopterAutopilot, answering as ArduCopter 4.6 does.
class CopterVehicle final : public AutopilotVehicle<autopilot::CopterAutopilot> {
 public:
  /// Precondition: check(config).
  CopterVehicle(const EmulatorConfig& config, const Earth& earth, Instant now);

  [[nodiscard]] mavlink::VehicleType type() const override {
    return mavlink::VehicleType::hexarotor;
  }
  [[nodiscard]] Duration period() const override { return std::chrono::microseconds{2500}; }
  [[nodiscard]] bool streams_unasked() const override { return false; }

  void control(Instant now) override;
  void coast(Instant now) override;
  void restart(Instant now) override;
  autopilot::CommandResult select_mode(std::uint32_t mode) override;
  mavlink::CommandResult command(const mavlink::CommandInt& command) override;
  void on_attitude_target(const mavlink::SetAttitudeTarget& target, Instant now) override;
  void on_position_target(const mavlink::SetPositionTargetLocalNed& target, Instant now) override;
  void on_position_target(const mavlink::SetPositionTargetGlobalInt& target, Instant now) override;

 private:
  /// BRAKE is its LOITER with the sticks in the middle, where a companion keeps its hands off.
  static constexpr std::uint32_t kBrake = 17;

  void start_autopilot(Instant now, bool in_flight, autopilot::CopterMode mode);
  void tell() override;
  mavlink::CommandResult reposition(const mavlink::CommandInt& c);
  mavlink::CommandResult take_off(const mavlink::CommandInt& c);

  Vec3 ekf_origin_m_;
  models::Hexarotor aircraft_;
  autopilot::CopterParams params_;
  models::RotorSpeeds rotors_{};
  bool braking_ = false;
};

}  // namespace skein::hil
