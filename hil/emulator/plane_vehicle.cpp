// SPDX-License-Identifier: Apache-2.0
#include "plane_vehicle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "skein/base/angles.hpp"
#include "skein/base/assert.hpp"
#include "skein/base/atmosphere.hpp"
#include "skein/base/frames.hpp"

namespace skein::hil {
namespace {

using autopilot::PlaneMode;
using mavlink::CommandResult;

constexpr Duration kModelStep = std::chrono::microseconds{2500};
/// Circles that it flies by itself are wider than its tightest.
constexpr double kLoiterRadii = 1.1;

/// DO_REPOSITION, param2.
constexpr unsigned kChangeMode = 1;
/// ArduPlane takes less for this much.
constexpr float kHeadingAccelerationLeast_mps2 = 0.05F;
/// ArduPlane 4.6 with a rate for GUIDED_CHANGE_ALTITUDE hardly climbs: 0.1 m/s were measured where
/// 3 m/s were asked for.
constexpr double kAltitudeRateShare = 1.0 / 30.0;

/// ArduPlane 4.6.3 was in the air (EXTENDED_SYS_STATE) on its wheels, at 5.3 m/s.
constexpr double kRollsFrom_mps = 5.0;

// HEARTBEAT, base_mode, as ArduPlane sends it.
constexpr std::uint8_t kPilotBase = mavlink::mode_custom_enabled | mavlink::mode_stabilize_enabled |
                                    mavlink::mode_manual_input_enabled;
constexpr std::uint8_t kGuidedBase = kPilotBase | mavlink::mode_guided_enabled;

/// As ArduPlane tells it.
mavlink::VtolState on_wire(std::optional<autopilot::VtolFlight::Carried> by) {
  using Carried = autopilot::VtolFlight::Carried;
  if (!by) return mavlink::VtolState::undefined;
  switch (*by) {
    case Carried::by_rotors:
      return mavlink::VtolState::on_rotors;
    case Carried::to_wings:
      return mavlink::VtolState::to_wings;
    case Carried::to_rotors:
      return mavlink::VtolState::to_rotors;
    case Carried::by_wings:
      break;
  }
  return mavlink::VtolState::on_wings;
}

models::FixedWing at_start(const EmulatorConfig& config, const PlaneAirframe& airframe,
                           const models::Trim& trim) {
  const models::FixedWingParams& params = airframe.model;
  const double yaw = yaw_from_heading(config.start.heading_rad);
  models::RigidBodyState state;
  if (!config.airborne) {
    state.position_m = ned_from_enu({config.start.x_m, config.start.y_m, airframe.parked_height_m});
    state.attitude = attitude_from({.yaw_rad = yaw});
    return {params, state, {}};
  }
  state = trim.state;
  state.position_m = ned_from_enu({config.start.x_m, config.start.y_m, config.height_m});
  EulerAngles angles = euler_angles(state.attitude);
  angles.yaw_rad = yaw;
  state.attitude = attitude_from(angles);
  state.velocity_mps +=
      state.attitude.conjugate() * ned_from_enu({config.wind_mps.x(), config.wind_mps.y(), 0.0});
  return {params, state, trim.input};
}

autopilot::PlaneParams params_of(const EmulatorConfig& config, const PlaneAirframe& airframe) {
  autopilot::PlaneParams p;
  p.tuning = airframe.tuning;
  p.rotate_airspeed_mps = airframe.rotate_share * config.airspeed_min_mps;
  p.flare_height_m = airframe.flare_height_m;
  // Its parameters are equivalent airspeeds, the loops of the model go by true ones.
  const double true_per_equivalent =
      true_per_equivalent_airspeed(config.origin.height_m + config.height_m);
  p.tuning.airspeed_min_mps = config.airspeed_min_mps * true_per_equivalent;
  p.tuning.airspeed_cruise_mps = config.airspeed_mps * true_per_equivalent;
  p.tuning.airspeed_max_mps = config.airspeed_max_mps * true_per_equivalent;
  p.tuning.roll_max_rad = bank_limit_rad(config);
  p.loiter_radius_m = kLoiterRadii * config.turn_radius_m;
  p.vtol = airframe.vtol;
  if (p.vtol) p.vtol->wings_from_mps = p.tuning.airspeed_min_mps;
  // As TECS_LAND_ARSPD -1.
  p.approach_airspeed_mps = 0.5 * (p.tuning.airspeed_min_mps + p.tuning.airspeed_cruise_mps);
  p.companion_failsafe = config.companion_failsafe;
  return p;
}

}  // namespace

Result<std::unique_ptr<Vehicle>> PlaneVehicle::make(const EmulatorConfig& config,
                                                    const Earth& earth, Instant now) {
  const PlaneAirframe* const airframe = airframe_for(config);
  SKEIN_ASSERT(airframe != nullptr);
  const auto trim = models::trim(airframe->model, {.airspeed_mps = config.airspeed_mps});
  if (!trim) return trim.error();
  return std::unique_ptr<Vehicle>{
      std::make_unique<PlaneVehicle>(config, *airframe, earth, *trim, now)};
}

PlaneVehicle::PlaneVehicle(const EmulatorConfig& config, const PlaneAirframe& airframe,
                           const Earth& earth, const models::Trim& trim, Instant now)
    : AutopilotVehicle{config, earth, params_of(config, airframe), now},
      aircraft_{at_start(config, airframe, trim)},
      params_{params_of(config, airframe)},
      airspeed_min_mps_{config.airspeed_min_mps},
      airspeed_max_mps_{config.airspeed_max_mps} {
  sense(aircraft_);
  const auto mode = autopilot::plane_mode(mode_named(config.airframe, config.mode).value_or(0));
  start_autopilot(now, mode.value_or(PlaneMode::manual));
}

void PlaneVehicle::start_autopilot(Instant now, PlaneMode mode) {
  autopilot_ = autopilot::PlaneAutopilot{params_};
  autopilot_.set_health(health_);
  // Its first period tells it whether it flies.
  (void)autopilot_.step(report_.estimate, now);
  if (autopilot_.status().flying) {
    (void)arm();
    (void)autopilot_.select_mode(mode);
    while (autopilot_.poll_notice()) continue;
  }
  tell();
}

void PlaneVehicle::restart(Instant now) { start_autopilot(now, PlaneMode::loiter); }

void PlaneVehicle::coast(Instant now) {
  const models::FixedWingInput input{surfaces_.elevator_rad, surfaces_.aileron_rad,
                                     surfaces_.rudder_rad, surfaces_.throttle, autopilot_.rotors()};
  fly_until(now, kModelStep, [&](double seconds) {
    air_.step(aircraft_.state(), seconds);
    aircraft_.step(input, air_.wind_ned_mps(), seconds);
  });
}

void PlaneVehicle::control(Instant now) {
  coast(now);
  sense(aircraft_);
  if (!held(now)) {
    // The hands of a pilot who does not steer.
    autopilot_.set_sticks({.throttle = report_.flying ? params_.tuning.throttle_level : 0.0});
    surfaces_ = autopilot_.step(report_.estimate, now);
  }
  tell();
}

void PlaneVehicle::tell() {
  const autopilot::PlaneStatus& status = autopilot_.status();
  const PlaneMode mode = autopilot_.mode();
  report_.wind_ned_mps = air_.estimated_ned_mps();
  report_.throttle = surfaces_.throttle;
  report_.armed = autopilot_.armed();
  report_.flying = status.flying;
  report_.vtol = on_wire(autopilot_.carried());
  report_.rolling = autopilot_.armed() && !status.flying && mode != PlaneMode::mission &&
                    report_.estimate.groundspeed_mps() > kRollsFrom_mps;
  report_.mode_refusal = autopilot_.mode_refusal();
  report_.mode = static_cast<std::uint32_t>(mode);
  report_.base_mode =
      mode == PlaneMode::manual || mode == PlaneMode::fbwa ? kPilotBase : kGuidedBase;
  report_.goal_m = {status.goal_m.x(), status.goal_m.y(), -status.height_m};
  report_.goal_airspeed_mps = status.airspeed_mps;
  report_.roll_demand_rad = status.roll_rad;
  report_.pitch_demand_rad = status.pitch_rad;
}

autopilot::CommandResult PlaneVehicle::select_mode(std::uint32_t number) {
  const auto mode = autopilot::plane_mode(number);
  const auto result = mode ? autopilot_.select_mode(*mode) : autopilot::CommandResult::failed;
  tell();
  return result;
}

Vec3 PlaneVehicle::home_of(const Vec3& position_m) const {
  if (!autopilot_.status().flying) return position_m;
  return {position_m.x(), position_m.y(), 0.0};
}

CommandResult PlaneVehicle::command(const mavlink::CommandInt& c) {
  using mavlink::Command;
  switch (static_cast<Command>(c.command)) {
    case Command::do_reposition:
      return reposition(c);
    case Command::do_change_speed:
      return change_speed(c);
    case Command::do_change_altitude:
      return change_height(c);
    case Command::guided_change_speed:
      return guided_speed(c);
    case Command::guided_change_altitude:
      return guided_height(c);
    case Command::guided_change_heading:
      return guided_heading(c);
    case Command::do_set_mission_current:
      if (!(c.param1 >= 0.0F && c.param1 < 1000.0F)) return CommandResult::denied;
      return on_wire(autopilot_.set_mission_item(static_cast<std::size_t>(c.param1)));
    case Command::nav_loiter_unlim:
      return enter(PlaneMode::loiter);
    case Command::nav_return_to_launch:
      return enter(PlaneMode::rtl);
    case Command::nav_takeoff:
      return on_wire(autopilot_.lift_off(static_cast<double>(c.z)));
    case Command::do_land_start:  // of a mission with a landing
      return CommandResult::failed;
    default:
      return CommandResult::unsupported;
  }
}

/// ArduPlane says accepted whether or not the mode was entered.
CommandResult PlaneVehicle::enter(PlaneMode mode) {
  (void)autopilot_.select_mode(mode);
  tell();
  return CommandResult::accepted;
}

CommandResult PlaneVehicle::reposition(const mavlink::CommandInt& c) {
  const auto down = down_of(static_cast<double>(c.z), c.frame, earth_, report_.home_m);
  if (!down) return CommandResult::denied;
  const auto place = earth_.ned({c.x, c.y, earth_.origin_height_m() - *down});
  if (!place || (c.x == 0 && c.y == 0)) return CommandResult::denied;
  const bool change_mode =
      c.param2 > 0.0F && c.param2 < 256.0F && (static_cast<unsigned>(c.param2) & kChangeMode) != 0;
  if (!change_mode && !guided()) return CommandResult::failed;
  const bool has_radius = std::isfinite(c.param3) && c.param3 > 0.0F;
  const auto result = autopilot_.reposition({
      .centre_m = place->head<2>(),
      .height_m = -*down,
      .radius_m = has_radius ? static_cast<double>(c.param3) : 0.0,
      .clockwise = !std::isfinite(c.param4) || c.param4 == 0.0F,
      .change_mode = change_mode,
  });
  tell();
  return on_wire(result);
}

CommandResult PlaneVehicle::change_speed(const mavlink::CommandInt& c) {
  constexpr float kAirspeed = 0.0F;
  if (!guided() && autopilot_.mode() != PlaneMode::mission) return CommandResult::failed;
  if (c.param1 != kAirspeed) return CommandResult::failed;
  const auto wanted = true_airspeed(static_cast<double>(c.param2));
  if (!wanted) return CommandResult::failed;
  const auto result = autopilot_.change_speed(*wanted);
  if (result == autopilot::CommandResult::accepted) {
    // ArduPlane says so each time.
    autopilot_.say(autopilot::Severity::info,
                   fmt::format("Set airspeed {:.0f} m/s", static_cast<double>(c.param2)));
  }
  return on_wire(result);
}

std::optional<double> PlaneVehicle::true_airspeed(double equivalent_mps) const {
  // Written so that a number that is none fails.
  if (!(equivalent_mps >= airspeed_min_mps_ && equivalent_mps <= airspeed_max_mps_)) {
    return std::nullopt;
  }
  const double wanted = equivalent_mps * true_per_equivalent_airspeed(earth_.origin_height_m() +
                                                                      report_.estimate.height_m());
  return std::clamp(wanted, params_.tuning.airspeed_min_mps, params_.tuning.airspeed_max_mps);
}

CommandResult PlaneVehicle::change_height(const mavlink::CommandInt& c) {
  if (!std::isfinite(c.param1) || !(c.param2 >= 0.0F && c.param2 <= 255.0F)) {
    return CommandResult::denied;
  }
  const auto down = down_of(static_cast<double>(c.param1), static_cast<std::uint8_t>(c.param2),
                            earth_, report_.home_m);
  if (!down) return CommandResult::denied;
  return on_wire(autopilot_.change_height(-*down));
}

CommandResult PlaneVehicle::guided_speed(const mavlink::CommandInt& c) {
  if (!guided()) return CommandResult::failed;
  if (std::trunc(c.param1) != 0.0F) return CommandResult::denied;
  const auto wanted = true_airspeed(static_cast<double>(c.param2));
  if (!wanted) return CommandResult::denied;
  return on_wire(autopilot_.guided_speed(*wanted, std::abs(static_cast<double>(c.param3))));
}

CommandResult PlaneVehicle::guided_height(const mavlink::CommandInt& c) {
  if (!guided()) return CommandResult::failed;
  if (c.z == -1.0F || c.z == 0.0F) return CommandResult::denied;
  const auto down = down_of(static_cast<double>(c.z), c.frame, earth_, report_.home_m);
  if (!down) return CommandResult::denied;
  return on_wire(autopilot_.guided_height(
      -*down, kAltitudeRateShare * std::abs(static_cast<double>(c.param3))));
}

CommandResult PlaneVehicle::guided_heading(const mavlink::CommandInt& c) {
  if (!guided()) return CommandResult::failed;
  if (!(c.param2 >= 0.0F && c.param2 < 360.0F)) return CommandResult::denied;
  if (!(c.param1 > -1.0F && c.param1 < 2.0F) || !std::isfinite(c.param3)) {
    return CommandResult::denied;
  }
  const auto kind = static_cast<int>(c.param1);
  return on_wire(autopilot_.guided_heading(
      static_cast<autopilot::HeadingKind>(kind), radians(static_cast<double>(c.param2)),
      static_cast<double>(std::max(c.param3, kHeadingAccelerationLeast_mps2))));
}

/// The items that a landing is made of; of others it has no use.
mavlink::MissionResult PlaneVehicle::load_mission(std::span<const mavlink::MissionItemInt> items) {
  using Kind = autopilot::MissionItem::Kind;
  using mavlink::Command;
  std::vector<autopilot::MissionItem> flown;
  for (const mavlink::MissionItemInt& item : items) {
    const auto down = down_of(static_cast<double>(item.z), item.frame, earth_, report_.home_m);
    if (!down) return mavlink::MissionResult::unsupported_frame;
    const auto place = earth_.ned({item.x, item.y, earth_.origin_height_m() - *down});
    if (!place) return mavlink::MissionResult::invalid;
    autopilot::MissionItem& one = flown.emplace_back();
    one.north_m = place->x();
    one.east_m = place->y();
    one.height_m = -*down;
    const auto command = static_cast<Command>(item.command);
    if (flown.size() == 1 || command == Command::do_land_start) {
      one.kind = Kind::mark;
    } else if (command == Command::nav_waypoint) {
      one.kind = Kind::waypoint;
    } else if (command == Command::nav_land) {
      one.kind = Kind::land;
    } else if (command == Command::nav_vtol_land && params_.vtol) {
      one.kind = Kind::vtol_land;
    } else if (command == Command::nav_loiter_to_alt) {
      one.kind = Kind::loiter_to_height;
      one.radius_m = static_cast<double>(item.param2);
    } else {
      return mavlink::MissionResult::unsupported;
    }
  }
  const bool taken = autopilot_.load_mission(flown) == autopilot::CommandResult::accepted;
  return taken ? mavlink::MissionResult::accepted : mavlink::MissionResult::invalid;
}

void PlaneVehicle::on_attitude_target(const mavlink::SetAttitudeTarget& target, Instant now) {
  // ArduPlane inverts the mask, and takes an attitude that is not ignored for roll and pitch both,
  // whatever the rate bits say; with the attitude ignored, the rate bits choose.
  const bool whole = (target.type_mask & mavlink::ignore_attitude) == 0;
  const bool roll = whole || (target.type_mask & mavlink::ignore_roll_rate) == 0;
  const bool pitch = whole || (target.type_mask & mavlink::ignore_pitch_rate) == 0;
  const Eigen::Quaterniond q{static_cast<double>(target.q[0]), static_cast<double>(target.q[1]),
                             static_cast<double>(target.q[2]), static_cast<double>(target.q[3])};
  if (!roll && !pitch) return;
  if (!q.coeffs().allFinite() || !(q.norm() > 0.5)) return;
  const EulerAngles angles = euler_angles(q.normalized());
  autopilot::AttitudeTarget wanted;
  if (roll) wanted.roll_rad = angles.roll_rad;
  if (pitch) wanted.pitch_rad = angles.pitch_rad;
  if ((target.type_mask & mavlink::ignore_thrust) == 0) {
    wanted.throttle = static_cast<double>(target.thrust);
  }
  (void)autopilot_.attitude_target(wanted, now);
}

void PlaneVehicle::on_position_target(const mavlink::SetPositionTargetLocalNed& target,
                                      Instant /*now*/) {
  // Of the local frames ArduPlane takes only the offset to its own height.
  if (!guided() ||
      target.coordinate_frame != static_cast<std::uint8_t>(mavlink::Frame::local_offset_ned)) {
    return;
  }
  (void)autopilot_.change_height(report_.estimate.height_m() - static_cast<double>(target.z));
}

void PlaneVehicle::on_position_target(const mavlink::SetPositionTargetGlobalInt& target,
                                      Instant /*now*/) {
  // The altitude alone, even where the mask says to ignore it.
  if (!guided()) return;
  const auto down =
      down_of(static_cast<double>(target.alt), target.coordinate_frame, earth_, report_.home_m);
  if (down) (void)autopilot_.change_height(-*down);
}

}  // namespace skein::hil
