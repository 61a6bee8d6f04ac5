// SPDX-License-Identifier: Apache-2.0
#include "skein/agencies/mavlink_feed.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "remote_id_feed.hpp"
#include "skein/base/angles.hpp"
#include "skein/mavlink/enums.hpp"

namespace skein::agencies {
namespace {

/// Of MISSION_CURRENT.
constexpr std::uint8_t kNoMission = 1;
constexpr std::uint8_t kActive = 3;
constexpr std::uint16_t kUnknownU16 = std::numeric_limits<std::uint16_t>::max();

std::uint32_t boot_ms(Instant t) {
  const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(t.time_since_epoch());
  return static_cast<std::uint32_t>(std::max<std::int64_t>(ms.count(), 0));
}

template <class Whole>
Whole rounded(double value) {
  return static_cast<Whole>(
      std::llround(std::clamp(value, static_cast<double>(std::numeric_limits<Whole>::min()),
                              static_cast<double>(std::numeric_limits<Whole>::max()))));
}

std::int8_t percent_of(const VehicleState& state) {
  return state.battery_percent <= kBatteryFull_percent
             ? static_cast<std::int8_t>(state.battery_percent)
             : std::int8_t{-1};
}

mavlink::Heartbeat heartbeat_of(const ShownVehicle& vehicle) {
  using enum FlightPhase;
  const FlightPhase phase = vehicle.state.phase;
  const bool armed = phase == flying || phase == landing || phase == landed;
  const bool said_to_fly = phase == not_told && vehicle.activity != mission::Activity::landed;
  mavlink::Heartbeat message;
  message.custom_mode = static_cast<std::uint32_t>(vehicle.activity);
  message.type = static_cast<std::uint8_t>(vehicle.copter ? mavlink::VehicleType::quadrotor
                                                          : mavlink::VehicleType::fixed_wing);
  message.autopilot = static_cast<std::uint8_t>(mavlink::Autopilot::generic);
  message.base_mode = mavlink::mode_custom_enabled | mavlink::mode_auto_enabled |
                      mavlink::mode_guided_enabled |
                      (armed || said_to_fly ? mavlink::mode_safety_armed : 0);
  message.system_status = static_cast<std::uint8_t>(
      armed || said_to_fly ? mavlink::SystemState::active : mavlink::SystemState::standby);
  return message;
}

mavlink::SysStatus sys_status_of(const ShownVehicle& vehicle) {
  mavlink::SysStatus message;
  const std::uint32_t sensors = mavlink::sensor_gps | mavlink::sensor_ahrs |
                                (percent_of(vehicle.state) >= 0 ? mavlink::sensor_battery : 0U);
  message.onboard_control_sensors_present = message.onboard_control_sensors_enabled = sensors;
  message.onboard_control_sensors_health = sensors;
  message.voltage_battery = kUnknownU16;
  message.current_battery = -1;
  message.battery_remaining = percent_of(vehicle.state);
  return message;
}

mavlink::BatteryStatus battery_of(const ShownVehicle& vehicle) {
  mavlink::BatteryStatus message;
  message.current_consumed = message.energy_consumed = -1;
  message.temperature = std::numeric_limits<std::int16_t>::max();
  message.voltages.fill(kUnknownU16);
  message.current_battery = -1;
  message.battery_remaining = percent_of(vehicle.state);
  return message;
}

mavlink::GlobalPositionInt position_of(const ShownVehicle& vehicle) {
  const VehicleState& state = vehicle.state;
  const Eigen::Vector3d velocity_ned = ned_from_enu(state.velocity_mps());
  mavlink::GlobalPositionInt message;
  message.time_boot_ms = boot_ms(state.time);
  message.lat = rounded<std::int32_t>(vehicle.place.latitude_deg * 1e7);
  message.lon = rounded<std::int32_t>(vehicle.place.longitude_deg * 1e7);
  message.alt = rounded<std::int32_t>(vehicle.place.height_m * 1e3);
  message.relative_alt = rounded<std::int32_t>(state.z_m * 1e3);
  message.vx = rounded<std::int16_t>(velocity_ned.x() * 1e2);
  message.vy = rounded<std::int16_t>(velocity_ned.y() * 1e2);
  message.vz = rounded<std::int16_t>(velocity_ned.z() * 1e2);
  // 360 degrees are 0: what rounds up to them, too.
  message.hdg = static_cast<std::uint16_t>(
      std::lround(compass_deg_from_heading(state.heading_rad) * 1e2) % 36'000);
  return message;
}

mavlink::Attitude attitude_of(const ShownVehicle& vehicle) {
  mavlink::Attitude message;
  message.time_boot_ms = boot_ms(vehicle.state.time);
  message.yaw = static_cast<float>(yaw_from_heading(vehicle.state.heading_rad));
  return message;
}

mavlink::VfrHud hud_of(const ShownVehicle& vehicle) {
  const VehicleState& state = vehicle.state;
  mavlink::VfrHud message;
  message.airspeed = static_cast<float>(state.airspeed_mps);
  message.groundspeed = static_cast<float>(state.groundspeed_mps);
  message.alt = static_cast<float>(vehicle.place.height_m);
  message.climb = static_cast<float>(state.climb_mps);
  message.heading =
      static_cast<std::int16_t>(std::lround(compass_deg_from_heading(state.heading_rad)) % 360);
  return message;
}

}  // namespace

/// Of the way that it has planned; nobody is answered who asks for its items.
void MavlinkFeed::say_mission(System& system, const Shown& shown, VehicleId vehicle,
                              std::vector<mavlink::WireBytes>& due) const {
  const auto track = std::ranges::find(shown.tracks, vehicle, &ShownTrack::vehicle);
  mavlink::MissionCurrent current;
  if (track == shown.tracks.end()) {
    current.total = kUnknownU16;
    current.mission_state = kNoMission;
    due.push_back(system.encoder.encode(current));
    return;
  }
  current.seq = track->leg;
  current.total = track->legs;
  current.mission_state = kActive;
  due.push_back(system.encoder.encode(current));
  mavlink::NavControllerOutput output;
  output.wp_dist = rounded<std::uint16_t>(track->left_m);
  due.push_back(system.encoder.encode(output));
}

/// HEARTBEAT has a number for it, which others have no name for.
void MavlinkFeed::say_activity(System& system, const ShownVehicle& vehicle,
                               std::vector<mavlink::WireBytes>& due) const {
  if (system.told == vehicle.activity) return;
  system.told = vehicle.activity;
  mavlink::Statustext message;
  message.severity = static_cast<std::uint8_t>(mavlink::Severity::info);
  message.text = mavlink::field_of<sizeof(message.text)>(to_string(vehicle.activity));
  due.push_back(system.encoder.encode(message));
}

MavlinkFeed::System& MavlinkFeed::system_of(VehicleId vehicle) {
  return systems_.try_emplace(vehicle, vehicle).first->second;
}

std::vector<mavlink::WireBytes> MavlinkFeed::update(const Shown& shown, Instant now,
                                                    std::int64_t unix_ns) {
  std::vector<mavlink::WireBytes> due;
  for (const ShownVehicle& vehicle : shown.vehicles) {
    if (vehicle.silent || vehicle.id.value == 0 || vehicle.id.value > kVehicleMax) continue;
    System& system = system_of(vehicle.id);
    if (!system.take_off) system.take_off = vehicle.place;
    say_activity(system, vehicle, due);
    if (system.heartbeat_at == Instant::min() || now - system.heartbeat_at >= kHeartbeatPeriod) {
      system.heartbeat_at = now;
      due.push_back(system.encoder.encode(heartbeat_of(vehicle)));
      due.push_back(system.encoder.encode(sys_status_of(vehicle)));
      due.push_back(system.encoder.encode(battery_of(vehicle)));
      say_mission(system, shown, vehicle.id, due);
      say_remote_id(system.encoder, shown, vehicle, *system.take_off, now, unix_ns, due);
    }
    const bool first = system.measured == Instant::min();
    if (!first && (vehicle.state.time <= system.measured || now - system.state_at < kStatePeriod)) {
      continue;
    }
    system.state_at = now;
    system.measured = vehicle.state.time;
    due.push_back(system.encoder.encode(position_of(vehicle)));
    due.push_back(system.encoder.encode(attitude_of(vehicle)));
    due.push_back(system.encoder.encode(hud_of(vehicle)));
  }
  return due;
}

std::vector<mavlink::WireBytes> MavlinkFeed::alarm(VehicleId vehicle, std::string_view text) {
  constexpr std::size_t kChunk = sizeof(mavlink::Statustext::text);
  constexpr std::size_t kChunksMax = 5;  // as long as one packet may be
  std::vector<mavlink::WireBytes> packets;
  if (vehicle.value == 0 || vehicle.value > kVehicleMax) return packets;
  text = text.substr(0, kChunk * kChunksMax - 1);
  System& system = system_of(vehicle);
  const bool whole = text.size() <= kChunk;
  // The last of several ends with a zero, and be it the only thing in it.
  const std::size_t chunks = whole ? 1 : text.size() / kChunk + 1;
  // Texts of one number are put together; 0 is for those of one piece.
  if (!whole) system.texts = static_cast<std::uint16_t>(std::max(1, (system.texts + 1) & 0xFFFF));
  for (std::size_t i = 0; i < chunks; ++i) {
    mavlink::Statustext message;
    message.severity = static_cast<std::uint8_t>(mavlink::Severity::warning);
    message.text = mavlink::field_of<kChunk>(text.substr(i * kChunk));
    message.id = whole ? 0 : system.texts;
    message.chunk_seq = static_cast<std::uint8_t>(i);
    packets.push_back(system.encoder.encode(message));
  }
  return packets;
}

}  // namespace skein::agencies
