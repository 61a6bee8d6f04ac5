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
/// PSC_VELXY_P of an ArduCopter, by default: what an error of the velocity accelerates it by. It
/// drops the acceleration of a global position, so that the velocity has to ask for it.
constexpr double kVelocityGain_per_s = 2.0;
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

double bank_for(const VehicleSpec& vehicle, const Setpoint& setpoint, const VehicleState& state,
                double ability) {
  const double airspeed = std::max(state.airspeed_mps, vehicle.speed_min_mps);
  const double rate_max = airspeed / (kRollReserve * vehicle.turn_radius_m);
  const double error = wrap_pi(setpoint.heading_rad - state.heading_rad);
  const double rate = std::clamp(vehicle.heading_gain_per_s * error, -rate_max, rate_max);
  // Headings count counter-clockwise, banks to the right.
  return std::clamp(-std::atan(airspeed * rate / (kGravity_mps2 * ability)), -kBankMax_rad,
                    kBankMax_rad);
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
  const Vec2 over_ground = setpoint.airspeed_mps * unit_vector(setpoint.heading_rad);
  const Eigen::Vector3f velocity =
      ned_from_enu({over_ground.x(), over_ground.y(), climb}).cast<float>();
  target.vx = velocity.x();
  target.vy = velocity.y();
  target.vz = velocity.z();
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
  Eigen::Vector3d ahead = setpoint.velocity_mps();
  ahead.head<2>() += setpoint.acceleration_mps2().head<2>() / kVelocityGain_per_s;
  const Eigen::Vector3f velocity = ned_from_enu(ahead).cast<float>();
  target.vx = velocity.x();
  target.vy = velocity.y();
  target.vz = velocity.z();
  const Eigen::Vector3f acceleration = ned_from_enu(setpoint.acceleration_mps2()).cast<float>();
  target.afx = acceleration.x();
  target.afy = acceleration.y();
  target.afz = acceleration.z();
  target.yaw = static_cast<float>(yaw_from_heading(setpoint.yaw_rad));
  target.type_mask = mavlink::ignore_yaw_rate;
  target.coordinate_frame = static_cast<std::uint8_t>(mavlink::Frame::global_int);
  return target;
}

}  // namespace skein::ardupilot
