// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "skein/mavlink/definition.hpp"

/// Parameters of the autopilot.
/// Units stand at the fields: degE7 is 1e-7 degrees, cdeg 0.01 degrees, d% 0.1 percent, cA 0.01 A,
/// hJ 100 J. Field names are those of the MAVLink definitions: they are part of the checksum.
namespace skein::mavlink {

/// Asks for one parameter: by index, or by name with index -1.
struct ParamRequestRead {
  std::int16_t param_index = 0;
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::array<char, 16> param_id{};

  static constexpr auto kDefinition =
      define(20, "PARAM_REQUEST_READ",
             SKEIN_MAVLINK_FIELDS(ParamRequestRead, param_index, target_system, target_component,
                                  param_id));
};

/// Asks for all parameters.
struct ParamRequestList {
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;

  static constexpr auto kDefinition =
      define(21, "PARAM_REQUEST_LIST",
             SKEIN_MAVLINK_FIELDS(ParamRequestList, target_system, target_component));
};

/// A parameter. The name ends at a zero or after 16 characters.
struct ParamValue {
  float param_value = 0;
  std::uint16_t param_count = 0;
  std::uint16_t param_index = 0;
  std::array<char, 16> param_id{};
  std::uint8_t param_type = 0;

  static constexpr auto kDefinition =
      define(22, "PARAM_VALUE",
             SKEIN_MAVLINK_FIELDS(ParamValue, param_value, param_count, param_index, param_id,
                                  param_type));
};

/// Sets a parameter; answered with ParamValue.
struct ParamSet {
  float param_value = 0;
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::array<char, 16> param_id{};
  std::uint8_t param_type = 0;

  static constexpr auto kDefinition =
      define(23, "PARAM_SET",
             SKEIN_MAVLINK_FIELDS(ParamSet, param_value, target_system, target_component, param_id,
                                  param_type));
};

}  // namespace skein::mavlink
