// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "skein/mavlink/definition.hpp"

/// State of the vehicle, as the autopilot reports it.
/// Units stand at the fields: degE7 is 1e-7 degrees, cdeg 0.01 degrees, d% 0.1 percent, cA 0.01 A,
/// hJ 100 J. Field names are those of the MAVLink definitions: they are part of the checksum.
namespace skein::mavlink {

/// Sent by every node once a second: who it is, its mode, whether it is armed.
struct Heartbeat {
  std::uint32_t custom_mode = 0;
  std::uint8_t type = 0, autopilot = 0, base_mode = 0, system_status = 0;
  std::uint8_t mavlink_version = 3;

  static constexpr auto kDefinition =
      define(0, "HEARTBEAT",
             SKEIN_MAVLINK_FIELDS(Heartbeat, custom_mode, type, autopilot, base_mode, system_status,
                                  mavlink_version));
};

/// Sensors and battery in short; bit 28 of the sensors is the check before arming.
struct SysStatus {
  std::uint32_t onboard_control_sensors_present = 0, onboard_control_sensors_enabled = 0,
                onboard_control_sensors_health = 0;
  std::uint16_t load = 0;             ///< d%
  std::uint16_t voltage_battery = 0;  ///< mV
  std::int16_t current_battery = 0;   ///< cA
  std::uint16_t drop_rate_comm = 0;   ///< c%
  std::uint16_t errors_comm = 0, errors_count1 = 0, errors_count2 = 0, errors_count3 = 0;
  std::uint16_t errors_count4 = 0;
  std::int8_t battery_remaining = 0;  ///< %
  std::uint32_t onboard_control_sensors_present_extended = 0,
                onboard_control_sensors_enabled_extended = 0,
                onboard_control_sensors_health_extended = 0;

  static constexpr auto kDefinition =
      define(1, "SYS_STATUS",
             SKEIN_MAVLINK_FIELDS(SysStatus, onboard_control_sensors_present,
                                  onboard_control_sensors_enabled, onboard_control_sensors_health,
                                  load, voltage_battery, current_battery, drop_rate_comm,
                                  errors_comm, errors_count1, errors_count2, errors_count3,
                                  errors_count4, battery_remaining),
             SKEIN_MAVLINK_FIELDS(SysStatus, onboard_control_sensors_present_extended,
                                  onboard_control_sensors_enabled_extended,
                                  onboard_control_sensors_health_extended));
};

/// The clock of the sender.
struct SystemTime {
  std::uint64_t time_unix_usec = 0;  ///< us
  std::uint32_t time_boot_ms = 0;    ///< ms

  static constexpr auto kDefinition =
      define(2, "SYSTEM_TIME", SKEIN_MAVLINK_FIELDS(SystemTime, time_unix_usec, time_boot_ms));
};

/// A round trip: tc1 = 0 asks, the answer copies ts1 and sets tc1.
struct Timesync {
  std::int64_t tc1 = 0;  ///< ns
  std::int64_t ts1 = 0;  ///< ns
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;

  static constexpr auto kDefinition =
      define(111, "TIMESYNC", SKEIN_MAVLINK_FIELDS(Timesync, tc1, ts1),
             SKEIN_MAVLINK_FIELDS(Timesync, target_system, target_component));
};

/// Firmware, board and capabilities; asked for with Command::request_message.
struct AutopilotVersion {
  std::uint64_t capabilities = 0;
  std::uint64_t uid = 0;
  std::uint32_t flight_sw_version = 0, middleware_sw_version = 0, os_sw_version = 0,
                board_version = 0;
  std::uint16_t vendor_id = 0;
  std::uint16_t product_id = 0;
  std::array<std::uint8_t, 8> flight_custom_version{};
  std::array<std::uint8_t, 8> middleware_custom_version{};
  std::array<std::uint8_t, 8> os_custom_version{};
  std::array<std::uint8_t, 18> uid2{};

