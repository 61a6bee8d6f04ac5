// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "earth.hpp"
#include "skein/autopilot/command.hpp"
#include "skein/autopilot/estimate.hpp"
#include "skein/mavlink/command.hpp"
#include "skein/mavlink/enums.hpp"
#include "skein/mavlink/mission.hpp"
#include "skein/models/rigid_body.hpp"

namespace skein::hil {

/// What the autopilot tells of its flight. Positions are NED of the mission's origin.
struct FlightReport {
  autopilot::Estimate estimate;
  models::RigidBodyState truth;
  Vec3 wind_ned_mps = Vec3::Zero();
  double throttle = 0.0;  ///< [0, 1]
  bool armed = false;
  bool flying = false;
  mavlink::VtolState vtol = mavlink::VtolState::undefined;
  bool rolling = false;  ///< a plane on its take-off run: ArduPlane tells that it is in the air
  std::optional<std::string_view> mode_refusal;  ///< why it would not arm in its mode
  std::uint32_t mode = 0;                        ///< custom_mode
  std::uint8_t base_mode = 0;                    ///< without its bit for armed
  Vec3 home_m = Vec3::Zero();                    ///< where it returns to
  Vec3 goal_m = Vec3::Zero();                    ///< what it flies to
  double goal_airspeed_mps = 0.0;                ///< asked of the loops
  double roll_demand_rad = 0.0;
  double pitch_demand_rad = 0.0;
};

[[nodiscard]] constexpr mavlink::CommandResult on_wire(autopilot::CommandResult result) {
  return static_cast<mavlink::CommandResult>(result);
}

/// An aircraft with its autopilot, behind the messages. Time never decreases.
class Vehicle {
 public:
  Vehicle() = default;
  Vehicle(const Vehicle&) = delete;
  Vehicle& operator=(const Vehicle&) = delete;
  virtual ~Vehicle() = default;

  [[nodiscard]] virtual mavlink::VehicleType type() const = 0;
  /// Of the autopilot's main loop.
  [[nodiscard]] virtual Duration period() const = 0;
  /// Whether it streams before it is asked to.
  [[nodiscard]] virtual bool streams_unasked() const = 0;

  /// The aircraft flies until `now`, then the autopilot has one period.
  virtual void control(Instant now) = 0;
  /// The aircraft flies until `now` with its surfaces as they are: the autopilot restarts.
  virtual void coast(Instant now) = 0;
  /// A new autopilot, in the mode of the pilot's switch; armed where it flies.
  virtual void restart(Instant now) = 0;
  [[nodiscard]] virtual const FlightReport& report() const = 0;

  virtual autopilot::CommandResult select_mode(std::uint32_t mode) = 0;
  virtual autopilot::CommandResult arm() = 0;
  virtual autopilot::CommandResult disarm(bool force) = 0;
  /// Commands that depend on the kind of vehicle; unsupported where it knows none.
  virtual mavlink::CommandResult command(const mavlink::CommandInt& command) = 0;
  /// Takes the place of the one before; the first item is home.
  virtual mavlink::MissionResult load_mission(std::span<const mavlink::MissionItemInt> /*items*/) {
    return mavlink::MissionResult::unsupported;
  }
  virtual void on_attitude_target(const mavlink::SetAttitudeTarget& target, Instant now) = 0;
  virtual void on_position_target(const mavlink::SetPositionTargetLocalNed& target,
                                  Instant now) = 0;
  virtual void on_position_target(const mavlink::SetPositionTargetGlobalInt& target,
                                  Instant now) = 0;
  virtual void companion_heard(Instant now) = 0;
  virtual void set_health(const autopilot::Health& health) = 0;
  [[nodiscard]] virtual std::optional<autopilot::Notice> poll_notice() = 0;
};

/// The height of a command, NED down, by its frame: above the ellipsoid, or above home. Nothing for
/// the other frames.
[[nodiscard]] std::optional<double> down_of(double altitude_m, std::uint8_t frame,
                                            const Earth& earth, const Vec3& home_m);

}  // namespace skein::hil
