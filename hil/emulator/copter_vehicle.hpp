// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "air.hpp"
#include "skein/autopilot/copter_autopilot.hpp"
#include "skein/hil/emulator_config.hpp"
#include "skein/models/hexarotor.hpp"
#include "vehicle.hpp"

namespace skein::hil {

/// models::firefly() under autopilot::CopterAutopilot, answering as ArduCopter 4.6 does.
class CopterVehicle final : public Vehicle {
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
  [[nodiscard]] const FlightReport& report() const override { return report_; }

  autopilot::CommandResult select_mode(std::uint32_t mode) override;
  autopilot::CommandResult arm() override;
  autopilot::CommandResult disarm(bool force) override;
  mavlink::CommandResult command(const mavlink::CommandInt& command) override;
  void on_attitude_target(const mavlink::SetAttitudeTarget& target, Instant now) override;
  void on_position_target(const mavlink::SetPositionTargetLocalNed& target, Instant now) override;
  void on_position_target(const mavlink::SetPositionTargetGlobalInt& target, Instant now) override;
  void companion_heard(Instant now) override { autopilot_.companion_heard(now); }
  void set_health(const autopilot::Health& health) override;
  [[nodiscard]] std::optional<autopilot::Notice> poll_notice() override;

 private:
  /// BRAKE is its LOITER with the sticks in the middle, where a companion keeps its hands off.
  static constexpr std::uint32_t kBrake = 17;

  [[nodiscard]] bool held(Instant now) const { return now < hold_until_; }
  void start_autopilot(Instant now, bool in_flight, autopilot::CopterMode mode);
  void sense();
  void tell();
  mavlink::CommandResult reposition(const mavlink::CommandInt& c);
  mavlink::CommandResult take_off(const mavlink::CommandInt& c);

  Earth earth_;
  Instant hold_until_;
  Vec3 ekf_origin_m_;
  Air air_;
  Senses senses_;
  models::Hexarotor aircraft_;
  Instant flown_to_;
  autopilot::CopterParams params_;
  autopilot::CopterAutopilot autopilot_;
  autopilot::Health health_;
  models::RotorSpeeds rotors_{};
  bool braking_ = false;
  FlightReport report_;
};

}  // namespace skein::hil
