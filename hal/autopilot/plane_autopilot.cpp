// SPDX-License-Identifier: Apache-2.0
#include "skein/autopilot/plane_autopilot.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "skein/base/angles.hpp"

namespace skein::autopilot {
namespace {

/// Below this share of the least airspeed, or height above home, it does not fly.
constexpr double kFlyingAirspeedShare = 0.7;
constexpr double kFlyingHeight_m = 3.0;
/// A quadplane on its rotors.
constexpr double kLifted_m = 0.5;

double clamped_steer(double lateral_mps2, double limit_mps2) {
  return limit_mps2 > 0.0 ? std::clamp(lateral_mps2, -limit_mps2, limit_mps2) : lateral_mps2;
}

/// Moves towards the goal, at once where the rate is 0.
double slewed(double value, double goal, double rate, double seconds) {
  if (rate <= 0.0) return goal;
  return value + std::clamp(goal - value, -rate * seconds, rate * seconds);
}

}  // namespace

PlaneAutopilot::PlaneAutopilot(const PlaneParams& params)
    : params_{params},
      loops_{params.tuning},
      companion_{params.companion_failsafe, params.companion_timeout},
      airspeed_mps_{params.tuning.airspeed_cruise_mps} {
  if (params.vtol) vtol_.emplace(*params.vtol);
}

ModeFacts PlaneAutopilot::facts() const {
  return {.position = health_.position, .mission = !mission_.empty(), .rotors = vtol_.has_value()};
}

void PlaneAutopilot::say(Severity severity, std::string text) {
  (void)notices_.push({severity, std::move(text)});
}

bool PlaneAutopilot::change(PlaneEvent event) {
  if (!machine_.fire(event, facts())) return false;
  enter();
  return true;
}

void PlaneAutopilot::enter() {
  orbit_ = {.centre_m = estimate_.position_m.head<2>(),
            .radius_m = params_.loiter_radius_m,
            .clockwise = true};
  height_m_ = estimate_.height_m();
  airspeed_mps_ = params_.tuning.airspeed_cruise_mps;
  heading_.reset();
  speed_slew_.reset();
  height_slew_.reset();
  attitude_.reset();
  takeoff_course_rad_ = euler_angles(estimate_.attitude).yaw_rad;
  if (mode() == PlaneMode::rtl) orbit_.centre_m = home_m_;
  if (vtol_) enter_vtol();
  if (mode() == PlaneMode::mission) begin_item();
}

CommandResult PlaneAutopilot::select_mode(PlaneMode mode) {
  if (mode == machine_.mode()) return CommandResult::accepted;
  if (change(selection_of(mode))) return CommandResult::accepted;
  const std::string_view why = needs_rotors(mode) && !vtol_ ? " needs Q_ENABLE"
                               : health_.position           ? " needs a mission"
                                                            : " requires position";
  say(Severity::warning,
      "Flight mode change failed: " + std::string{to_string(mode)} + std::string{why});
  return CommandResult::failed;
}

std::optional<std::string_view> PlaneAutopilot::mode_refusal() const {
  if (mode() == PlaneMode::rtl) return kRtlNotArmable;
  if (mode() == PlaneMode::q_rtl) return kQrtlNotArmable;
  if (mode() == PlaneMode::q_land) return kQlandNotArmable;
  const bool landing = mode() == PlaneMode::mission && item_ < mission_.size() &&
                       (mission_[item_].kind == MissionItem::Kind::land ||
                        mission_[item_].kind == MissionItem::Kind::vtol_land);
  return landing ? std::optional{kLandingSequence} : std::nullopt;
}

CommandResult PlaneAutopilot::arm() {
  if (armed_) return CommandResult::accepted;
  auto refusal = mode_refusal();
  if (!refusal) refusal = arming_refusal(health_);
  if (refusal) {
    say(Severity::critical, "Arm: " + std::string{*refusal});
    return CommandResult::failed;
  }
  armed_ = true;
  loops_.reset();
  home_m_ = estimate_.position_m.head<2>();
  home_height_m_ = flying_ ? 0.0 : estimate_.height_m();
  takeoff_course_rad_ = euler_angles(estimate_.attitude).yaw_rad;
  if (mode() == PlaneMode::mission) begin_item();
  say(Severity::info, "Throttle armed");
  return CommandResult::accepted;
}

CommandResult PlaneAutopilot::disarm(bool force) {
  if (!armed_) return CommandResult::accepted;
  if (flying_ && !force) return CommandResult::failed;
  armed_ = false;
  if (vtol_) vtol_->stop();
  say(Severity::info, "Throttle disarmed");
  return CommandResult::accepted;
}

bool PlaneAutopilot::valid_airspeed(double airspeed_mps) const {
  // Written so that a number that is none fails.
  return airspeed_mps >= params_.tuning.airspeed_min_mps &&
         airspeed_mps <= params_.tuning.airspeed_max_mps;
}

CommandResult PlaneAutopilot::reposition(const Reposition& target) {
  if (!target.centre_m.allFinite() || !std::isfinite(target.height_m.value_or(0.0)) ||
      !(target.radius_m >= 0.0)) {
    return CommandResult::denied;
  }
  if (target.airspeed_mps && !valid_airspeed(*target.airspeed_mps)) return CommandResult::denied;
  if (mode() != PlaneMode::guided) {
    if (!target.change_mode) return CommandResult::denied;
    if (!change(PlaneEvent::select_guided)) return CommandResult::failed;
  }
  orbit_ = {.centre_m = target.centre_m,
            .radius_m = target.radius_m > 0.0 ? target.radius_m : params_.loiter_radius_m,
            .clockwise = target.clockwise};
  if (target.height_m) height_m_ = *target.height_m;
  if (vtol_ && flying_) vtol_->fly_on_wings(estimate_);
  if (target.airspeed_mps) airspeed_mps_ = *target.airspeed_mps;
  return CommandResult::accepted;
}

CommandResult PlaneAutopilot::guided_heading(HeadingKind kind, double from_north_rad,
                                             double lateral_mps2) {
  if (mode() != PlaneMode::guided) return CommandResult::failed;
  if (!std::isfinite(from_north_rad) || !(lateral_mps2 >= 0.0)) return CommandResult::denied;
  heading_ = Heading{kind, from_north_rad, lateral_mps2};
  return CommandResult::accepted;
}

CommandResult PlaneAutopilot::guided_speed(double airspeed_mps, double acceleration_mps2) {
  if (mode() != PlaneMode::guided) return CommandResult::failed;
  if (!valid_airspeed(airspeed_mps) || !(acceleration_mps2 >= 0.0)) return CommandResult::denied;
  if (!speed_slew_) slewed_airspeed_mps_ = airspeed_mps_;
  speed_slew_ = Slew{airspeed_mps, acceleration_mps2};
  return CommandResult::accepted;
}

CommandResult PlaneAutopilot::guided_height(double height_m, double rate_mps) {
  if (mode() != PlaneMode::guided) return CommandResult::failed;
  if (!std::isfinite(height_m) || !(rate_mps >= 0.0)) return CommandResult::denied;
  if (!height_slew_) slewed_height_m_ = height_m_;
  height_slew_ = Slew{height_m, rate_mps};
  return CommandResult::accepted;
}

CommandResult PlaneAutopilot::change_speed(double airspeed_mps) {
  if (!valid_airspeed(airspeed_mps)) return CommandResult::denied;
  airspeed_mps_ = airspeed_mps;
  return CommandResult::accepted;
}

CommandResult PlaneAutopilot::change_height(double height_m) {
  if (!std::isfinite(height_m)) return CommandResult::denied;
  if (mode() != PlaneMode::guided && mode() != PlaneMode::loiter) return CommandResult::failed;
  height_m_ = height_m;
  return CommandResult::accepted;
}

CommandResult PlaneAutopilot::attitude_target(const AttitudeTarget& target, Instant now) {
  if (mode() != PlaneMode::guided) return CommandResult::failed;
  if (!std::isfinite(target.roll_rad.value_or(0.0)) ||
      !std::isfinite(target.pitch_rad.value_or(0.0)) ||
      !std::isfinite(target.throttle.value_or(0.0))) {
    return CommandResult::denied;
  }
  attitude_ = target;
  attitude_until_ = now + params_.setpoint_timeout;
  return CommandResult::accepted;
}

CommandResult PlaneAutopilot::load_mission(std::span<const MissionItem> items) {
  if (items.empty() || items.size() > kMissionMax) return CommandResult::denied;
  for (const MissionItem& item : items) {
    if (!std::isfinite(item.north_m) || !std::isfinite(item.east_m) ||
        !std::isfinite(item.height_m) || !std::isfinite(item.radius_m) ||
        (item.kind == MissionItem::Kind::change_speed && !valid_airspeed(item.airspeed_mps))) {
      return CommandResult::denied;
    }
  }
  mission_.clear();
  for (const MissionItem& item : items) mission_.push_back(item);
  item_ = 0;
  if (mode() == PlaneMode::mission) begin_item();
  return CommandResult::accepted;
}

CommandResult PlaneAutopilot::set_mission_item(std::size_t index) {
  if (index >= mission_.size()) return CommandResult::denied;
  item_ = index;
  if (mode() == PlaneMode::mission) begin_item();
  return CommandResult::accepted;
}

void PlaneAutopilot::watch_flight(const Estimate& estimate) {
  const double above_m = estimate.height_m() - home_height_m_;
  if (vtol_ && vtol_->carries()) {
    flying_ = flying_ || above_m > kLifted_m;
  } else if (!flying_) {
    flying_ = estimate.airspeed_mps > kFlyingAirspeedShare * params_.tuning.airspeed_min_mps &&
              above_m > kFlyingHeight_m;
  } else if (above_m < kFlyingHeight_m && estimate.groundspeed_mps() < 3.0) {
    flying_ = false;
  }
}

SurfaceCommand PlaneAutopilot::step(const Estimate& estimate, Instant now) {
  const double seconds = last_step_ ? std::clamp(to_seconds(now - *last_step_), 0.002, 0.1) : 0.02;
  last_step_ = now;
  estimate_ = estimate;
  watch_flight(estimate);
  if (companion_.lost_now(now) && change(PlaneEvent::companion_lost)) {
    say(Severity::warning, "GCS Failsafe On: switched to " + std::string{to_string(mode())});
  }
  SurfaceCommand command;
  if (armed_) {
    command = fly_mode(estimate, now, seconds);
  } else if (mode() == PlaneMode::manual) {
    command = fly_sticks(estimate, seconds);
  }
  if (!armed_) command.throttle = 0.0;
  status_.flying = flying_;
  status_.roll_rad = loops_.roll_demand_rad();
  status_.pitch_rad = loops_.pitch_demand_rad();
  status_.distance_m = (status_.goal_m - estimate.position_m.head<2>()).norm();
  status_.mission_item = item_;
  return command;
}

SurfaceCommand PlaneAutopilot::fly_mode(const Estimate& estimate, Instant now, double seconds) {
  if (vtol_ && vtol_->carries()) {
    const SurfaceCommand command = vtol_->step(estimate, loops_, seconds);
    if (vtol_->touched_down()) {
      flying_ = false;
      say(Severity::info, "Land complete");
      (void)disarm(false);
    }
    return command;
  }
  if (vtol_) vtol_->fade(seconds);
  switch (mode()) {
    case PlaneMode::manual:
    case PlaneMode::fbwa:
      break;
    case PlaneMode::guided:
      return fly_guided(estimate, now, seconds);
    case PlaneMode::mission:
      return fly_mission(estimate, seconds);
    case PlaneMode::loiter:
      return orbit(estimate, orbit_, height_m_, seconds);
    case PlaneMode::rtl:
      return orbit(estimate, orbit_, home_height_m_ + params_.rtl_height_m, seconds);
    case PlaneMode::q_rtl:
      if (!flying_) break;
      return set_down(estimate, home_m_, home_height_m_, seconds);
    case PlaneMode::q_loiter:
    case PlaneMode::q_land:
      break;
    case PlaneMode::takeoff: {
      const double height_m = home_height_m_ + params_.takeoff_height_m;
      if (!flying_ || estimate.height_m() < height_m - 5.0) {
        orbit_.centre_m = estimate.position_m.head<2>();  // it circles where it gets up
        return take_off(estimate, height_m, seconds);
      }
      return orbit(estimate, orbit_, height_m, seconds);
    }
  }
  return fly_sticks(estimate, seconds);
}

SurfaceCommand PlaneAutopilot::fly_sticks(const Estimate& estimate, double seconds) {
  const FixedWingTuning& t = params_.tuning;
  if (mode() == PlaneMode::fbwa) {
    const double pitch = sticks_.pitch * (sticks_.pitch > 0.0 ? t.pitch_max_rad : -t.pitch_min_rad);
    return loops_.hold_attitude(estimate, sticks_.roll * t.roll_max_rad, pitch, sticks_.throttle,
                                seconds);
  }
  return {.elevator_rad = -sticks_.pitch * t.surface_max_rad,
          .aileron_rad = sticks_.roll * t.surface_max_rad,
          .rudder_rad = -sticks_.yaw * t.surface_max_rad,
          .throttle = std::clamp(sticks_.throttle, 0.0, t.throttle_max)};
}

SurfaceCommand PlaneAutopilot::cruise(const Estimate& estimate, double lateral_mps2,
                                      double height_m, double airspeed_mps, double seconds) {
  status_.height_m = height_m;
  status_.airspeed_mps = airspeed_mps;
  if (!flying_) {
    // On the ground only a takeoff may open the throttle.
    loops_.reset();
    return {};
  }
  return loops_.fly(
      estimate, {.lateral_mps2 = lateral_mps2, .height_m = height_m, .airspeed_mps = airspeed_mps},
      seconds);
}

SurfaceCommand PlaneAutopilot::orbit(const Estimate& estimate, const Orbit& orbit, double height_m,
                                     double seconds) {
  status_.goal_m = orbit.centre_m;
  return cruise(estimate, steer_to_orbit(estimate, orbit, params_.tuning.heading_gain_per_s),
                height_m, airspeed_mps_, seconds);
}

SurfaceCommand PlaneAutopilot::fly_guided(const Estimate& estimate, Instant now, double seconds) {
  const double gain = params_.tuning.heading_gain_per_s;
  double airspeed = airspeed_mps_;
  if (speed_slew_) {
    slewed_airspeed_mps_ =
        slewed(slewed_airspeed_mps_, speed_slew_->goal, speed_slew_->rate, seconds);
    airspeed = slewed_airspeed_mps_;
  }
  double height = height_m_;
  if (height_slew_) {
    slewed_height_m_ = slewed(slewed_height_m_, height_slew_->goal, height_slew_->rate, seconds);
    height = slewed_height_m_;
  }
  if (attitude_ && now >= attitude_until_) attitude_.reset();
  if (attitude_ && flying_) {
    const double roll = attitude_->roll_rad.value_or(0.0);
    if (!attitude_->pitch_rad) {
      return loops_.hold_roll(estimate, roll, height, airspeed, seconds);
    }
    return loops_.hold_attitude(estimate, roll, *attitude_->pitch_rad,
                                attitude_->throttle.value_or(params_.tuning.throttle_level),
                                seconds);
  }
  status_.goal_m = orbit_.centre_m;
  double lateral = 0.0;
  if (!heading_) {
    lateral = steer_to_orbit(estimate, orbit_, gain);
  } else if (heading_->kind == HeadingKind::course) {
    lateral = clamped_steer(steer_to_course(estimate, heading_->from_north_rad, gain),
                            heading_->lateral_mps2);
  } else {
    lateral = clamped_steer(steer_to_heading(estimate, heading_->from_north_rad, gain),
                            heading_->lateral_mps2);
  }
  return cruise(estimate, lateral, height, airspeed, seconds);
}

SurfaceCommand PlaneAutopilot::take_off(const Estimate& estimate, double height_m, double seconds) {
  const FixedWingTuning& t = params_.tuning;
  status_.height_m = height_m;
  status_.airspeed_mps = airspeed_mps_;
  if (flying_ && estimate.height_m() - home_height_m_ > 3.0 * kFlyingHeight_m) {
    // Up: it climbs as always, on the course of its start.
    return cruise(estimate, steer_to_course(estimate, takeoff_course_rad_, t.heading_gain_per_s),
                  height_m + t.climb_max_mps * t.height_time_s, airspeed_mps_, seconds);
  }
  const bool rotate = estimate.airspeed_mps > params_.rotate_airspeed_mps;
  if (!rotate) loops_.reset();
  SurfaceCommand command = loops_.hold_attitude(
      estimate, 0.0, rotate ? params_.takeoff_pitch_rad : 0.0, t.throttle_max, seconds);
  if (!rotate) {
    command.elevator_rad = 0.0;
    command.rudder_rad = ground_steering_rad(estimate, takeoff_course_rad_, t.surface_max_rad);
  }
  return command;
}

}  // namespace skein::autopilot
