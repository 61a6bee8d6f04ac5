// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "autopilot_vehicle.hpp"
#include "plane_airframe.hpp"
#include "skein/autopilot/plane_autopilot.hpp"
#include "skein/base/result.hpp"
#include "skein/hil/emulator_config.hpp"
#include "skein/models/fixed_wing.hpp"

namespace skein::hil {

/// An airframe of plane_airframe under autopilot::PlaneAutopilot, answering as ArduPlane 4.6 does.
class PlaneVehicle final : public AutopilotVehicle<autopilot::PlaneAutopilot> {
 public:
  /// Precondition: check(config). Fails where the aircraft cannot fly level at its cruise airspeed.
  [[nodiscard]] static Result<std::unique_ptr<Vehicle>> make(const EmulatorConfig& config,
                                                             const Earth& earth, Instant now);
  PlaneVehicle(const EmulatorConfig& config, const PlaneAirframe& airframe, const Earth& earth,
               const models::Trim& trim, Instant now);

  /// ArduPlane calls a quadplane so, too, unless Q_MAV_TYPE says otherwise.
  [[nodiscard]] mavlink::VehicleType type() const override {
    return mavlink::VehicleType::fixed_wing;
  }
  [[nodiscard]] Duration period() const override { return std::chrono::milliseconds{20}; }
  [[nodiscard]] bool streams_unasked() const override { return true; }

  void control(Instant now) override;
  void coast(Instant now) override;
  void restart(Instant now) override;
  autopilot::CommandResult select_mode(std::uint32_t mode) override;
  mavlink::CommandResult command(const mavlink::CommandInt& command) override;
  mavlink::MissionResult load_mission(std::span<const mavlink::MissionItemInt> items) override;
  void on_attitude_target(const mavlink::SetAttitudeTarget& target, Instant now) override;
  void on_position_target(const mavlink::SetPositionTargetLocalNed& target, Instant now) override;
  void on_position_target(const mavlink::SetPositionTargetGlobalInt& target, Instant now) override;

 private:
  void start_autopilot(Instant now, autopilot::PlaneMode mode);
  [[nodiscard]] Vec3 home_of(const Vec3& position_m) const override;
  void tell() override;
  [[nodiscard]] bool guided() const { return autopilot_.mode() == autopilot::PlaneMode::guided; }
  mavlink::CommandResult reposition(const mavlink::CommandInt& c);
  mavlink::CommandResult change_speed(const mavlink::CommandInt& c);
  mavlink::CommandResult change_height(const mavlink::CommandInt& c);
  mavlink::CommandResult guided_speed(const mavlink::CommandInt& c);
  mavlink::CommandResult guided_height(const mavlink::CommandInt& c);
  mavlink::CommandResult guided_heading(const mavlink::CommandInt& c);
  mavlink::CommandResult enter(autopilot::PlaneMode mode);
  /// Nothing where its parameters do not allow that equivalent airspeed.
  [[nodiscard]] std::optional<double> true_airspeed(double equivalent_mps) const;

  models::FixedWing aircraft_;
  autopilot::PlaneParams params_;
  double airspeed_min_mps_;  ///< equivalent, as its parameters are
  double airspeed_max_mps_;
  autopilot::SurfaceCommand surfaces_;
};

}  // namespace skein::hil