  static constexpr auto kDefinition =
      define(148, "AUTOPILOT_VERSION",
             SKEIN_MAVLINK_FIELDS(AutopilotVersion, capabilities, uid, flight_sw_version,
                                  middleware_sw_version, os_sw_version, board_version, vendor_id,
                                  product_id, flight_custom_version, middleware_custom_version,
                                  os_custom_version),
             SKEIN_MAVLINK_FIELDS(AutopilotVersion, uid2));
};

/// Where the vehicle returns to.
struct HomePosition {
  std::int32_t latitude = 0;   ///< degE7
  std::int32_t longitude = 0;  ///< degE7
  std::int32_t altitude = 0;   ///< mm
  float x = 0, y = 0, z = 0;   ///< m
  std::array<float, 4> q{};
  float approach_x = 0, approach_y = 0, approach_z = 0;  ///< m
  std::uint64_t time_usec = 0;                           ///< us

  static constexpr auto kDefinition =
      define(242, "HOME_POSITION",
             SKEIN_MAVLINK_FIELDS(HomePosition, latitude, longitude, altitude, x, y, z, q,
                                  approach_x, approach_y, approach_z),
             SKEIN_MAVLINK_FIELDS(HomePosition, time_usec));
};

/// On the ground, in the air, taking off, landing.
struct ExtendedSysState {
  std::uint8_t vtol_state = 0;    ///< VtolState
  std::uint8_t landed_state = 0;  ///< LandedState

  static constexpr auto kDefinition = define(
      245, "EXTENDED_SYS_STATE", SKEIN_MAVLINK_FIELDS(ExtendedSysState, vtol_state, landed_state));
};

/// A line for people. Longer ones come in chunks with one id; id 0 stands alone.
struct Statustext {
  std::uint8_t severity = 0;
  std::array<char, 50> text{};
  std::uint16_t id = 0;
  std::uint8_t chunk_seq = 0;

  static constexpr auto kDefinition =
      define(253, "STATUSTEXT", SKEIN_MAVLINK_FIELDS(Statustext, severity, text),
             SKEIN_MAVLINK_FIELDS(Statustext, id, chunk_seq));
};

/// Roll, pitch and yaw against north-east-down.
struct Attitude {
  std::uint32_t time_boot_ms = 0;                     ///< ms
  float roll = 0, pitch = 0, yaw = 0;                 ///< rad
  float rollspeed = 0, pitchspeed = 0, yawspeed = 0;  ///< rad/s

  static constexpr auto kDefinition =
      define(30, "ATTITUDE",
             SKEIN_MAVLINK_FIELDS(Attitude, time_boot_ms, roll, pitch, yaw, rollspeed, pitchspeed,
                                  yawspeed));
};

/// North-east-down from the origin of the filter.
struct LocalPositionNed {
  std::uint32_t time_boot_ms = 0;  ///< ms
  float x = 0, y = 0, z = 0;       ///< m
  float vx = 0, vy = 0, vz = 0;    ///< m/s

  static constexpr auto kDefinition =
      define(32, "LOCAL_POSITION_NED",
             SKEIN_MAVLINK_FIELDS(LocalPositionNed, time_boot_ms, x, y, z, vx, vy, vz));
};

/// Filtered position; velocity north, east, down; hdg is UINT16_MAX if unknown.
struct GlobalPositionInt {
  std::uint32_t time_boot_ms = 0;       ///< ms
  std::int32_t lat = 0;                 ///< degE7
  std::int32_t lon = 0;                 ///< degE7
  std::int32_t alt = 0;                 ///< mm
  std::int32_t relative_alt = 0;        ///< mm
  std::int16_t vx = 0, vy = 0, vz = 0;  ///< cm/s
  std::uint16_t hdg = 0;                ///< cdeg

  static constexpr auto kDefinition =
      define(33, "GLOBAL_POSITION_INT",
             SKEIN_MAVLINK_FIELDS(GlobalPositionInt, time_boot_ms, lat, lon, alt, relative_alt, vx,
                                  vy, vz, hdg));
};

/// Speeds and height as a pilot reads them.
struct VfrHud {
  float airspeed = 0;          ///< m/s
  float groundspeed = 0;       ///< m/s
  float alt = 0;               ///< m
  float climb = 0;             ///< m/s
  std::int16_t heading = 0;    ///< deg
  std::uint16_t throttle = 0;  ///< %

