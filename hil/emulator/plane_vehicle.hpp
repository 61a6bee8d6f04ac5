// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "air.hpp"
#include "skein/autopilot/plane_autopilot.hpp"
#include "skein/base/result.hpp"
#include "skein/hil/emulator_config.hpp"
#include "skein/models/fixed_wing.hpp"
#include "vehicle.hpp"

namespace skein::hil {

/// models::fast_fixed_wing() under autopilot::PlaneAutopilot, answering as ArduPlane 4.6 does.
class PlaneVehicle final : public Vehicle {
 public:
  /// Precondition: check(config). Fails where the aircraft cannot fly level at its cruise airspeed.
  [[nodiscard]] static Result<std::unique_ptr<Vehicle>> make(const EmulatorConfig& config,
                                                             const Earth& earth, Instant now);
  PlaneVehicle(const EmulatorConfig& config, const Earth& earth, const models::Trim& trim,
               Instant now);

  [[nodiscard]] mavlink::VehicleType type() const override {
    return mavlink::VehicleType::fixed_wing;
  }
  [[nodiscard]] Duration period() const override { return std::chrono::milliseconds{20}; }
  [[nodiscard]] bool streams_unasked() const override { return true; }

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
  [[nodiscard]] bool held(Instant now) const { return now < hold_until_; }
  void start_autopilot(Instant now, autopilot::PlaneMode mode);
  void sense(double seconds);
  void tell();
  [[nodiscard]] bool guided() const { return autopilot_.mode() == autopilot::PlaneMode::guided; }
  mavlink::CommandResult reposition(const mavlink::CommandInt& c);
  mavlink::CommandResult change_speed(const mavlink::CommandInt& c);
  mavlink::CommandResult change_height(const mavlink::CommandInt& c);
  mavlink::CommandResult guided_speed(const mavlink::CommandInt& c);
  mavlink::CommandResult guided_height(const mavlink::CommandInt& c);
  mavlink::CommandResult guided_heading(const mavlink::CommandInt& c);
  mavlink::CommandResult enter(autopilot::PlaneMode mode);

  Earth earth_;
  Instant hold_until_;
  Air air_;
  Senses senses_;
  models::FixedWing aircraft_;
  Instant flown_to_;
  autopilot::PlaneParams params_;
  autopilot::PlaneAutopilot autopilot_;
  autopilot::Health health_;
  autopilot::SurfaceCommand surfaces_;
  FlightReport report_;
};

}  // namespace skein::hil
