// SPDX-License-Identifier: Apache-2.0
#include "skein/ardupilot/airframe.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace skein::ardupilot {
namespace {

using mavlink::CopterMode;
using mavlink::PlaneMode;

constexpr std::uint32_t number(PlaneMode mode) { return static_cast<std::uint32_t>(mode); }
constexpr std::uint32_t number(CopterMode mode) { return static_cast<std::uint32_t>(mode); }

// Those from 17 on are a quadplane's on its rotors.
constexpr std::array<NamedMode, 24> kPlaneModes{
    {{0, "MANUAL"},      {1, "CIRCLE"},      {2, "STABILIZE"}, {3, "TRAINING"},
     {4, "ACRO"},        {5, "FBWA"},        {6, "FBWB"},      {7, "CRUISE"},
     {8, "AUTOTUNE"},    {10, "AUTO"},       {11, "RTL"},      {12, "LOITER"},
     {13, "TAKEOFF"},    {14, "AVOID_ADSB"}, {15, "GUIDED"},   {16, "INITIALISING"},
     {17, "QSTABILIZE"}, {18, "QHOVER"},     {19, "QLOITER"},  {20, "QLAND"},
     {21, "QRTL"},       {22, "QAUTOTUNE"},  {23, "QACRO"},    {25, "LOITER2QLAND"}}};
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

constexpr std::array kPlaneReturns{number(PlaneMode::rtl)};
constexpr std::array kCopterReturns{number(CopterMode::rtl)};
constexpr std::array kQuadplaneReturns{number(PlaneMode::rtl), number(PlaneMode::q_rtl)};

constexpr std::array kPlaneTypes{static_cast<std::uint8_t>(mavlink::VehicleType::fixed_wing)};
/// What ArduCopter flies: 2 to 4 with four rotors, two or a helicopter's, 13 to 15 with six, eight
/// or three, 29 with twelve, 35 with ten.
constexpr std::array<std::uint8_t, 8> kCopterTypes{2, 3, 4, 13, 14, 15, 29, 35};
/// ArduPlane says what Q_ENABLE makes of it: by default a fixed wing, as told by Q_MAV_TYPE one of
/// the VTOLs (19 to 25).
constexpr std::array<std::uint8_t, 8> kQuadplaneTypes{1, 19, 20, 21, 22, 23, 24, 25};

// ArduPlane 4.6, FS_GCS_ENABL: 1 heartbeat, 2 heartbeat and REMRSSI; 3 is for AUTO alone.
constexpr std::array kPlaneFailsafe{1, 2};
constexpr std::array kPlaneAction{1};  // RTL; 0 flies on in GUIDED
// ArduCopter 4.6, FS_GCS_ENABLE: RTL, SmartRTL or RTL, SmartRTL or land, land, AUTO's landing or
// RTL, brake or land; 0 is off, 2 was taken away.
constexpr std::array kCopterFailsafe{1, 3, 4, 5, 6, 7};
constexpr std::array kOn{1};
constexpr std::array kOff{0};

constexpr std::string_view kFliesOn = "the autopilot flies on when the companion falls silent";
constexpr std::string_view kHearsOther = "the autopilot waits for another's heartbeat";
constexpr SafetyParameter kPlaneHeartbeat{"FS_GCS_ENABL", "", kPlaneFailsafe, kFliesOn};
constexpr SafetyParameter kPlaneLong{"FS_LONG_ACTN", "", kPlaneAction, kFliesOn};
constexpr SafetyParameter kGroundStation{"SYSID_MYGCS", "MAV_GCS_SYSID", {}, kHearsOther};

constexpr std::array kPlaneSafety{kPlaneHeartbeat, kPlaneLong, kGroundStation};
constexpr std::array kCopterSafety{SafetyParameter{"FS_GCS_ENABLE", "", kCopterFailsafe, kFliesOn},
                                   kGroundStation};
constexpr std::array kQuadplaneSafety{
    kPlaneHeartbeat, kPlaneLong, kGroundStation,
    SafetyParameter{"Q_ENABLE", "", kOn, "it has no rotors (0), or flies its approach on them (2)"},
    SafetyParameter{"Q_GUIDED_MODE", "", kOff,
                    "it hovers in GUIDED, and is not flown on its wings"}};

constexpr std::array kPlaneLimits{kRollLimit,      kAirspeedMin, kAirspeedMax,
                                  kAirspeedCruise, kSpeedWeight, kStallPrevention};
constexpr std::array kQuadplaneLimits{kRollLimit,   kAirspeedMin,     kAirspeedMax, kAirspeedCruise,
                                      kSpeedWeight, kStallPrevention, kAssistSpeed};
constexpr std::array kCopterLimits{kClimbSpeed, kSinkSpeed};

constexpr AirframeTraits kPlane{.modes = kPlaneModes,
                                .vehicle_types = kPlaneTypes,
                                .guided_mode = number(PlaneMode::guided),
                                .takeoff_mode = number(PlaneMode::takeoff),
                                .land_mode = number(PlaneMode::automatic),
                                .return_modes = kPlaneReturns,
                                .touch_down = mavlink::Command::nav_land,
                                .safety = kPlaneSafety,
                                .limits = kPlaneLimits};
constexpr AirframeTraits kCopter{.modes = kCopterModes,
                                 .vehicle_types = kCopterTypes,
                                 .guided_mode = number(CopterMode::guided),
                                 .takeoff_mode = number(CopterMode::guided),
                                 .land_mode = number(CopterMode::land),
                                 .return_modes = kCopterReturns,
                                 .flies_to_points = true,
                                 .is_lifted = true,
                                 .touch_down = {},
                                 .safety = kCopterSafety,
                                 .limits = kCopterLimits};
constexpr AirframeTraits kQuadplane{.modes = kPlaneModes,
                                    .vehicle_types = kQuadplaneTypes,
                                    .guided_mode = number(PlaneMode::guided),
                                    .takeoff_mode = number(PlaneMode::guided),
                                    .land_mode = number(PlaneMode::automatic),
                                    .return_modes = kQuadplaneReturns,
                                    .is_lifted = true,
                                    .hovers_first = true,
                                    .touch_down = mavlink::Command::nav_vtol_land,
                                    .safety = kQuadplaneSafety,
                                    .limits = kQuadplaneLimits};

/// In the order of Airframe.
constexpr std::array<AirframeTraits, static_cast<std::size_t>(Airframe::count)> kAirframes{
    kPlane, kCopter, kQuadplane};

}  // namespace

const AirframeTraits& traits_of(Airframe airframe) {
  return kAirframes.at(static_cast<std::size_t>(airframe));
}

bool AirframeTraits::is_return(std::uint32_t mode) const {
  return std::ranges::find(return_modes, mode) != return_modes.end();
}

bool AirframeTraits::is_of(std::uint8_t vehicle_type) const {
  return std::ranges::find(vehicle_types, vehicle_type) != vehicle_types.end();
}

std::string AirframeTraits::name_of(std::uint32_t mode) const {
  const auto found = std::ranges::find(modes, mode, &NamedMode::first);
  return found == modes.end() ? "mode " + std::to_string(mode) : std::string{found->second};
}

}  // namespace skein::ardupilot
