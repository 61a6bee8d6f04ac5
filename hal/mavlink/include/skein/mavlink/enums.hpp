// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// Values of fields, as far as they are in use; names follow the MAVLink definitions without their
/// prefixes. Commands that act on a payload are left out on purpose (docs/scope.md).
namespace skein::mavlink {

// Tables of numbers.
// clang-format off

/// COMMAND_LONG, COMMAND_INT, MISSION_ITEM_INT: `command`.
enum class Command : std::uint16_t {
  nav_waypoint = 16, nav_loiter_unlim = 17, nav_loiter_turns = 18, nav_loiter_time = 19,
  nav_return_to_launch = 20, nav_land = 21, nav_takeoff = 22, nav_loiter_to_alt = 31,
  nav_vtol_land = 85,
  do_set_mode = 176, do_change_speed = 178, do_set_home = 179, do_change_altitude = 186,
  do_land_start = 189, do_reposition = 192, mission_start = 300, component_arm_disarm = 400,
  run_prearm_checks = 401,
  get_home_position = 410, get_message_interval = 510, set_message_interval = 511,
  request_message = 512, request_autopilot_capabilities = 520, preflight_reboot_shutdown = 246,
  do_set_mission_current = 224, nav_fence_polygon_vertex_inclusion = 5001,
  guided_change_speed = 43000,     ///< ArduPilot
  guided_change_altitude = 43001,  ///< ArduPilot
  guided_change_heading = 43002,   ///< ArduPilot
};

/// COMMAND_ACK: `result`.
enum class CommandResult : std::uint8_t {
  accepted = 0, temporarily_rejected = 1, denied = 2, unsupported = 3, failed = 4, in_progress = 5,
  cancelled = 6, command_long_only = 7, command_int_only = 8, command_unsupported_frame = 9,
};

/// MISSION_ACK: `type`.
enum class MissionResult : std::uint8_t {
  accepted = 0, error = 1, unsupported_frame = 2, unsupported = 3, no_space = 4, invalid = 5,
  invalid_sequence = 13, denied = 14, operation_cancelled = 15,
};

/// HEARTBEAT: `type`.
enum class VehicleType : std::uint8_t {
  generic = 0, fixed_wing = 1, quadrotor = 2, gcs = 6, hexarotor = 13, octorotor = 14,
  onboard_controller = 18,
};

/// HEARTBEAT: `autopilot`.
enum class Autopilot : std::uint8_t { generic = 0, ardupilotmega = 3, invalid = 8, px4 = 12 };

/// HEARTBEAT: bits of `base_mode`.
enum ModeFlag : std::uint8_t {
  mode_custom_enabled = 1, mode_auto_enabled = 4, mode_guided_enabled = 8,
  mode_stabilize_enabled = 16, mode_manual_input_enabled = 64, mode_safety_armed = 128,
};

/// HEARTBEAT: `system_status`.
enum class SystemState : std::uint8_t {
  uninit = 0, boot = 1, calibrating = 2, standby = 3, active = 4, critical = 5, emergency = 6,
  poweroff = 7,
};

/// HEARTBEAT: `custom_mode` of ArduPlane.
enum class PlaneMode : std::uint32_t {
  manual = 0, circle = 1, stabilize = 2, training = 3, acro = 4, fly_by_wire_a = 5,
  fly_by_wire_b = 6, cruise = 7, autotune = 8, automatic = 10, rtl = 11, loiter = 12, takeoff = 13,
  guided = 15, initialising = 16, q_loiter = 19, q_land = 20, q_rtl = 21,
};

/// HEARTBEAT: `custom_mode` of ArduCopter.
enum class CopterMode : std::uint32_t {
  stabilize = 0, acro = 1, alt_hold = 2, automatic = 3, guided = 4, loiter = 5, rtl = 6,
  circle = 7, land = 9, brake = 17,
};

/// `frame`, `coordinate_frame`.
enum class Frame : std::uint8_t {
  global = 0, local_ned = 1, mission = 2, global_relative_alt = 3, local_offset_ned = 7,
  global_int = 5, global_relative_alt_int = 6, global_terrain_alt_int = 11,
};

/// SET_POSITION_TARGET_*: bits of `type_mask`; a set bit means ignore.
enum PositionIgnore : std::uint16_t {
  ignore_x = 1, ignore_y = 2, ignore_z = 4, ignore_vx = 8, ignore_vy = 16, ignore_vz = 32,
  ignore_ax = 64, ignore_ay = 128, ignore_az = 256, acceleration_is_force = 512, ignore_yaw = 1024,
  ignore_yaw_rate = 2048,
};

/// SET_ATTITUDE_TARGET: bits of `type_mask`; a set bit means ignore.
enum AttitudeIgnore : std::uint8_t {
  ignore_roll_rate = 1, ignore_pitch_rate = 2, ignore_body_yaw_rate = 4, ignore_thrust = 64,
  ignore_attitude = 128,
};

/// STATUSTEXT: `severity`.
enum class Severity : std::uint8_t {
  emergency = 0, alert = 1, critical = 2, error = 3, warning = 4, notice = 5, info = 6, debug = 7,
};

/// EXTENDED_SYS_STATE: `landed_state`.
enum class LandedState : std::uint8_t {
  undefined = 0, on_ground = 1, in_air = 2, takeoff = 3, landing = 4,
};

/// EXTENDED_SYS_STATE: `vtol_state`. An ArduPlane that is carried by its rotors and its wings at
/// once, on the way or as gusts want it, says to_wings.
enum class VtolState : std::uint8_t {
  undefined = 0, to_wings = 1, to_rotors = 2, on_rotors = 3, on_wings = 4,
};

/// GPS_RAW_INT: `fix_type`.
enum class GpsFix : std::uint8_t {
  no_gps = 0, no_fix = 1, fix_2d = 2, fix_3d = 3, dgps = 4, rtk_float = 5, rtk_fixed = 6,
};

/// SYS_STATUS: bits of `onboard_control_sensors_*`.
enum SensorFlag : std::uint32_t {
  sensor_gyro = 0x01, sensor_accelerometer = 0x02, sensor_magnetometer = 0x04,
  sensor_absolute_pressure = 0x08, sensor_differential_pressure = 0x10, sensor_gps = 0x20,
  sensor_ahrs = 0x200000, sensor_battery = 0x2000000, sensor_prearm_check = 0x10000000,
};

/// PARAM_VALUE, PARAM_SET: `param_type`.
enum class ParamType : std::uint8_t {
  uint8 = 1, int8 = 2, uint16 = 3, int16 = 4, uint32 = 5, int32 = 6, real32 = 9,
};

/// AUTOPILOT_VERSION: bits of `capabilities`.
enum Capability : std::uint64_t {
  capability_mission_float = 1, capability_param_float = 2, capability_mission_int = 4,
  capability_command_int = 8, capability_set_attitude_target = 64,
  capability_set_position_target_local_ned = 128, capability_set_position_target_global_int = 256,
  capability_mavlink2 = 8192,
};

/// Components of a system.
inline constexpr std::uint8_t kComponentAutopilot = 1;
inline constexpr std::uint8_t kComponentOnboardComputer = 191;
/// The first and the last of transmitters of Remote ID.
inline constexpr std::uint8_t kComponentRemoteId1 = 236, kComponentRemoteId3 = 238;

// clang-format on

}  // namespace skein::mavlink
