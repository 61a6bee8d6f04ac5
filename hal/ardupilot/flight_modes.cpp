// SPDX-License-Identifier: Apache-2.0
#include "flight_modes.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <utility>

namespace skein::ardupilot {
namespace {

using mavlink::CopterMode;
using mavlink::PlaneMode;
using NamedMode = std::pair<std::uint32_t, std::string_view>;

constexpr std::array<NamedMode, 16> kPlaneModes{{{0, "MANUAL"},
                                                 {1, "CIRCLE"},
                                                 {2, "STABILIZE"},
                                                 {3, "TRAINING"},
                                                 {4, "ACRO"},
                                                 {5, "FBWA"},
                                                 {6, "FBWB"},
                                                 {7, "CRUISE"},
                                                 {8, "AUTOTUNE"},
                                                 {10, "AUTO"},
                                                 {11, "RTL"},
                                                 {12, "LOITER"},
                                                 {13, "TAKEOFF"},
                                                 {14, "AVOID_ADSB"},
                                                 {15, "GUIDED"},
                                                 {16, "INITIALISING"}}};
constexpr std::array<NamedMode, 10> kCopterModes{{{0, "STABILIZE"},
                                                  {1, "ACRO"},
                                                  {2, "ALT_HOLD"},
                                                  {3, "AUTO"},
                                                  {4, "GUIDED"},
                                                  {5, "LOITER"},
                                                  {6, "RTL"},
                                                  {7, "CIRCLE"},
                                                  {9, "LAND"},
                                                  {17, "BRAKE"}}};

/// HEARTBEAT `type` of what ArduCopter flies: 2 to 4 with four rotors, two or a helicopter's, 13 to
/// 15 with six, eight or three, 29 with twelve, 35 with ten.
constexpr std::array<std::uint8_t, 8> kCopterTypes{2, 3, 4, 13, 14, 15, 29, 35};

}  // namespace

std::uint32_t guided_mode(Airframe airframe) {
  return airframe == Airframe::copter ? static_cast<std::uint32_t>(CopterMode::guided)
                                      : static_cast<std::uint32_t>(PlaneMode::guided);
}

std::uint32_t takeoff_mode(Airframe airframe) {
  return airframe == Airframe::copter ? static_cast<std::uint32_t>(CopterMode::guided)
                                      : static_cast<std::uint32_t>(PlaneMode::takeoff);
}

bool is_return(Airframe airframe, std::uint32_t mode) {
  return mode == (airframe == Airframe::copter ? static_cast<std::uint32_t>(CopterMode::rtl)
                                               : static_cast<std::uint32_t>(PlaneMode::rtl));
}

std::uint32_t land_mode(Airframe airframe) {
  return airframe == Airframe::copter ? static_cast<std::uint32_t>(CopterMode::land)
                                      : static_cast<std::uint32_t>(PlaneMode::automatic);
}

std::string name_of_mode(Airframe airframe, std::uint32_t mode) {
  const std::span<const NamedMode> names = airframe == Airframe::copter
                                               ? std::span<const NamedMode>{kCopterModes}
                                               : std::span<const NamedMode>{kPlaneModes};
  const auto found = std::find_if(names.begin(), names.end(),
                                  [mode](const NamedMode& named) { return named.first == mode; });
  return found == names.end() ? "mode " + std::to_string(mode) : std::string{found->second};
}

bool is_of(Airframe airframe, std::uint8_t vehicle_type) {
  if (airframe == Airframe::plane) {
    return vehicle_type == static_cast<std::uint8_t>(mavlink::VehicleType::fixed_wing);
  }
  return std::find(kCopterTypes.begin(), kCopterTypes.end(), vehicle_type) != kCopterTypes.end();
}

}  // namespace skein::ardupilot
