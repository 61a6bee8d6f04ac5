// SPDX-License-Identifier: Apache-2.0
#include "steering.hpp"

#include <algorithm>
#include <cmath>

#include "skein/base/angles.hpp"
#include "skein/base/attitude.hpp"

namespace skein::ardupilot {
namespace {

constexpr double kBankMax_rad = radians(70.0);
/// Of the least turn radius: an aircraft rolls past the bank that is asked for before it settles.
constexpr double kRollReserve = 1.05;
constexpr double kClimbGain_per_s = 1.0;
constexpr double kClimbMax_mps = 3.0;

/// ArduPlane turns the mask over and then takes roll where bit 0 or bit 7 is set, pitch where bit 1
/// or 7 is, yaw where bit 2 or 7 is: so roll alone takes a set bit 7 ("ignore the attitude") and a
/// clear bit 0. With bit 7 clear it would hold the pitch of q, and no height.
constexpr std::uint8_t kRollAlone = mavlink::ignore_attitude | mavlink::ignore_thrust |
                                    mavlink::ignore_pitch_rate | mavlink::ignore_body_yaw_rate;

constexpr std::uint16_t kVelocityAlone =
    mavlink::ignore_x | mavlink::ignore_y | mavlink::ignore_z | mavlink::ignore_ax |
    mavlink::ignore_ay | mavlink::ignore_az | mavlink::ignore_yaw | mavlink::ignore_yaw_rate;

}  // namespace

double bank_for(const VehicleSpec& vehicle, const Setpoint& setpoint, const VehicleState& state) {
  const double airspeed = std::max(state.airspeed_mps, vehicle.speed_min_mps);
  const double rate_max = airspeed / (kRollReserve * vehicle.turn_radius_m);
  const double error = wrap_pi(setpoint.heading_rad - state.heading_rad);
  const double rate = std::clamp(vehicle.heading_gain_per_s * error, -rate_max, rate_max);
  // Headings count counter-clockwise, banks to the right.
  return std::clamp(-std::atan(airspeed * rate / kGravity_mps2), -kBankMax_rad, kBankMax_rad);
}

mavlink::SetAttitudeTarget roll_target(double bank_rad) {
  mavlink::SetAttitudeTarget target;
  target.q = {static_cast<float>(std::cos(bank_rad / 2.0)),
              static_cast<float>(std::sin(bank_rad / 2.0)), 0.0F, 0.0F};
  target.type_mask = kRollAlone;
  return target;
}

mavlink::SetPositionTargetLocalNed velocity_target(const Setpoint& setpoint,
                                                   const VehicleState& state) {
  const double climb =
      std::clamp(kClimbGain_per_s * (setpoint.height_m - state.z_m), -kClimbMax_mps, kClimbMax_mps);
  mavlink::SetPositionTargetLocalNed target;
  target.vx = static_cast<float>(setpoint.airspeed_mps * std::sin(setpoint.heading_rad));
  target.vy = static_cast<float>(setpoint.airspeed_mps * std::cos(setpoint.heading_rad));
  target.vz = static_cast<float>(-climb);
  target.type_mask = kVelocityAlone;
  target.coordinate_frame = static_cast<std::uint8_t>(mavlink::Frame::local_ned);
  return target;
}

mavlink::SetPositionTargetGlobalInt point_target(const PositionSetpoint& setpoint,
                                                 const MissionOrigin& origin,
                                                 double geoid_height_m) {
  const Wgs84 place = origin.to_wgs84({setpoint.x_m, setpoint.y_m, setpoint.z_m});
  mavlink::SetPositionTargetGlobalInt target;
  target.lat_int = static_cast<std::int32_t>(std::lround(place.latitude_deg * 1e7));
  target.lon_int = static_cast<std::int32_t>(std::lround(place.longitude_deg * 1e7));
  target.alt = static_cast<float>(place.height_m - geoid_height_m);
  target.vx = static_cast<float>(setpoint.vy_mps);
  target.vy = static_cast<float>(setpoint.vx_mps);
  target.vz = static_cast<float>(-setpoint.vz_mps);
  target.afx = static_cast<float>(setpoint.ay_mps2);
  target.afy = static_cast<float>(setpoint.ax_mps2);
  target.afz = static_cast<float>(-setpoint.az_mps2);
  target.yaw = static_cast<float>(wrap_pi(kPi / 2.0 - setpoint.yaw_rad));
  target.type_mask = mavlink::ignore_yaw_rate;
  target.coordinate_frame = static_cast<std::uint8_t>(mavlink::Frame::global_int);
  return target;
}

}  // namespace skein::ardupilot
