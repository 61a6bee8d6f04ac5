// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "skein/mavlink/definition.hpp"

/// Reports that nothing here acts on; defined so that they are checked, counted and shown.
/// Units stand at the fields: degE7 is 1e-7 degrees, cdeg 0.01 degrees, d% 0.1 percent, cA 0.01 A,
/// hJ 100 J. Field names are those of the MAVLink definitions: they are part of the checksum.
namespace skein::mavlink {

/// Inertial sensors, in units of the firmware.
struct RawImu {
  std::uint64_t time_usec = 0;  ///< us
  std::int16_t xacc = 0, yacc = 0, zacc = 0;
  std::int16_t xgyro = 0, ygyro = 0, zgyro = 0;
  std::int16_t xmag = 0, ymag = 0, zmag = 0;
  std::uint8_t id = 0;
  std::int16_t temperature = 0;  ///< cdegC

  static constexpr auto kDefinition =
      define(27, "RAW_IMU",
             SKEIN_MAVLINK_FIELDS(RawImu, time_usec, xacc, yacc, zacc, xgyro, ygyro, zgyro, xmag,
                                  ymag, zmag),
             SKEIN_MAVLINK_FIELDS(RawImu, id, temperature));
};

/// The second inertial sensor.
struct ScaledImu2 {
  std::uint32_t time_boot_ms = 0;                ///< ms
  std::int16_t xacc = 0, yacc = 0, zacc = 0;     ///< mG
  std::int16_t xgyro = 0, ygyro = 0, zgyro = 0;  ///< mrad/s
  std::int16_t xmag = 0, ymag = 0, zmag = 0;     ///< mgauss
  std::int16_t temperature = 0;                  ///< cdegC

  static constexpr auto kDefinition =
      define(116, "SCALED_IMU2",
             SKEIN_MAVLINK_FIELDS(ScaledImu2, time_boot_ms, xacc, yacc, zacc, xgyro, ygyro, zgyro,
                                  xmag, ymag, zmag),
             SKEIN_MAVLINK_FIELDS(ScaledImu2, temperature));
};

/// The third inertial sensor.
struct ScaledImu3 {
  std::uint32_t time_boot_ms = 0;                ///< ms
  std::int16_t xacc = 0, yacc = 0, zacc = 0;     ///< mG
  std::int16_t xgyro = 0, ygyro = 0, zgyro = 0;  ///< mrad/s
  std::int16_t xmag = 0, ymag = 0, zmag = 0;     ///< mgauss
  std::int16_t temperature = 0;                  ///< cdegC

  static constexpr auto kDefinition =
      define(129, "SCALED_IMU3",
             SKEIN_MAVLINK_FIELDS(ScaledImu3, time_boot_ms, xacc, yacc, zacc, xgyro, ygyro, zgyro,
                                  xmag, ymag, zmag),
             SKEIN_MAVLINK_FIELDS(ScaledImu3, temperature));
};

/// Barometer.
struct ScaledPressure {
  std::uint32_t time_boot_ms = 0;           ///< ms
  float press_abs = 0;                      ///< hPa
  float press_diff = 0;                     ///< hPa
  std::int16_t temperature = 0;             ///< cdegC
  std::int16_t temperature_press_diff = 0;  ///< cdegC

  static constexpr auto kDefinition =
      define(29, "SCALED_PRESSURE",
             SKEIN_MAVLINK_FIELDS(ScaledPressure, time_boot_ms, press_abs, press_diff, temperature),
             SKEIN_MAVLINK_FIELDS(ScaledPressure, temperature_press_diff));
};

/// The second barometer.
struct ScaledPressure2 {
  std::uint32_t time_boot_ms = 0;           ///< ms
  float press_abs = 0;                      ///< hPa
  float press_diff = 0;                     ///< hPa
  std::int16_t temperature = 0;             ///< cdegC
  std::int16_t temperature_press_diff = 0;  ///< cdegC

  static constexpr auto kDefinition = define(
      137, "SCALED_PRESSURE2",
      SKEIN_MAVLINK_FIELDS(ScaledPressure2, time_boot_ms, press_abs, press_diff, temperature),
      SKEIN_MAVLINK_FIELDS(ScaledPressure2, temperature_press_diff));
};

/// What the outputs of the autopilot are at: a report.
struct ServoOutputRaw {
  std::uint32_t time_usec = 0;                                                   ///< us
  std::uint16_t servo1_raw = 0, servo2_raw = 0, servo3_raw = 0, servo4_raw = 0;  ///< us
  std::uint16_t servo5_raw = 0, servo6_raw = 0, servo7_raw = 0, servo8_raw = 0;  ///< us
  std::uint8_t port = 0;
  std::uint16_t servo9_raw = 0, servo10_raw = 0, servo11_raw = 0, servo12_raw = 0;   ///< us
  std::uint16_t servo13_raw = 0, servo14_raw = 0, servo15_raw = 0, servo16_raw = 0;  ///< us

