// SPDX-License-Identifier: Apache-2.0
#include "copter_vehicle.hpp"

#include <algorithm>
#include <cmath>

#include "skein/base/angles.hpp"
#include "skein/base/frames.hpp"

namespace skein::hil {
namespace {

using autopilot::CopterMode;
using mavlink::CommandResult;

constexpr double kParkedHeight_m = 0.075;
/// The middle of the pilot's throttle stick: neither climb nor descent.
constexpr double kStickMiddle = 0.5;
/// A new autopilot in flight finds within this that it flies.
constexpr int kPeriodsToKnow = 80;

/// DO_REPOSITION, param2.
constexpr unsigned kChangeMode = 1;

constexpr unsigned kIgnorePosition = mavlink::ignore_x | mavlink::ignore_y | mavlink::ignore_z;
constexpr unsigned kIgnoreVelocity = mavlink::ignore_vx | mavlink::ignore_vy | mavlink::ignore_vz;
constexpr unsigned kIgnoreAcceleration =
    mavlink::ignore_ax | mavlink::ignore_ay | mavlink::ignore_az;

// HEARTBEAT, base_mode, as ArduCopter makes it.
constexpr std::uint8_t kPilotBase = mavlink::mode_custom_enabled | mavlink::mode_stabilize_enabled |
                                    mavlink::mode_manual_input_enabled;
constexpr std::uint8_t kGuidedBase = kPilotBase | mavlink::mode_guided_enabled;

models::Hexarotor at_start(const EmulatorConfig& config) {
  const models::HexarotorParams params = models::firefly();
  models::RigidBodyState state;
  state.position_m = ned_from_enu(
      {config.start.x_m, config.start.y_m, config.airborne ? config.height_m : kParkedHeight_m});
  state.attitude = attitude_from({.yaw_rad = yaw_from_heading(config.start.heading_rad)});
  models::Hexarotor aircraft{params, state};
  if (config.airborne) {
    models::RotorSpeeds hover{};
    hover.fill(models::hover_speed_radps(params));
    aircraft.set_speeds(hover);
  }
  return aircraft;
}

autopilot::CopterParams params_of(const EmulatorConfig& config) {
  autopilot::CopterParams p;
  p.speed_mps = config.airspeed_mps;
  p.tuning.climb_max_mps = p.tuning.sink_max_mps = config.climb_mps;
  // ArduCopter's own: PSC_POSXY_P, PSC_VELXY_P.
  p.tuning.position_gain_per_s = 1.0;
  p.tuning.velocity_gain_per_s = 2.0;
  p.companion_failsafe = config.companion_failsafe;
  return p;
}

template <class Target>
Vec3 velocity_of(const Target& t) {
  return {static_cast<double>(t.vx), static_cast<double>(t.vy), static_cast<double>(t.vz)};
}

/// All of a target but its position. A vector is ignored with any one of its bits.
template <class Target>
autopilot::PositionTarget motion_of(const Target& t) {
  autopilot::PositionTarget out;
  if ((t.type_mask & kIgnoreVelocity) == 0) out.velocity_mps = velocity_of(t);
  if ((t.type_mask & kIgnoreAcceleration) == 0) {
    out.acceleration_mps2 =
        Vec3{static_cast<double>(t.afx), static_cast<double>(t.afy), static_cast<double>(t.afz)};
  }
  if ((t.type_mask & mavlink::ignore_yaw) == 0) out.yaw_rad = static_cast<double>(t.yaw);
  if ((t.type_mask & mavlink::ignore_yaw_rate) == 0) {
    out.yaw_rate_radps = static_cast<double>(t.yaw_rate);
  }
  return out;
}

}  // namespace

CopterVehicle::CopterVehicle(const EmulatorConfig& config, const Earth& earth, Instant now)
    : AutopilotVehicle{config, earth, params_of(config), now},
      ekf_origin_m_{report_.home_m},
      aircraft_{at_start(config)},
      params_{params_of(config)},
      rotors_{aircraft_.speeds_radps()} {
  sense(aircraft_);
  const auto mode = autopilot::copter_mode(mode_named(config.airframe, config.mode).value_or(0));
  start_autopilot(now, config.airborne, mode.value_or(CopterMode::stabilize));
}

void CopterVehicle::start_autopilot(Instant now, bool in_flight, CopterMode mode) {
  autopilot_ = autopilot::CopterAutopilot{params_};
  autopilot_.set_health(health_);
  if (!in_flight) {
    (void)autopilot_.step(report_.estimate, now);
    tell();
    return;
  }
  // Its home is on the ground below; in the air its thrust tells it that it flies.
  autopilot::Estimate below = report_.estimate;
  below.position_m.z() = 0.0;
  Instant t = now - kPeriodsToKnow * period();
  (void)autopilot_.step(below, t);
  (void)autopilot_.arm();
  report_.home_m = below.position_m;
  autopilot_.set_sticks({.throttle = kStickMiddle});
  for (int i = 0; i < kPeriodsToKnow; ++i) {
    t += period();
    (void)autopilot_.step(report_.estimate, t);
  }
  (void)autopilot_.select_mode(mode);
  while (autopilot_.poll_notice()) continue;
  tell();
}

void CopterVehicle::restart(Instant now) {
  start_autopilot(now, report_.flying, CopterMode::loiter);
}

void CopterVehicle::coast(Instant now) {
  fly_until(now, period(), [this](double seconds) {
    air_.step(aircraft_.state(), seconds);
    aircraft_.step(rotors_, air_.wind_ned_mps(), seconds);
  });
}

void CopterVehicle::control(Instant now) {
  coast(now);
  sense(aircraft_);
  if (!held(now)) {
    autopilot_.set_sticks({.throttle = report_.flying ? kStickMiddle : 0.0});
    const autopilot::RotorCommand command = autopilot_.step(report_.estimate, now);
    for (std::size_t i = 0; i < rotors_.size(); ++i) {
      rotors_.at(i) = aircraft_.params().speed_max_radps * std::sqrt(command.thrust.at(i));
    }
  }
  tell();
}

void CopterVehicle::tell() {
  const autopilot::CopterStatus& status = autopilot_.status();
  const CopterMode mode = autopilot_.mode();
  report_.wind_ned_mps = air_.estimated_ned_mps();
  report_.throttle = status.thrust;
  report_.armed = autopilot_.armed();
  report_.flying = status.flying;
  braking_ = braking_ && mode == CopterMode::loiter;
  report_.mode = braking_ ? kBrake : static_cast<std::uint32_t>(mode);
  report_.base_mode =
      mode == CopterMode::stabilize || mode == CopterMode::land ? kPilotBase : kGuidedBase;
  report_.goal_m = status.goal_m;
}

autopilot::CommandResult CopterVehicle::select_mode(std::uint32_t number) {
  const auto mode = autopilot::copter_mode(
      number == kBrake ? static_cast<std::uint32_t>(CopterMode::loiter) : number);
  const auto result = mode ? autopilot_.select_mode(*mode) : autopilot::CommandResult::failed;
  if (result == autopilot::CommandResult::accepted) braking_ = number == kBrake;
  tell();
  return result;
}

CommandResult CopterVehicle::command(const mavlink::CommandInt& c) {
  using mavlink::Command;
  const auto enter = [this](CopterMode mode) {
    return on_wire(select_mode(static_cast<std::uint32_t>(mode)));
  };
  switch (static_cast<Command>(c.command)) {
    case Command::nav_takeoff:
      return take_off(c);
    case Command::do_reposition:
      return reposition(c);
    case Command::do_change_speed:
      return on_wire(autopilot_.change_speed(static_cast<double>(c.param2)));
    case Command::nav_land:
      return enter(CopterMode::land);
    case Command::nav_return_to_launch:
      return enter(CopterMode::rtl);
    case Command::nav_loiter_unlim:
      return enter(CopterMode::loiter);
    default:
      return CommandResult::unsupported;
  }
}

CommandResult CopterVehicle::take_off(const mavlink::CommandInt& c) {
  const auto down = down_of(static_cast<double>(c.z), c.frame, earth_, report_.home_m);
  if (!down) return CommandResult::denied;
  return on_wire(autopilot_.take_off(-*down));
}

CommandResult CopterVehicle::reposition(const mavlink::CommandInt& c) {
  const auto down = down_of(static_cast<double>(c.z), c.frame, earth_, report_.home_m);
  if (!down) return CommandResult::denied;
  const auto place = earth_.ned({c.x, c.y, earth_.origin_height_m() - *down});
  if (!place) return CommandResult::denied;
  const bool change_mode =
      c.param2 > 0.0F && c.param2 < 256.0F && (static_cast<unsigned>(c.param2) & kChangeMode) != 0;
  std::optional<double> speed;
  if (c.param1 > 0.0F) speed = static_cast<double>(c.param1);
  const auto result = autopilot_.reposition(*place, speed, change_mode);
  tell();
  return on_wire(result);
}

void CopterVehicle::on_attitude_target(const mavlink::SetAttitudeTarget& target, Instant now) {
  // ArduCopter needs attitude and thrust, or it does nothing.
  if ((target.type_mask & (mavlink::ignore_attitude | mavlink::ignore_thrust)) != 0) return;
  const Eigen::Quaterniond q{static_cast<double>(target.q[0]), static_cast<double>(target.q[1]),
                             static_cast<double>(target.q[2]), static_cast<double>(target.q[3])};
  if (!q.coeffs().allFinite() || !(q.norm() > 0.5)) return;
  const EulerAngles angles = euler_angles(q.normalized());
  autopilot::CopterAttitudeTarget wanted{
      .roll_rad = angles.roll_rad,
      .pitch_rad = angles.pitch_rad,
      .yaw_rad = angles.yaw_rad,
      .climb = std::clamp(static_cast<double>(target.thrust), 0.0, 1.0),
  };
  if ((target.type_mask & mavlink::ignore_body_yaw_rate) == 0) {
    wanted.yaw_rad.reset();
    wanted.yaw_rate_radps = static_cast<double>(target.body_yaw_rate);
  }
  (void)autopilot_.attitude_target(wanted, now);
}

void CopterVehicle::on_position_target(const mavlink::SetPositionTargetLocalNed& target,
                                       Instant now) {
  const auto frame = static_cast<mavlink::Frame>(target.coordinate_frame);
  if (frame != mavlink::Frame::local_ned && frame != mavlink::Frame::local_offset_ned) return;
  autopilot::PositionTarget wanted = motion_of(target);
  if ((target.type_mask & kIgnorePosition) == 0) {
    const Vec3& from =
        frame == mavlink::Frame::local_ned ? ekf_origin_m_ : report_.estimate.position_m;
    wanted.position_m = from + Vec3{static_cast<double>(target.x), static_cast<double>(target.y),
                                    static_cast<double>(target.z)};
  }
  (void)autopilot_.position_target(wanted, now);
}

void CopterVehicle::on_position_target(const mavlink::SetPositionTargetGlobalInt& target,
                                       Instant now) {
  autopilot::PositionTarget wanted = motion_of(target);
  // ArduCopter 4.6 heeds an acceleration with a local position only.
  wanted.acceleration_mps2.reset();
  if ((target.type_mask & kIgnorePosition) == 0) {
    const auto down =
        down_of(static_cast<double>(target.alt), target.coordinate_frame, earth_, report_.home_m);
    if (!down) return;
    wanted.position_m =
        earth_.ned({target.lat_int, target.lon_int, earth_.origin_height_m() - *down});
    if (!wanted.position_m) return;
  }
  (void)autopilot_.position_target(wanted, now);
}

}  // namespace skein::hil
