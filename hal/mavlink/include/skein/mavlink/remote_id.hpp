// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "skein/mavlink/definition.hpp"

/// Remote ID (ASTM F3411, ASD-STAN prEN 4709-002) as MAVLink carries it to a transmitter.
/// Units stand at the fields: degE7 is 1e-7 degrees, cdeg 0.01 degrees. Field names are those of
/// the MAVLink definitions: they are part of the checksum. `id_or_mac` is of others that were
/// received; of the aircraft itself it is zero.
namespace skein::mavlink {

/// Who it is.
struct OpenDroneIdBasicId {
  std::uint8_t target_system = 0, target_component = 0;
  std::array<std::uint8_t, 20> id_or_mac{};
  std::uint8_t id_type = 0, ua_type = 0;
  std::array<std::uint8_t, 20> uas_id{};  ///< ASCII, the rest zero

  static constexpr auto kDefinition =
      define(12900, "OPEN_DRONE_ID_BASIC_ID",
             SKEIN_MAVLINK_FIELDS(OpenDroneIdBasicId, target_system, target_component, id_or_mac,
                                  id_type, ua_type, uas_id));
};

/// Where it is; of an ArduPilot its transmitter is told that by itself.
struct OpenDroneIdLocation {
  std::int32_t latitude = 0, longitude = 0;  ///< degE7; both 0: not known
  float altitude_barometric = -1000.0F;      ///< m, by 1013.2 hPa; -1000: not known
  float altitude_geodetic = -1000.0F;        ///< m above WGS84's ellipsoid
  float height = -1000.0F;                   ///< m above height_reference
  float timestamp = 65535.0F;                ///< s since the full hour, UTC
  std::uint16_t direction = 36100;           ///< cdeg from north; 36100: not known
  std::uint16_t speed_horizontal = 25500;    ///< cm/s; 25500: not known
  std::int16_t speed_vertical = 6300;        ///< cm/s, upwards; 6300: not known
  std::uint8_t target_system = 0, target_component = 0;
  std::array<std::uint8_t, 20> id_or_mac{};
  std::uint8_t status = 0;            ///< 0 undeclared, 1 on the ground, 2 airborne, 3 emergency
  std::uint8_t height_reference = 0;  ///< 0: where it took off
  std::uint8_t horizontal_accuracy = 0, vertical_accuracy = 0, barometer_accuracy = 0,
               speed_accuracy = 0, timestamp_accuracy = 0;  ///< 0: not known

  static constexpr auto kDefinition =
      define(12901, "OPEN_DRONE_ID_LOCATION",
             SKEIN_MAVLINK_FIELDS(OpenDroneIdLocation, latitude, longitude, altitude_barometric,
                                  altitude_geodetic, height, timestamp, direction, speed_horizontal,
                                  speed_vertical, target_system, target_component, id_or_mac,
                                  status, height_reference, horizontal_accuracy, vertical_accuracy,
                                  barometer_accuracy, speed_accuracy, timestamp_accuracy));
};

/// What the flight is for.
struct OpenDroneIdSelfId {
  std::uint8_t target_system = 0, target_component = 0;
  std::array<std::uint8_t, 20> id_or_mac{};
  std::uint8_t description_type = 0;  ///< 0: text
  std::array<char, 23> description{};

  static constexpr auto kDefinition =
      define(12903, "OPEN_DRONE_ID_SELF_ID",
             SKEIN_MAVLINK_FIELDS(OpenDroneIdSelfId, target_system, target_component, id_or_mac,
                                  description_type, description));
};

/// Where the operator is, and of how many that fly as one it is.
struct OpenDroneIdSystem {
  std::int32_t operator_latitude = 0, operator_longitude = 0;  ///< degE7; both 0: not known
  float area_ceiling = -1000.0F, area_floor = -1000.0F;        ///< m above the ellipsoid; not known
  float operator_altitude_geo = -1000.0F;                      ///< m above the ellipsoid
  std::uint32_t timestamp = 0;                                 ///< s since 2019-01-01 UTC
  std::uint16_t area_count = 1;
  std::uint16_t area_radius = 0;  ///< m
  std::uint8_t target_system = 0, target_component = 0;
  std::array<std::uint8_t, 20> id_or_mac{};
  std::uint8_t operator_location_type = 0;  ///< 0: where it took off, 1: live, 2: fixed
  std::uint8_t classification_type = 0;     ///< 1: of the European Union
  std::uint8_t category_eu = 0, class_eu = 0;

  static constexpr auto kDefinition = define(
      12904, "OPEN_DRONE_ID_SYSTEM",
      SKEIN_MAVLINK_FIELDS(OpenDroneIdSystem, operator_latitude, operator_longitude, area_ceiling,
                           area_floor, operator_altitude_geo, timestamp, area_count, area_radius,
                           target_system, target_component, id_or_mac, operator_location_type,
                           classification_type, category_eu, class_eu));
};

/// Whose it is.
struct OpenDroneIdOperatorId {
  std::uint8_t target_system = 0, target_component = 0;
  std::array<std::uint8_t, 20> id_or_mac{};
  std::uint8_t operator_id_type = 0;  ///< 0: of the aviation authority
  std::array<char, 20> operator_id{};

  static constexpr auto kDefinition =
      define(12905, "OPEN_DRONE_ID_OPERATOR_ID",
             SKEIN_MAVLINK_FIELDS(OpenDroneIdOperatorId, target_system, target_component, id_or_mac,
                                  operator_id_type, operator_id));
};

/// Of the transmitter, once a second: whether it has what it needs.
struct OpenDroneIdArmStatus {
  std::uint8_t status = 0;  ///< 0: good to arm; else `error` says why not
  std::array<char, 50> error{};

  static constexpr auto kDefinition = define(
      12918, "OPEN_DRONE_ID_ARM_STATUS", SKEIN_MAVLINK_FIELDS(OpenDroneIdArmStatus, status, error));
};

}  // namespace skein::mavlink
