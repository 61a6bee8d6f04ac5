// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "skein/mavlink/definition.hpp"

/// Missions and the origin of the local frame.
/// Units stand at the fields: degE7 is 1e-7 degrees, cdeg 0.01 degrees, d% 0.1 percent, cA 0.01 A,
/// hJ 100 J. Field names are those of the MAVLink definitions: they are part of the checksum.
namespace skein::mavlink {

/// Asks for an item; ArduPilot asks with this one and takes a MissionItemInt.
struct MissionRequest {
  std::uint16_t seq = 0;
  std::uint8_t target_system = 0, target_component = 0, mission_type = 0;

  static constexpr auto kDefinition =
      define(40, "MISSION_REQUEST",
             SKEIN_MAVLINK_FIELDS(MissionRequest, seq, target_system, target_component),
             SKEIN_MAVLINK_FIELDS(MissionRequest, mission_type));
};

/// Asks for an item as MissionItemInt.
struct MissionRequestInt {
  std::uint16_t seq = 0;
  std::uint8_t target_system = 0, target_component = 0, mission_type = 0;

  static constexpr auto kDefinition =
      define(51, "MISSION_REQUEST_INT",
             SKEIN_MAVLINK_FIELDS(MissionRequestInt, seq, target_system, target_component),
             SKEIN_MAVLINK_FIELDS(MissionRequestInt, mission_type));
};

/// Goes on with the item `seq`.
struct MissionSetCurrent {
  std::uint16_t seq = 0;
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;

  static constexpr auto kDefinition =
      define(41, "MISSION_SET_CURRENT",
             SKEIN_MAVLINK_FIELDS(MissionSetCurrent, seq, target_system, target_component));
};

/// The item that is flown now.
struct MissionCurrent {
  std::uint16_t seq = 0;
  std::uint16_t total = 0;
  std::uint8_t mission_state = 0;
  std::uint8_t mission_mode = 0;
  std::uint32_t mission_id = 0, fence_id = 0, rally_points_id = 0;

  static constexpr auto kDefinition =
      define(42, "MISSION_CURRENT", SKEIN_MAVLINK_FIELDS(MissionCurrent, seq),
             SKEIN_MAVLINK_FIELDS(MissionCurrent, total, mission_state, mission_mode, mission_id,
                                  fence_id, rally_points_id));
};

/// Asks how many items there are; answered with MissionCount.
struct MissionRequestList {
  std::uint8_t target_system = 0, target_component = 0, mission_type = 0;

  static constexpr auto kDefinition =
      define(43, "MISSION_REQUEST_LIST",
             SKEIN_MAVLINK_FIELDS(MissionRequestList, target_system, target_component),
             SKEIN_MAVLINK_FIELDS(MissionRequestList, mission_type));
};

/// Starts the transfer of `count` items.
struct MissionCount {
  std::uint16_t count = 0;
  std::uint8_t target_system = 0, target_component = 0, mission_type = 0;
  std::uint32_t opaque_id = 0;

  static constexpr auto kDefinition =
      define(44, "MISSION_COUNT",
             SKEIN_MAVLINK_FIELDS(MissionCount, count, target_system, target_component),
             SKEIN_MAVLINK_FIELDS(MissionCount, mission_type, opaque_id));
};

/// Forgets the mission; answered with MissionAck.
struct MissionClearAll {
  std::uint8_t target_system = 0, target_component = 0, mission_type = 0;

  static constexpr auto kDefinition =
      define(45, "MISSION_CLEAR_ALL",
             SKEIN_MAVLINK_FIELDS(MissionClearAll, target_system, target_component),
             SKEIN_MAVLINK_FIELDS(MissionClearAll, mission_type));
};

/// The item `seq` was reached.
struct MissionItemReached {
  std::uint16_t seq = 0;

  static constexpr auto kDefinition =
      define(46, "MISSION_ITEM_REACHED", SKEIN_MAVLINK_FIELDS(MissionItemReached, seq));
};

/// Ends a transfer: MissionResult in `type`.
struct MissionAck {
  std::uint8_t target_system = 0, target_component = 0, type = 0, mission_type = 0;
  std::uint32_t opaque_id = 0;

  static constexpr auto kDefinition = define(
      47, "MISSION_ACK", SKEIN_MAVLINK_FIELDS(MissionAck, target_system, target_component, type),
      SKEIN_MAVLINK_FIELDS(MissionAck, mission_type, opaque_id));
};

/// An item of a mission; latitude and longitude in degE7.
struct MissionItemInt {
  float param1 = 0, param2 = 0, param3 = 0, param4 = 0;
  std::int32_t x = 0;
  std::int32_t y = 0;
  float z = 0;
  std::uint16_t seq = 0;
  std::uint16_t command = 0;
  std::uint8_t target_system = 0, target_component = 0, frame = 0, current = 0;
  std::uint8_t autocontinue = 0, mission_type = 0;

  static constexpr auto kDefinition = define(
      73, "MISSION_ITEM_INT",
      SKEIN_MAVLINK_FIELDS(MissionItemInt, param1, param2, param3, param4, x, y, z, seq, command,
                           target_system, target_component, frame, current, autocontinue),
      SKEIN_MAVLINK_FIELDS(MissionItemInt, mission_type));
};

/// The origin of the local frame.
struct GpsGlobalOrigin {
  std::int32_t latitude = 0;    ///< degE7
  std::int32_t longitude = 0;   ///< degE7
  std::int32_t altitude = 0;    ///< mm
  std::uint64_t time_usec = 0;  ///< us

  static constexpr auto kDefinition = define(
      49, "GPS_GLOBAL_ORIGIN", SKEIN_MAVLINK_FIELDS(GpsGlobalOrigin, latitude, longitude, altitude),
      SKEIN_MAVLINK_FIELDS(GpsGlobalOrigin, time_usec));
};

}  // namespace skein::mavlink