  static constexpr auto kDefinition =
      define(36, "SERVO_OUTPUT_RAW",
             SKEIN_MAVLINK_FIELDS(ServoOutputRaw, time_usec, servo1_raw, servo2_raw, servo3_raw,
                                  servo4_raw, servo5_raw, servo6_raw, servo7_raw, servo8_raw, port),
             SKEIN_MAVLINK_FIELDS(ServoOutputRaw, servo9_raw, servo10_raw, servo11_raw, servo12_raw,
                                  servo13_raw, servo14_raw, servo15_raw, servo16_raw));
};

/// The pilot's sticks as received.
struct RcChannels {
  std::uint32_t time_boot_ms = 0;                                                ///< ms
  std::uint16_t chan1_raw = 0, chan2_raw = 0, chan3_raw = 0, chan4_raw = 0;      ///< us
  std::uint16_t chan5_raw = 0, chan6_raw = 0, chan7_raw = 0, chan8_raw = 0;      ///< us
  std::uint16_t chan9_raw = 0, chan10_raw = 0, chan11_raw = 0, chan12_raw = 0;   ///< us
  std::uint16_t chan13_raw = 0, chan14_raw = 0, chan15_raw = 0, chan16_raw = 0;  ///< us
  std::uint16_t chan17_raw = 0, chan18_raw = 0;                                  ///< us
  std::uint8_t chancount = 0;
  std::uint8_t rssi = 0;

  static constexpr auto kDefinition =
      define(65, "RC_CHANNELS",
             SKEIN_MAVLINK_FIELDS(RcChannels, time_boot_ms, chan1_raw, chan2_raw, chan3_raw,
                                  chan4_raw, chan5_raw, chan6_raw, chan7_raw, chan8_raw, chan9_raw,
                                  chan10_raw, chan11_raw, chan12_raw, chan13_raw, chan14_raw,
                                  chan15_raw, chan16_raw, chan17_raw, chan18_raw, chancount, rssi));
};

/// Supply of the board.
struct PowerStatus {
  std::uint16_t vcc = 0;     ///< mV
  std::uint16_t vservo = 0;  ///< mV
  std::uint16_t flags = 0;

  static constexpr auto kDefinition = define(125, "POWER_STATUS", [](auto& visit) {
    visit(field("Vcc", &PowerStatus::vcc));
    visit(field("Vservo", &PowerStatus::vservo));
    visit(field("flags", &PowerStatus::flags));
  });
};

/// Memory of the board.
struct Meminfo {
  std::uint16_t brkval = 0;
  std::uint16_t freemem = 0;    ///< bytes
  std::uint32_t freemem32 = 0;  ///< bytes

  static constexpr auto kDefinition =
      define(152, "MEMINFO", SKEIN_MAVLINK_FIELDS(Meminfo, brkval, freemem),
             SKEIN_MAVLINK_FIELDS(Meminfo, freemem32));
};

/// Drift and errors of the attitude estimate.
struct Ahrs {
  float omega_ix = 0, omega_iy = 0, omega_iz = 0;  ///< rad/s
  float accel_weight = 0, renorm_val = 0, error_rp = 0, error_yaw = 0;

  static constexpr auto kDefinition = define(163, "AHRS", [](auto& visit) {
    visit(field("omegaIx", &Ahrs::omega_ix));
    visit(field("omegaIy", &Ahrs::omega_iy));
    visit(field("omegaIz", &Ahrs::omega_iz));
    visit(field("accel_weight", &Ahrs::accel_weight));
    visit(field("renorm_val", &Ahrs::renorm_val));
    visit(field("error_rp", &Ahrs::error_rp));
    visit(field("error_yaw", &Ahrs::error_yaw));
  });
};

/// The second estimate.
struct Ahrs2 {
  float roll = 0, pitch = 0, yaw = 0;  ///< rad
  float altitude = 0;                  ///< m
  std::int32_t lat = 0;                ///< degE7
  std::int32_t lng = 0;                ///< degE7

