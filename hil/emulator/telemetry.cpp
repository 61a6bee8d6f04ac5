// SPDX-License-Identifier: Apache-2.0
#include "telemetry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

#include "skein/base/angles.hpp"
#include "skein/base/atmosphere.hpp"

namespace skein::hil {
namespace {

using namespace mavlink;  // half of what it has: NOLINT(google-build-using-namespace)

/// ArduPlane 4.6.3, an official release.
constexpr std::uint32_t kFirmwareVersion = 0x040603FF;
constexpr std::uint16_t kCapabilities =
    capability_mission_float | capability_param_float | capability_command_int |
    capability_set_attitude_target | capability_set_position_target_local_ned |
    capability_set_position_target_global_int | capability_mavlink2;
/// EKF_STATUS_REPORT: attitude, both velocities, both horizontal positions, vertical position,
/// height above ground.
constexpr std::uint16_t kEkfGood = 0x033F;
constexpr std::uint32_t kSensors = sensor_gyro | sensor_accelerometer | sensor_magnetometer |
                                   sensor_absolute_pressure | sensor_differential_pressure |
                                   sensor_gps | sensor_ahrs | sensor_battery;

/// To a type of the wire, within its limits.
template <class Integer>
Integer rounded(double value) {
  using Limits = std::numeric_limits<Integer>;
  return static_cast<Integer>(std::llround(
      std::clamp(value, static_cast<double>(Limits::min()), static_cast<double>(Limits::max()))));
}
float f32(double value) { return static_cast<float>(value); }
std::uint32_t boot_ms(const Situation& s) {
  return static_cast<std::uint32_t>(s.since_boot / std::chrono::milliseconds{1});
}
std::uint64_t boot_us(const Situation& s) {
  return static_cast<std::uint64_t>(s.since_boot / std::chrono::microseconds{1});
}
double compass_deg(double from_north_rad) { return degrees(wrap_two_pi(from_north_rad)); }
double bearing(const Vec3& to) { return std::atan2(to.y(), to.x()); }

Heartbeat heartbeat(const Situation& s) {
  Heartbeat m;
  m.custom_mode = s.flight.mode;
  m.type = static_cast<std::uint8_t>(s.type);
  m.autopilot = static_cast<std::uint8_t>(Autopilot::ardupilotmega);
  m.base_mode =
      static_cast<std::uint8_t>(s.flight.base_mode | (s.flight.armed ? mode_safety_armed : 0));
  m.system_status = static_cast<std::uint8_t>(
      s.flight.armed && s.flight.flying ? SystemState::active : SystemState::standby);
  return m;
}

SysStatus sys_status(const Situation& s) {
  SysStatus m;
  m.onboard_control_sensors_present = kSensors | sensor_prearm_check;
  m.onboard_control_sensors_enabled = kSensors | sensor_prearm_check;
  m.onboard_control_sensors_health = kSensors;
  if (!s.position) {
    // As ArduPilot does without a GNSS: it counts no more among what is enabled.
    m.onboard_control_sensors_enabled &= ~std::uint32_t{sensor_gps};
    m.onboard_control_sensors_health &= ~std::uint32_t{sensor_gps | sensor_ahrs};
  }
  if (s.may_arm || s.flight.armed) m.onboard_control_sensors_health |= sensor_prearm_check;
  m.load = 166;
  m.voltage_battery = rounded<std::uint16_t>(s.battery.volts() * 1e3);
  m.current_battery = rounded<std::int16_t>(s.battery.amperes() * 1e2);
  m.battery_remaining = s.battery.percent_told();
  return m;
}

SystemTime system_time(const Situation& s) {
  return {.time_unix_usec = static_cast<std::uint64_t>(std::max<std::int64_t>(s.unix_us, 0)),
          .time_boot_ms = boot_ms(s)};
}

GpsRawInt gps_raw(const Situation& s) {
  const GlobalPosition at = s.earth.global(s.flight.estimate.position_m);
  GpsRawInt m;
  m.time_usec = boot_us(s);
  m.lat = at.latitude_e7;
  m.lon = at.longitude_e7;
  m.alt = rounded<std::int32_t>(at.height_m * 1e3);
  m.eph = 121;
  m.epv = 200;
  m.vel = rounded<std::uint16_t>(s.flight.estimate.groundspeed_mps() * 1e2);
  m.cog = rounded<std::uint16_t>(compass_deg(s.flight.estimate.course_rad()) * 1e2);
  m.fix_type = static_cast<std::uint8_t>(GpsFix::rtk_fixed);
  m.satellites_visible = 10;
  m.h_acc = 300;
  m.v_acc = 300;
  m.vel_acc = 40;
  return m;
}

Attitude attitude(const Situation& s) {
  const EulerAngles angles = euler_angles(s.flight.estimate.attitude);
  const Vec3& rates = s.flight.estimate.rates_radps;
  return {.time_boot_ms = boot_ms(s),
          .roll = f32(angles.roll_rad),
          .pitch = f32(angles.pitch_rad),
          .yaw = f32(angles.yaw_rad),
          .rollspeed = f32(rates.x()),
          .pitchspeed = f32(rates.y()),
          .yawspeed = f32(rates.z())};
}

LocalPositionNed local_position(const Situation& s) {
  const Vec3 at = s.flight.estimate.position_m - s.ekf_origin_m;
  const Vec3& v = s.flight.estimate.velocity_mps;
  return {.time_boot_ms = boot_ms(s),
          .x = f32(at.x()),
          .y = f32(at.y()),
          .z = f32(at.z()),
          .vx = f32(v.x()),
          .vy = f32(v.y()),
          .vz = f32(v.z())};
}

GlobalPositionInt global_position(const Situation& s) {
  const autopilot::Estimate& e = s.flight.estimate;
  const GlobalPosition at = s.earth.global(e.position_m);
  return {.time_boot_ms = boot_ms(s),
          .lat = at.latitude_e7,
          .lon = at.longitude_e7,
          .alt = rounded<std::int32_t>(at.height_m * 1e3),
          .relative_alt = rounded<std::int32_t>((s.flight.home_m.z() - e.position_m.z()) * 1e3),
          .vx = rounded<std::int16_t>(e.velocity_mps.x() * 1e2),
          .vy = rounded<std::int16_t>(e.velocity_mps.y() * 1e2),
          .vz = rounded<std::int16_t>(e.velocity_mps.z() * 1e2),
          .hdg = rounded<std::uint16_t>(compass_deg(euler_angles(e.attitude).yaw_rad) * 1e2)};
}

SimState true_state(const Situation& s) { return sim_state(s.flight, s.earth); }

MissionCurrent mission_current(const Situation& /*s*/) { return {}; }

GpsGlobalOrigin global_origin(const Situation& s) {
  const GlobalPosition at = s.earth.global(s.ekf_origin_m);
  return {.latitude = at.latitude_e7,
          .longitude = at.longitude_e7,
          .altitude = rounded<std::int32_t>(at.height_m * 1e3),
          .time_usec = boot_us(s)};
}

/// What a pitot tube knows.
double equivalent_airspeed(const Situation& s, double true_mps) {
  return true_mps /
         true_per_equivalent_airspeed(s.earth.origin_height_m() + s.flight.estimate.height_m());
}

NavControllerOutput nav_controller(const Situation& s) {
  const Vec3 to = s.flight.goal_m - s.flight.estimate.position_m;
  return {.nav_roll = f32(degrees(s.flight.roll_demand_rad)),
          .nav_pitch = f32(degrees(s.flight.pitch_demand_rad)),
          .alt_error = f32(-to.z()),
          .aspd_error = f32(
              equivalent_airspeed(s, s.flight.goal_airspeed_mps - s.flight.estimate.airspeed_mps)),
          .nav_bearing = rounded<std::int16_t>(degrees(s.flight.estimate.course_rad())),
          .target_bearing = rounded<std::int16_t>(degrees(bearing(to))),
          .wp_dist = rounded<std::uint16_t>(to.head<2>().norm())};
}

VfrHud vfr_hud(const Situation& s) {
  const autopilot::Estimate& e = s.flight.estimate;
  return {.airspeed = f32(equivalent_airspeed(s, e.airspeed_mps)),
          .groundspeed = f32(e.groundspeed_mps()),
          .alt = f32(s.earth.origin_height_m() + e.height_m()),
          .climb = f32(e.climb_mps()),
          .heading = rounded<std::int16_t>(
              std::fmod(std::round(compass_deg(euler_angles(e.attitude).yaw_rad)), 360.0)),
          .throttle = rounded<std::uint16_t>(s.flight.throttle * 1e2)};
}

PositionTargetGlobalInt position_target(const Situation& s) {
  constexpr std::uint16_t kPositionOnly = 0xFFF8;
  const GlobalPosition goal = s.earth.global(s.flight.goal_m);
  PositionTargetGlobalInt m;
  m.time_boot_ms = boot_ms(s);
  m.lat_int = goal.latitude_e7;
  m.lon_int = goal.longitude_e7;
  m.alt = f32(goal.height_m);
  m.type_mask = kPositionOnly;
  return m;
}

BatteryStatus battery(const Situation& s) {
  constexpr std::uint16_t kNoCell = 0xFFFF;
  BatteryStatus m;
  m.temperature = std::numeric_limits<std::int16_t>::max();
  m.voltages.fill(kNoCell);
  m.voltages[0] = rounded<std::uint16_t>(s.battery.volts() * 1e3);
  m.current_battery = rounded<std::int16_t>(s.battery.amperes() * 1e2);
  m.current_consumed = rounded<std::int32_t>(s.battery.counted_mah());
  m.battery_remaining = s.battery.percent_told();
  m.charge_state = 1;
  return m;
}

AutopilotVersion autopilot_version(const Situation& /*s*/) {
  AutopilotVersion m;
  m.capabilities = kCapabilities;
  m.flight_sw_version = kFirmwareVersion;
  return m;
}

Wind wind(const Situation& s) {
  const Vec3& w = s.flight.wind_ned_mps;
  return {.direction = f32(degrees(wrap_pi(bearing(w) + kPi))),
          .speed = f32(w.head<2>().norm()),
          .speed_z = f32(w.z())};
}

EkfStatusReport ekf_status(const Situation& /*s*/) {
  EkfStatusReport m;
  m.velocity_variance = 0.05F;
  m.pos_horiz_variance = 0.05F;
  m.pos_vert_variance = 0.05F;
  m.compass_variance = 0.05F;
  m.flags = kEkfGood;
  return m;
}

HomePosition home_position(const Situation& s) {
  const GlobalPosition home = s.earth.global(s.flight.home_m);
  HomePosition m;
  m.latitude = home.latitude_e7;
  m.longitude = home.longitude_e7;
  m.altitude = rounded<std::int32_t>(home.height_m * 1e3);
  m.q = {1.0F, 0.0F, 0.0F, 0.0F};
  m.time_usec = boot_us(s);
  return m;
}

ExtendedSysState extended_state(const Situation& s) {
  const bool in_air = s.flight.flying || s.flight.rolling;
  return {.vtol_state = static_cast<std::uint8_t>(s.flight.vtol),
          .landed_state =
              static_cast<std::uint8_t>(in_air ? LandedState::in_air : LandedState::on_ground)};
}

struct Producer {
  std::uint32_t id;
  bool unasked;
  WireBytes (*make)(Encoder& encoder, const Situation& situation);
};
template <auto Make>
WireBytes encoded(Encoder& encoder, const Situation& situation) {
  return encoder.encode(Make(situation));
}
template <auto Make>
constexpr Producer producer(bool unasked) {
  using Message = std::invoke_result_t<decltype(Make), const Situation&>;
  return {Message::kDefinition.id, unasked, &encoded<Make>};
}

constexpr std::array kProducers{
    producer<heartbeat>(true),
    producer<sys_status>(true),
    producer<system_time>(true),
    producer<gps_raw>(true),
    producer<attitude>(true),
    producer<local_position>(true),
    producer<global_position>(true),
    producer<mission_current>(true),
    producer<global_origin>(false),
    producer<nav_controller>(true),
    producer<vfr_hud>(true),
    producer<position_target>(true),
    producer<battery>(true),
    producer<autopilot_version>(false),
    producer<wind>(true),
    producer<ekf_status>(true),
    producer<home_position>(false),
    producer<extended_state>(false),
    producer<true_state>(false),
};
constexpr auto kIds = [] {
  std::array<std::uint32_t, kProducers.size()> ids{};
  for (std::size_t i = 0; i < ids.size(); ++i) ids.at(i) = kProducers.at(i).id;
  return ids;
}();

const Producer* find(std::uint32_t id) {
  const auto* const found = std::find_if(kProducers.begin(), kProducers.end(),
                                         [id](const Producer& p) { return p.id == id; });
  return found == kProducers.end() ? nullptr : found;
}

}  // namespace

SimState sim_state(const FlightReport& flight, const Earth& earth) {
  const models::RigidBodyState& truth = flight.truth;
  const GlobalPosition at = earth.global(truth.position_m);
  const EulerAngles angles = euler_angles(truth.attitude);
  const Vec3 velocity = truth.velocity_ned_mps();
  SimState m;
  m.q1 = f32(truth.attitude.w());
  m.q2 = f32(truth.attitude.x());
  m.q3 = f32(truth.attitude.y());
  m.q4 = f32(truth.attitude.z());
  m.roll = f32(angles.roll_rad);
  m.pitch = f32(angles.pitch_rad);
  m.yaw = f32(angles.yaw_rad);
  m.xgyro = f32(truth.rates_radps.x());
  m.ygyro = f32(truth.rates_radps.y());
  m.zgyro = f32(truth.rates_radps.z());
  m.lat = f32(at.latitude_e7 * 1e-7);
  m.lon = f32(at.longitude_e7 * 1e-7);
  m.alt = f32(at.height_m);
  m.vn = f32(velocity.x());
  m.ve = f32(velocity.y());
  m.vd = f32(velocity.z());
  m.lat_int = at.latitude_e7;
  m.lon_int = at.longitude_e7;
  return m;
}

std::span<const std::uint32_t> telemetry_ids() { return kIds; }

bool is_streamed_unasked(std::uint32_t id) {
  const Producer* const producer = find(id);
  return producer != nullptr && producer->unasked;
}

std::optional<WireBytes> telemetry(std::uint32_t id, Encoder& encoder, const Situation& situation) {
  const Producer* const producer = find(id);
  if (producer == nullptr) return std::nullopt;
  return producer->make(encoder, situation);
}

}  // namespace skein::hil
