// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "skein/mavlink/definition.hpp"

/// Commands, setpoints and their answers.
/// Units stand at the fields: degE7 is 1e-7 degrees, cdeg 0.01 degrees, d% 0.1 percent, cA 0.01 A,
/// hJ 100 J. Field names are those of the MAVLink definitions: they are part of the checksum.
namespace skein::mavlink {

/// A command with a position (latitude and longitude in degE7, or 1e-4 m).
struct CommandInt {
  float param1 = 0, param2 = 0, param3 = 0, param4 = 0;
  std::int32_t x = 0;
  std::int32_t y = 0;
  float z = 0;
  std::uint16_t command = 0;
  std::uint8_t target_system = 0, target_component = 0, frame = 0, current = 0;
  std::uint8_t autocontinue = 0;

  static constexpr auto kDefinition =
      define(75, "COMMAND_INT",
             SKEIN_MAVLINK_FIELDS(CommandInt, param1, param2, param3, param4, x, y, z, command,
                                  target_system, target_component, frame, current, autocontinue));
};

/// A command with seven floats.
struct CommandLong {
  float param1 = 0, param2 = 0, param3 = 0, param4 = 0;
  float param5 = 0, param6 = 0, param7 = 0;
  std::uint16_t command = 0;
  std::uint8_t target_system = 0, target_component = 0, confirmation = 0;

  static constexpr auto kDefinition =
      define(76, "COMMAND_LONG",
             SKEIN_MAVLINK_FIELDS(CommandLong, param1, param2, param3, param4, param5, param6,
                                  param7, command, target_system, target_component, confirmation));
};

/// Accepted, refused, or on the way: CommandResult.
struct CommandAck {
  std::uint16_t command = 0;
  std::uint8_t result = 0;
  std::uint8_t progress = 0;  ///< %
  std::int32_t result_param2 = 0;
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;

  static constexpr auto kDefinition = define(
      77, "COMMAND_ACK", SKEIN_MAVLINK_FIELDS(CommandAck, command, result),
      SKEIN_MAVLINK_FIELDS(CommandAck, progress, result_param2, target_system, target_component));
};

/// Answer to Command::get_message_interval. -1: off.
struct MessageInterval {
  std::int32_t interval_us = 0;  ///< us
  std::uint16_t message_id = 0;

  static constexpr auto kDefinition = define(
      244, "MESSAGE_INTERVAL", SKEIN_MAVLINK_FIELDS(MessageInterval, interval_us, message_id));
};

/// Attitude (w, x, y, z), rates and thrust to hold; a set bit of the mask means ignore.
struct SetAttitudeTarget {
  std::uint32_t time_boot_ms = 0;  ///< ms
  std::array<float, 4> q{};
  float body_roll_rate = 0, body_pitch_rate = 0, body_yaw_rate = 0;  ///< rad/s
  float thrust = 0;
  std::uint8_t target_system = 0, target_component = 0, type_mask = 0;
  std::array<float, 3> thrust_body{};

  static constexpr auto kDefinition = define(
      82, "SET_ATTITUDE_TARGET",
      SKEIN_MAVLINK_FIELDS(SetAttitudeTarget, time_boot_ms, q, body_roll_rate, body_pitch_rate,
                           body_yaw_rate, thrust, target_system, target_component, type_mask),
      SKEIN_MAVLINK_FIELDS(SetAttitudeTarget, thrust_body));
};

/// Position, velocity, acceleration and yaw to fly; a set bit of the mask means ignore.
struct SetPositionTargetLocalNed {
  std::uint32_t time_boot_ms = 0;   ///< ms
  float x = 0, y = 0, z = 0;        ///< m
  float vx = 0, vy = 0, vz = 0;     ///< m/s
  float afx = 0, afy = 0, afz = 0;  ///< m/s/s
  float yaw = 0;                    ///< rad
  float yaw_rate = 0;               ///< rad/s
  std::uint16_t type_mask = 0;
  std::uint8_t target_system = 0, target_component = 0, coordinate_frame = 0;

  static constexpr auto kDefinition =
      define(84, "SET_POSITION_TARGET_LOCAL_NED",
             SKEIN_MAVLINK_FIELDS(SetPositionTargetLocalNed, time_boot_ms, x, y, z, vx, vy, vz, afx,
                                  afy, afz, yaw, yaw_rate, type_mask, target_system,
                                  target_component, coordinate_frame));
};

/// As SetPositionTargetLocalNed, with latitude and longitude.
struct SetPositionTargetGlobalInt {
  std::uint32_t time_boot_ms = 0;   ///< ms
  std::int32_t lat_int = 0;         ///< degE7
  std::int32_t lon_int = 0;         ///< degE7
  float alt = 0;                    ///< m
  float vx = 0, vy = 0, vz = 0;     ///< m/s
  float afx = 0, afy = 0, afz = 0;  ///< m/s/s
  float yaw = 0;                    ///< rad
  float yaw_rate = 0;               ///< rad/s
  std::uint16_t type_mask = 0;
  std::uint8_t target_system = 0, target_component = 0, coordinate_frame = 0;

  static constexpr auto kDefinition =
      define(86, "SET_POSITION_TARGET_GLOBAL_INT",
             SKEIN_MAVLINK_FIELDS(SetPositionTargetGlobalInt, time_boot_ms, lat_int, lon_int, alt,
                                  vx, vy, vz, afx, afy, afz, yaw, yaw_rate, type_mask,
                                  target_system, target_component, coordinate_frame));
};

}  // namespace skein::mavlink
