// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "skein/base/frames.hpp"

namespace skein {

/// What a vehicle says of itself by Remote ID (ASTM F3411; docs/agencies.md). Enumerations are
/// numbered as MAVLink's are.
struct RemoteId {
  enum class IdType : std::uint8_t {
    none,
    serial_number,
    registration,
    utm_assigned,
    session,
    count
  };
  enum class UaType : std::uint8_t {
    by_airframe,
    aeroplane,
    helicopter_or_multirotor,
    gyroplane,
    hybrid_lift,
    count
  };
  enum class Category : std::uint8_t { undeclared, open, specific, certified, count };

  std::string uas_id;  ///< of one vehicle; empty: it says nothing
  IdType id_type = IdType::serial_number;
  UaType ua_type = UaType::by_airframe;
  std::string operator_id;
  std::string description;  ///< free text, of what the flight is for
  Category category = Category::undeclared;
  std::uint8_t class_eu = 0;           ///< 0: undeclared; 1 to 7: C0 to C6
  std::optional<Wgs84> operator_at{};  ///< none: where the vehicle takes off
  /// Of those that fly as one, and how far around each the others are; alone: 1 and 0.
  std::uint16_t group_count = 1;
  double group_radius_m = 0.0;
  /// The vehicle is not ready without a transmitter that is.
  bool required = false;

  [[nodiscard]] bool exists() const { return !uas_id.empty(); }
};

}  // namespace skein
