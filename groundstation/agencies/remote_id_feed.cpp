// SPDX-License-Identifier: Apache-2.0
#include "remote_id_feed.hpp"

#include <algorithm>
#include <cmath>

#include "skein/base/angles.hpp"
#include "skein/mavlink/remote_id_words.hpp"

namespace skein::agencies {
namespace {

constexpr std::uint8_t kOnGround = 1;
constexpr std::uint8_t kAirborne = 2;
constexpr double kSpeedMost_mps = 254.0;
constexpr double kClimbMost_mps = 62.0;
constexpr std::int64_t kHour_ns = 3'600'000'000'000;

mavlink::OpenDroneIdLocation location_of(const ShownVehicle& vehicle, Instant now,
                                         std::int64_t unix_ns) {
  const VehicleState& state = vehicle.state;
  mavlink::OpenDroneIdLocation message;
  message.latitude = static_cast<std::int32_t>(std::lround(vehicle.place.latitude_deg * 1e7));
  message.longitude = static_cast<std::int32_t>(std::lround(vehicle.place.longitude_deg * 1e7));
  message.altitude_geodetic = static_cast<float>(vehicle.place.height_m);
  message.direction = static_cast<std::uint16_t>(
      std::lround(compass_deg_from_heading(state.course_rad) * 1e2) % 36'000);
  message.speed_horizontal = static_cast<std::uint16_t>(
      std::lround(100.0 * std::clamp(state.groundspeed_mps, 0.0, kSpeedMost_mps)));
  message.speed_vertical = static_cast<std::int16_t>(
      std::lround(100.0 * std::clamp(state.climb_mps, -kClimbMost_mps, kClimbMost_mps)));
  message.status = state.on_ground() ? kOnGround : kAirborne;
  const std::int64_t measured_ns = unix_ns - (now - state.time).count();
  message.timestamp = static_cast<float>(static_cast<double>(measured_ns % kHour_ns) * 1e-9);
  return message;
}

/// Who is shown, says a Remote ID and is heard, this one among them.
void set_group(mavlink::OpenDroneIdSystem& message, const Shown& shown,
               const ShownVehicle& vehicle) {
  std::uint16_t count = 0;
  double radius_m = 0.0;
  double lowest_m = vehicle.place.height_m;
  double highest_m = vehicle.place.height_m;
  for (const ShownVehicle& other : shown.vehicles) {
    if (!other.remote_id.exists() || other.silent) continue;
    ++count;
    radius_m = std::max(radius_m, std::hypot(other.state.x_m - vehicle.state.x_m,
                                             other.state.y_m - vehicle.state.y_m));
    lowest_m = std::min(lowest_m, other.place.height_m);
    highest_m = std::max(highest_m, other.place.height_m);
  }
  if (count < 2) return;
  message.area_count = count;
  message.area_radius = static_cast<std::uint16_t>(std::min(65'535.0, std::ceil(radius_m)));
  message.area_floor = static_cast<float>(lowest_m);
  message.area_ceiling = static_cast<float>(highest_m);
}

}  // namespace

void say_remote_id(mavlink::Encoder& encoder, const Shown& shown, const ShownVehicle& vehicle,
                   const Wgs84& take_off, Instant now, std::int64_t unix_ns,
                   std::vector<mavlink::WireBytes>& due) {
  const RemoteId& id = vehicle.remote_id;
  if (!id.exists()) return;
  using enum RemoteId::UaType;
  due.push_back(encoder.encode(
      mavlink::basic_id_of(id, vehicle.copter ? helicopter_or_multirotor : aeroplane)));
  due.push_back(encoder.encode(location_of(vehicle, now, unix_ns)));
  mavlink::OpenDroneIdSystem system = mavlink::system_of(id, take_off, unix_ns);
  set_group(system, shown, vehicle);
  due.push_back(encoder.encode(system));
  due.push_back(encoder.encode(mavlink::operator_id_of(id)));
  due.push_back(encoder.encode(mavlink::self_id_of(id)));
}

}  // namespace skein::agencies