  static constexpr auto kDefinition =
      define(178, "AHRS2", SKEIN_MAVLINK_FIELDS(Ahrs2, roll, pitch, yaw, altitude, lat, lng));
};

/// Software in the loop only: the truth, with its height and velocity.
struct SimState {
  float q1 = 0, q2 = 0, q3 = 0, q4 = 0;
  float roll = 0, pitch = 0, yaw = 0;     ///< rad
  float xacc = 0, yacc = 0, zacc = 0;     ///< m/s/s
  float xgyro = 0, ygyro = 0, zgyro = 0;  ///< rad/s
  float lat = 0, lon = 0;                 ///< deg
  float alt = 0;                          ///< m
  float std_dev_horz = 0, std_dev_vert = 0;
  float vn = 0, ve = 0, vd = 0;  ///< m/s
  std::int32_t lat_int = 0;      ///< degE7
  std::int32_t lon_int = 0;      ///< degE7

  static constexpr auto kDefinition = define(
      108, "SIM_STATE",
      SKEIN_MAVLINK_FIELDS(SimState, q1, q2, q3, q4, roll, pitch, yaw, xacc, yacc, zacc, xgyro,
                           ygyro, zgyro, lat, lon, alt, std_dev_horz, std_dev_vert, vn, ve, vd),
      SKEIN_MAVLINK_FIELDS(SimState, lat_int, lon_int));
};

/// Software in the loop only: the truth.
struct Simstate {
  float roll = 0, pitch = 0, yaw = 0;     ///< rad
  float xacc = 0, yacc = 0, zacc = 0;     ///< m/s/s
  float xgyro = 0, ygyro = 0, zgyro = 0;  ///< rad/s
  std::int32_t lat = 0;                   ///< degE7
  std::int32_t lng = 0;                   ///< degE7

  static constexpr auto kDefinition =
      define(164, "SIMSTATE",
             SKEIN_MAVLINK_FIELDS(Simstate, roll, pitch, yaw, xacc, yacc, zacc, xgyro, ygyro, zgyro,
                                  lat, lng));
};

/// Height of the ground below.
struct TerrainReport {
  std::int32_t lat = 0;      ///< degE7
  std::int32_t lon = 0;      ///< degE7
  float terrain_height = 0;  ///< m
  float current_height = 0;  ///< m
  std::uint16_t spacing = 0, pending = 0, loaded = 0;

  static constexpr auto kDefinition =
      define(136, "TERRAIN_REPORT",
             SKEIN_MAVLINK_FIELDS(TerrainReport, lat, lon, terrain_height, current_height, spacing,
                                  pending, loaded));
};

/// Asks for terrain data.
struct TerrainRequest {
  std::uint64_t mask = 0;
  std::int32_t lat = 0;            ///< degE7
  std::int32_t lon = 0;            ///< degE7
  std::uint16_t grid_spacing = 0;  ///< m

  static constexpr auto kDefinition = define(
      133, "TERRAIN_REQUEST", SKEIN_MAVLINK_FIELDS(TerrainRequest, mask, lat, lon, grid_spacing));
};

/// One airspeed sensor.
struct Airspeed {
  float airspeed = 0;            ///< m/s
  float raw_press = 0;           ///< hPa
  std::int16_t temperature = 0;  ///< cdegC
  std::uint8_t id = 0;
  std::uint8_t flags = 0;

  static constexpr auto kDefinition = define(
      295, "AIRSPEED", SKEIN_MAVLINK_FIELDS(Airspeed, airspeed, raw_press, temperature, id, flags));
};

/// Alpha and side slip (beta).
struct AoaSsa {
  std::uint64_t time_usec = 0;  ///< us
  float alpha = 0;              ///< deg
  float side_slip = 0;          ///< deg

  static constexpr auto kDefinition = define(11020, "AOA_SSA", [](auto& visit) {
    visit(field("time_usec", &AoaSsa::time_usec));
    visit(field("AOA", &AoaSsa::alpha));
    visit(field("SSA", &AoaSsa::side_slip));
  });
};

/// Motors 1 to 4.
struct EscTelemetry1To4 {
  std::array<std::uint16_t, 4> voltage{};       ///< cV
  std::array<std::uint16_t, 4> current{};       ///< cA
  std::array<std::uint16_t, 4> totalcurrent{};  ///< mAh
  std::array<std::uint16_t, 4> rpm{};           ///< rpm
  std::array<std::uint16_t, 4> count{};
  std::array<std::uint8_t, 4> temperature{};  ///< degC

  static constexpr auto kDefinition =
      define(11030, "ESC_TELEMETRY_1_TO_4",
             SKEIN_MAVLINK_FIELDS(EscTelemetry1To4, voltage, current, totalcurrent, rpm, count,
                                  temperature));
};

}  // namespace skein::mavlink
