// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "skein/base/frames.hpp"
#include "skein/base/geometry.hpp"
#include "skein/base/result.hpp"
#include "skein/base/time.hpp"
#include "skein/domain/vehicle.hpp"

namespace skein::hil {

/// A flight controller on a bus, with its aircraft. The defaults are those of ArduPilot where it
/// has them.
struct EmulatorConfig {
  Airframe airframe = Airframe::plane;

  std::uint8_t node_id = 10;          ///< DroneCAN, 1..127
  std::uint8_t companion_node = 42;   ///< CAN_D1_UC_S1_NOD: who may use the serial port
  std::int8_t serial_id = 0;          ///< CAN_D1_UC_S1_IDX, 0..15
  bool serial_port = true;            ///< CAN_D1_UC_SER_EN
  bool mavlink = true;                ///< CAN_D1_UC_S1_PRO 2; else the port is there, and empty
  bool fd = false;                    ///< sends CAN FD frames
  std::uint8_t system_id = 1;         ///< MAVLink
  std::uint8_t companion_system = 1;  ///< SYSID_MYGCS: whose heartbeat the failsafe waits for
  bool companion_failsafe = false;    ///< FS_GCS_ENABL and FS_LONG_ACTN; a companion needs them
  bool airborne = false;              ///< starts in flight, armed, in `mode`; else on the ground
  bool noise = true;                  ///< of the sensors
  std::vector<std::string> unknown_parameters;  ///< those that it says nothing of

  Wgs84 origin;                 ///< of the frame in which `start` is given
  Pose2 start;                  ///< mission frame
  double height_m = 0.0;        ///< above the origin, in flight
  std::string mode = "GUIDED";  ///< at the start in flight, as ArduPilot names it
  /// In flight the aircraft stands still at its start until then.
  Instant hold_until{};

  double airspeed_mps = 50.0;  ///< cruise; of a copter the greatest speed
  double climb_mps = 3.0;      ///< of a copter, up and down: WPNAV_SPEED_UP, WPNAV_SPEED_DN
  double airspeed_min_mps = 40.0;
  double airspeed_max_mps = 70.0;
  double turn_radius_m = 150.0;  ///< at cruise, that the bank limit must allow

  double fence_height_m = 0.0;  ///< FENCE_ALT_MAX, with RTL beyond the fence; 0: FENCE_ENABLE 0

  /// It signs what it says, and heeds nothing that is not signed with it.
  std::optional<std::array<std::uint8_t, 32>> signing_key;

  /// It has a transmitter of Remote ID, and does not arm without (DID_ENABLE, DID_OPTIONS 1).
  bool remote_id = false;

  double battery_mah = 16000.0;  ///< BATT_CAPACITY; 60 A at full throttle and 0.5 A besides

  Vec2 wind_mps{0.0, 0.0};      ///< where the air moves to, mission frame
  double gusts_wind_mps = 0.0;  ///< Dryden gusts of a wind of this speed at 6 m; 0 for none
  /// Short gusts as ArduPilot's simulator makes them with SIM_WIND_TURB at this, m/s.
  double turbulence_mps = 0.0;
  std::uint64_t seed = 1;    ///< of gusts and noise
  std::int64_t unix_us = 0;  ///< system time at Instant{}: what its satellites tell
};

/// ArduPilot's number of a mode, or nothing for one that is not emulated.
[[nodiscard]] std::optional<std::uint32_t> mode_named(Airframe airframe, std::string_view name);

/// Of a plane: the bank that flies the circle of `turn_radius_m` at cruise, and five degrees, ten
/// where it slips. Precondition: check(config).
[[nodiscard]] double bank_limit_rad(const EmulatorConfig& config);

/// Fails with one sentence for the first thing that cannot be.
[[nodiscard]] Result<void> check(const EmulatorConfig& config);

}  // namespace skein::hil