  static constexpr auto kDefinition =
      define(74, "VFR_HUD",
             SKEIN_MAVLINK_FIELDS(VfrHud, airspeed, groundspeed, alt, climb, heading, throttle));
};

/// What the receiver says, unfiltered. UINT16_MAX: unknown.
struct GpsRawInt {
  std::uint64_t time_usec = 0;  ///< us
  std::int32_t lat = 0;         ///< degE7
  std::int32_t lon = 0;         ///< degE7
  std::int32_t alt = 0;         ///< mm
  std::uint16_t eph = 0;
  std::uint16_t epv = 0;
  std::uint16_t vel = 0;  ///< cm/s
  std::uint16_t cog = 0;  ///< cdeg
  std::uint8_t fix_type = 0;
  std::uint8_t satellites_visible = 0;
  std::int32_t alt_ellipsoid = 0;  ///< mm
  std::uint32_t h_acc = 0;         ///< mm
  std::uint32_t v_acc = 0;         ///< mm
  std::uint32_t vel_acc = 0;       ///< mm/s
  std::uint32_t hdg_acc = 0;       ///< degE5
  std::uint16_t yaw = 0;           ///< cdeg

  static constexpr auto kDefinition =
      define(24, "GPS_RAW_INT",
             SKEIN_MAVLINK_FIELDS(GpsRawInt, time_usec, lat, lon, alt, eph, epv, vel, cog, fix_type,
                                  satellites_visible),
             SKEIN_MAVLINK_FIELDS(GpsRawInt, alt_ellipsoid, h_acc, v_acc, vel_acc, hdg_acc, yaw));
};

/// ArduPilot: how well the filter agrees with its sensors, below 1 is good.
struct EkfStatusReport {
  float velocity_variance = 0, pos_horiz_variance = 0, pos_vert_variance = 0, compass_variance = 0;
  float terrain_alt_variance = 0;
  std::uint16_t flags = 0;
  float airspeed_variance = 0;

  static constexpr auto kDefinition =
      define(193, "EKF_STATUS_REPORT",
             SKEIN_MAVLINK_FIELDS(EkfStatusReport, velocity_variance, pos_horiz_variance,
                                  pos_vert_variance, compass_variance, terrain_alt_variance, flags),
             SKEIN_MAVLINK_FIELDS(EkfStatusReport, airspeed_variance));
};

/// What the guidance asks for, and how far it is off.
struct NavControllerOutput {
  float nav_roll = 0;               ///< deg
  float nav_pitch = 0;              ///< deg
  float alt_error = 0;              ///< m
  float aspd_error = 0;             ///< m/s
  float xtrack_error = 0;           ///< m
  std::int16_t nav_bearing = 0;     ///< deg
  std::int16_t target_bearing = 0;  ///< deg
  std::uint16_t wp_dist = 0;        ///< m

  static constexpr auto kDefinition =
      define(62, "NAV_CONTROLLER_OUTPUT",
             SKEIN_MAVLINK_FIELDS(NavControllerOutput, nav_roll, nav_pitch, alt_error, aspd_error,
                                  xtrack_error, nav_bearing, target_bearing, wp_dist));
};

/// The setpoint that the autopilot flies to now.
struct PositionTargetGlobalInt {
  std::uint32_t time_boot_ms = 0;   ///< ms
  std::int32_t lat_int = 0;         ///< degE7
  std::int32_t lon_int = 0;         ///< degE7
  float alt = 0;                    ///< m
  float vx = 0, vy = 0, vz = 0;     ///< m/s
  float afx = 0, afy = 0, afz = 0;  ///< m/s/s
  float yaw = 0;                    ///< rad
  float yaw_rate = 0;               ///< rad/s
  std::uint16_t type_mask = 0;
  std::uint8_t coordinate_frame = 0;

