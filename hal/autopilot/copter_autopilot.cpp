// SPDX-License-Identifier: Apache-2.0
#include "skein/autopilot/copter_autopilot.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "skein/base/angles.hpp"

namespace skein::autopilot {
namespace {

constexpr double kIdleThrust = 0.03;
constexpr double kReached_m = 1.0;
constexpr double kLoiterSpeed_mps = 5.0;
constexpr double kLoiterClimb_mps = 2.0;
constexpr double kStickYawRate_radps = 1.5;
constexpr double kStill_mps = 0.3;
constexpr double kClimbFilter_s = 0.2;
constexpr double kResting_s = 1.5;

bool finite(const std::optional<Vec3>& v) { return !v || v->allFinite(); }
bool finite(const std::optional<double>& v) { return !v || std::isfinite(*v); }

double yaw_of(const Estimate& estimate) { return euler_angles(estimate.attitude).yaw_rad; }

/// A stick with a dead band in the middle.
double deflection(double stick) {
  constexpr double kDead = 0.05;
  if (std::abs(stick) < kDead) return 0.0;
  return std::copysign((std::min(std::abs(stick), 1.0) - kDead) / (1.0 - kDead), stick);
}

}  // namespace

CopterAutopilot::CopterAutopilot(const CopterParams& params)
    : params_{params},
      loops_{params.tuning},
      companion_{params.companion_failsafe, params.companion_timeout} {}

void CopterAutopilot::say(Severity severity, std::string text) {
  (void)notices_.push({severity, std::move(text)});
}

bool CopterAutopilot::change(CopterEvent event) {
  if (!machine_.fire(event, facts())) return false;
  enter();
  return true;
}

void CopterAutopilot::hold_here() {
  motion_ = {.horizontal_m = Vec2{estimate_.position_m.head<2>()},
             .down_m = estimate_.position_m.z(),
             .yaw_rad = yaw_of(estimate_)};
  motion_ends_ = false;
}

void CopterAutopilot::enter() {
  hold_here();
  guided_ = flying_ ? Guided::brake : Guided::hold;
  return_ = Return::climb;
  return_down_m_ = std::min(estimate_.position_m.z(), home_m_.z() - params_.rtl_height_m);
}

CommandResult CopterAutopilot::select_mode(CopterMode mode) {
  if (mode == machine_.mode()) return CommandResult::accepted;
  if (change(selection_of(mode))) return CommandResult::accepted;
  say(Severity::warning,
      "Mode change to " + std::string{to_string(mode)} + " failed: requires position");
  return CommandResult::failed;
}

CommandResult CopterAutopilot::arm() {
  if (armed_) return CommandResult::accepted;
  const bool armable = mode() != CopterMode::rtl && mode() != CopterMode::land;
  const auto refusal =
      armable ? arming_refusal(health_) : std::optional<std::string_view>{"Mode not armable"};
  if (refusal) {
    say(Severity::critical, "Arm: " + std::string{*refusal});
    return CommandResult::failed;
  }
  armed_ = true;
  resting_s_ = 0.0;
  loops_.reset();
  home_m_ = estimate_.position_m;
  enter();
  say(Severity::info, "Arming motors");
  return CommandResult::accepted;
}

CommandResult CopterAutopilot::disarm(bool force) {
  if (!armed_) return CommandResult::accepted;
  if (flying_ && !force) return CommandResult::failed;
  stop_motors();
  return CommandResult::accepted;
}

void CopterAutopilot::stop_motors() {
  armed_ = false;
  flying_ = false;
  say(Severity::info, "Disarming motors");
}

CommandResult CopterAutopilot::take_off(double height_m) {
  if (!std::isfinite(height_m) || height_m <= estimate_.height_m()) return CommandResult::denied;
  if (!armed_ || flying_ || mode() != CopterMode::guided) return CommandResult::failed;
  hold_here();
  guided_ = Guided::take_off;
  takeoff_height_m_ = height_m;
  return CommandResult::accepted;
}

CommandResult CopterAutopilot::position_target(const PositionTarget& target, Instant now) {
  if (mode() != CopterMode::guided) return CommandResult::failed;
  if (!finite(target.position_m) || !finite(target.velocity_mps) ||
      !finite(target.acceleration_mps2) || !finite(target.yaw_rad) ||
      !finite(target.yaw_rate_radps) || (!target.position_m && !target.velocity_mps)) {
    return CommandResult::denied;
  }
  if (!flying_ || guided_ == Guided::take_off) return CommandResult::temporarily_rejected;
  const double yaw = motion_.yaw_rad;
  motion_ = {};
  if (target.position_m) {
    motion_.horizontal_m = Vec2{target.position_m->head<2>()};
    motion_.down_m = target.position_m->z();
  }
  motion_.velocity_mps = target.velocity_mps.value_or(Vec3{Vec3::Zero()});
  motion_.acceleration_mps2 = target.acceleration_mps2.value_or(Vec3{Vec3::Zero()});
  motion_.yaw_rad = target.yaw_rad.value_or(yaw);
  motion_.yaw_rate_radps = target.yaw_rate_radps.value_or(0.0);
  motion_.speed_max_mps = params_.speed_mps;
  motion_ends_ = target.velocity_mps.has_value();
  motion_until_ = now + params_.setpoint_timeout;
  guided_ = Guided::motion;
  return CommandResult::accepted;
}

CommandResult CopterAutopilot::attitude_target(const CopterAttitudeTarget& target, Instant now) {
  if (mode() != CopterMode::guided) return CommandResult::failed;
  if (!std::isfinite(target.roll_rad) || !std::isfinite(target.pitch_rad) ||
      !finite(target.yaw_rad) || !std::isfinite(target.yaw_rate_radps) ||
      !(target.climb >= 0.0 && target.climb <= 1.0)) {
    return CommandResult::denied;
  }
  if (!flying_ || guided_ == Guided::take_off) return CommandResult::temporarily_rejected;
  if (guided_ != Guided::attitude) motion_.yaw_rad = yaw_of(estimate_);
  attitude_ = target;
  motion_until_ = now + params_.setpoint_timeout;
  guided_ = Guided::attitude;
  return CommandResult::accepted;
}

CommandResult CopterAutopilot::reposition(const Vec3& position_m, std::optional<double> speed_mps,
                                          bool change_mode) {
  if (!position_m.allFinite() || !(speed_mps.value_or(1.0) > 0.0)) return CommandResult::denied;
  if (mode() != CopterMode::guided) {
    if (!change_mode) return CommandResult::denied;
    if (!change(CopterEvent::select_guided)) return CommandResult::failed;
  }
  if (!flying_ || guided_ == Guided::take_off) return CommandResult::temporarily_rejected;
  const double yaw = motion_.yaw_rad;
  motion_ = {.horizontal_m = Vec2{position_m.head<2>()},
             .down_m = position_m.z(),
             .yaw_rad = yaw,
             .speed_max_mps = speed_mps.value_or(params_.speed_mps)};
  motion_ends_ = false;
  guided_ = Guided::motion;
  return CommandResult::accepted;
}

CommandResult CopterAutopilot::change_speed(double speed_mps) {
  if (!(speed_mps > 0.0) || !std::isfinite(speed_mps)) return CommandResult::denied;
  motion_.speed_max_mps = speed_mps;
  return CommandResult::accepted;
}

RotorCommand CopterAutopilot::step(const Estimate& estimate, Instant now) {
  const double seconds =
      last_step_ ? std::clamp(to_seconds(now - *last_step_), 0.001, 0.02) : 0.0025;
  last_step_ = now;
  estimate_ = estimate;
  if (companion_.lost_now(now) && armed_ && change(CopterEvent::companion_lost)) {
    say(Severity::warning, "GCS Failsafe: switched to " + std::string{to_string(mode())});
  }
  if (armed_ && !health_.position && change(CopterEvent::position_lost)) {
    say(Severity::critical, "EKF Failsafe: switched to " + std::string{to_string(mode())});
  }
  RotorCommand command;
  sink_wanted_mps_ = 0.0;
  if (armed_) {
    command = fly_mode(now, seconds);
    status_.thrust = command.mean();
    watch_landing(seconds);
    if (!armed_) command = {};
  }
  if (!armed_) status_.thrust = 0.0;
  status_.flying = flying_;
  status_.yaw_rad = motion_.yaw_rad;
  const Vec2 goal = motion_.horizontal_m.value_or(Vec2{estimate.position_m.head<2>()});
  status_.goal_m << goal, motion_.down_m.value_or(estimate.position_m.z());
  return command;
}

void CopterAutopilot::watch_landing(double seconds) {
  const double hover = loops_.hover_thrust();
  const bool lifted = status_.thrust > 0.7 * hover && estimate_.height_m() + home_m_.z() > 0.3;
  lifted_s_ = lifted ? lifted_s_ + seconds : 0.0;
  if (lifted_s_ > 0.1) flying_ = true;
  // It wants down and does not sink, or hardly lifts and does not fall.
  climb_mps_ += std::min(1.0, seconds / kClimbFilter_s) * (estimate_.climb_mps() - climb_mps_);
  const bool pushes_down = sink_wanted_mps_ > 0.0 || status_.thrust < 0.5 * hover;
  const bool resting = pushes_down && std::abs(climb_mps_) < 0.4 * params_.land_speed_mps;
  resting_s_ = resting ? resting_s_ + seconds : 0.0;
  if (!flying_ || resting_s_ < kResting_s) return;
  flying_ = false;
  if (mode() == CopterMode::land || mode() == CopterMode::rtl) {
    say(Severity::info, "Landed");
    stop_motors();
  } else {
    enter();
  }
}

RotorCommand CopterAutopilot::fly_mode(Instant now, double seconds) {
  switch (mode()) {
    case CopterMode::guided:
      return fly_guided(now, seconds);
    case CopterMode::rtl:
      return fly_home(seconds);
    case CopterMode::land:
      return descend(seconds);
    case CopterMode::stabilize:
    case CopterMode::loiter:
      break;
  }
  return fly_sticks(seconds);
}

RotorCommand CopterAutopilot::follow(const MotionDemand& demand, double seconds) {
  return loops_.fly(estimate_, demand, seconds);
}

RotorCommand CopterAutopilot::fly_sticks(double seconds) {
  const double yaw_rate = kStickYawRate_radps * deflection(sticks_.yaw);
  motion_.yaw_rad = wrap_pi(motion_.yaw_rad + yaw_rate * seconds);
  motion_.yaw_rate_radps = yaw_rate;
  if (mode() == CopterMode::stabilize) {
    if (sticks_.throttle < 0.02) {
      loops_.reset();
      motion_.yaw_rad = yaw_of(estimate_);
      return {
          .thrust = {kIdleThrust, kIdleThrust, kIdleThrust, kIdleThrust, kIdleThrust, kIdleThrust}};
    }
    // The middle of the stick hovers.
    const double hover = loops_.hover_thrust();
    const double stick = std::clamp(sticks_.throttle, 0.0, 1.0);
    const double thrust =
        stick < 0.5 ? 2.0 * stick * hover : hover + (2.0 * stick - 1.0) * (1.0 - hover);
    const double tilt = params_.tuning.tilt_max_rad;
    return loops_.hold_attitude(estimate_, tilt * deflection(sticks_.roll),
                                tilt * deflection(sticks_.pitch), motion_.yaw_rad, yaw_rate, thrust,
                                seconds);
  }
  const double climb = kLoiterClimb_mps * deflection(2.0 * sticks_.throttle - 1.0);
  if (!flying_ && climb <= 0.0) {
    loops_.reset();
    hold_here();
    return {
        .thrust = {kIdleThrust, kIdleThrust, kIdleThrust, kIdleThrust, kIdleThrust, kIdleThrust}};
  }
  const double yaw = yaw_of(estimate_);
  const Vec2 body = kLoiterSpeed_mps * Vec2{-deflection(sticks_.pitch), deflection(sticks_.roll)};
  motion_.velocity_mps << Eigen::Rotation2Dd{yaw} * body, -climb;
  // Where a stick is in the middle, the place is held at which the vehicle comes to rest.
  if (body.norm() > 0.0) {
    motion_.horizontal_m.reset();
  } else if (!motion_.horizontal_m && estimate_.velocity_mps.head<2>().norm() < kStill_mps) {
    motion_.horizontal_m = Vec2{estimate_.position_m.head<2>()};
  }
  if (climb != 0.0) {
    motion_.down_m.reset();
  } else if (!motion_.down_m && std::abs(estimate_.climb_mps()) < kStill_mps) {
    motion_.down_m = estimate_.position_m.z();
  }
  return follow(motion_, seconds);
}

RotorCommand CopterAutopilot::climb_level(double roll_rad, double pitch_rad, double climb_mps,
                                          double seconds) {
  const EulerAngles angles = euler_angles(estimate_.attitude);
  const double upright = std::max(std::cos(angles.roll_rad) * std::cos(angles.pitch_rad), 0.5);
  const double wanted = params_.tuning.velocity_gain_per_s * (climb_mps - estimate_.climb_mps());
  const double thrust = loops_.hover_thrust() * (1.0 + wanted / kGravity_mps2) / upright;
  return loops_.hold_attitude(estimate_, roll_rad, pitch_rad, motion_.yaw_rad,
                              motion_.yaw_rate_radps, thrust, seconds);
}

RotorCommand CopterAutopilot::fly_guided(Instant now, double seconds) {
  const bool old = now >= motion_until_;
  switch (guided_) {
    case Guided::hold:
      if (flying_) break;
      loops_.reset();
      hold_here();
      return {
          .thrust = {kIdleThrust, kIdleThrust, kIdleThrust, kIdleThrust, kIdleThrust, kIdleThrust}};
    case Guided::take_off:
      motion_.down_m = -takeoff_height_m_;
      if (flying_ && estimate_.height_m() > takeoff_height_m_ - 0.5) guided_ = Guided::hold;
      break;
    case Guided::motion:
      if (!motion_ends_) break;
      if (old) {
        guided_ = Guided::brake;
        break;
      }
      if (motion_.horizontal_m) {
        *motion_.horizontal_m += seconds * motion_.velocity_mps.head<2>();
        *motion_.down_m += seconds * motion_.velocity_mps.z();
      }
      motion_.yaw_rad = wrap_pi(motion_.yaw_rad + seconds * motion_.yaw_rate_radps);
      break;
    case Guided::brake: {
      const MotionDemand stop{.yaw_rad = motion_.yaw_rad};
      if (estimate_.velocity_mps.norm() > kStill_mps) return follow(stop, seconds);
      hold_here();
      guided_ = Guided::hold;
      break;
    }
    case Guided::attitude: {
      if (old) {
        motion_.yaw_rate_radps = 0.0;
        guided_ = Guided::brake;
        return follow({.yaw_rad = motion_.yaw_rad}, seconds);
      }
      motion_.yaw_rate_radps = attitude_.yaw_rate_radps;
      motion_.yaw_rad =
          attitude_.yaw_rad.value_or(wrap_pi(motion_.yaw_rad + seconds * attitude_.yaw_rate_radps));
      const double climb = 2.0 * attitude_.climb - 1.0;
      const double most = climb > 0.0 ? params_.tuning.climb_max_mps : params_.tuning.sink_max_mps;
      return climb_level(attitude_.roll_rad, attitude_.pitch_rad, climb * most, seconds);
    }
  }
  return follow(motion_, seconds);
}

RotorCommand CopterAutopilot::fly_home(double seconds) {
  const Vec2 home = home_m_.head<2>();
  const Vec2 here = estimate_.position_m.head<2>();
  switch (return_) {
    case Return::climb:
      motion_.down_m = return_down_m_;
      if (std::abs(estimate_.position_m.z() - return_down_m_) < kReached_m) return_ = Return::home;
      break;
    case Return::home:
      motion_.horizontal_m = home;
      motion_.speed_max_mps = params_.speed_mps;
      if ((here - home).norm() < kReached_m &&
          estimate_.velocity_mps.head<2>().norm() < kStill_mps) {
        return_ = Return::land;
      }
      break;
    case Return::land:
      return descend(seconds);
  }
  return follow(motion_, seconds);
}

RotorCommand CopterAutopilot::descend(double seconds) {
  const double above_home = estimate_.height_m() + home_m_.z();
  const double sink =
      above_home > params_.land_slow_m ? params_.descent_mps : params_.land_speed_mps;
  sink_wanted_mps_ = sink;
  // Without a position it keeps level and drifts with the wind.
  if (!health_.position) return climb_level(0.0, 0.0, -sink, seconds);
  motion_.down_m.reset();
  motion_.velocity_mps = {0.0, 0.0, sink};
  return follow(motion_, seconds);
}

}  // namespace skein::autopilot