  static constexpr auto kDefinition = define(
      87, "POSITION_TARGET_GLOBAL_INT",
      SKEIN_MAVLINK_FIELDS(PositionTargetGlobalInt, time_boot_ms, lat_int, lon_int, alt, vx, vy, vz,
                           afx, afy, afz, yaw, yaw_rate, type_mask, coordinate_frame));
};

/// The setpoint that the autopilot flies to now, local.
struct PositionTargetLocalNed {
  std::uint32_t time_boot_ms = 0;   ///< ms
  float x = 0, y = 0, z = 0;        ///< m
  float vx = 0, vy = 0, vz = 0;     ///< m/s
  float afx = 0, afy = 0, afz = 0;  ///< m/s/s
  float yaw = 0;                    ///< rad
  float yaw_rate = 0;               ///< rad/s
  std::uint16_t type_mask = 0;
  std::uint8_t coordinate_frame = 0;

  static constexpr auto kDefinition =
      define(85, "POSITION_TARGET_LOCAL_NED",
             SKEIN_MAVLINK_FIELDS(PositionTargetLocalNed, time_boot_ms, x, y, z, vx, vy, vz, afx,
                                  afy, afz, yaw, yaw_rate, type_mask, coordinate_frame));
};

/// The attitude that the autopilot holds now.
struct AttitudeTarget {
  std::uint32_t time_boot_ms = 0;  ///< ms
  std::array<float, 4> q{};
  float body_roll_rate = 0, body_pitch_rate = 0, body_yaw_rate = 0;  ///< rad/s
  float thrust = 0;
  std::uint8_t type_mask = 0;

  static constexpr auto kDefinition =
      define(83, "ATTITUDE_TARGET",
             SKEIN_MAVLINK_FIELDS(AttitudeTarget, time_boot_ms, q, body_roll_rate, body_pitch_rate,
                                  body_yaw_rate, thrust, type_mask));
};

/// ArduPilot: the wind as estimated; direction is where it comes from.
struct Wind {
  float direction = 0;  ///< deg
  float speed = 0;      ///< m/s
  float speed_z = 0;    ///< m/s

  static constexpr auto kDefinition =
      define(168, "WIND", SKEIN_MAVLINK_FIELDS(Wind, direction, speed, speed_z));
};

/// One battery. UINT16_MAX: no such cell.
struct BatteryStatus {
  std::int32_t current_consumed = 0;         ///< mAh
  std::int32_t energy_consumed = 0;          ///< hJ
  std::int16_t temperature = 0;              ///< cdegC
  std::array<std::uint16_t, 10> voltages{};  ///< mV
  std::int16_t current_battery = 0;          ///< cA
  std::uint8_t id = 0, battery_function = 0, type = 0;
  std::int8_t battery_remaining = 0;  ///< %
  std::int32_t time_remaining = 0;    ///< s
  std::uint8_t charge_state = 0;
  std::array<std::uint16_t, 4> voltages_ext{};  ///< mV
  std::uint8_t mode = 0;
  std::uint32_t fault_bitmask = 0;

  static constexpr auto kDefinition = define(
      147, "BATTERY_STATUS",
      SKEIN_MAVLINK_FIELDS(BatteryStatus, current_consumed, energy_consumed, temperature, voltages,
                           current_battery, id, battery_function, type, battery_remaining),
      SKEIN_MAVLINK_FIELDS(BatteryStatus, time_remaining, charge_state, voltages_ext, mode,
                           fault_bitmask));
};

/// Vibration (m/s^2) and clipped samples of the accelerometers.
struct Vibration {
  std::uint64_t time_usec = 0;  ///< us
  float vibration_x = 0, vibration_y = 0, vibration_z = 0;
  std::uint32_t clipping_0 = 0, clipping_1 = 0, clipping_2 = 0;

  static constexpr auto kDefinition =
      define(241, "VIBRATION",
             SKEIN_MAVLINK_FIELDS(Vibration, time_usec, vibration_x, vibration_y, vibration_z,
                                  clipping_0, clipping_1, clipping_2));
};

}  // namespace skein::mavlink
