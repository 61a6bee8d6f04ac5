// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "skein/base/frames.hpp"
#include "skein/base/geometry.hpp"
#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"
#include "skein/domain/task.hpp"
#include "skein/idl/domain.hpp"

namespace skein {

/// Where a vehicle ends its flight: at its start, for which it keeps the range, or where it is.
enum class Recovery : std::uint8_t { home, anywhere, count };

/// What it flies as. plane: a fixed wing, by heading and airspeed; copter: a multirotor, by
/// position; quadplane: a plane in all but that rotors lift it off and set it down.
enum class Airframe : std::uint8_t { plane, copter, quadplane, count };
/// "plane"
[[nodiscard]] constexpr std::string_view to_string(Airframe airframe) {
  constexpr std::array<std::string_view, static_cast<std::size_t>(Airframe::count)> kNames{
      "plane", "copter", "quadplane"};
  return kNames.at(static_cast<std::size_t>(airframe));
}

/// Where a vehicle lands. What is not given is as it was at the start of its first flight plan: the
/// place, and the heading, since who took off into the wind lands into it.
struct LandingSpec {
  std::optional<double> x_m{};  ///< touch-down, mission frame
  std::optional<double> y_m{};
  std::optional<double> heading_rad{};  ///< of the final approach
  double approach_m = 600.0;            ///< its length over the ground; of planes
  double approach_height_m = 40.0;      ///< above home, where it begins
};

/// What a vehicle is (Wang 2022, eq. 2-4).
struct VehicleSpec {
  VehicleId id;
  double cruise_speed_mps = 0.0;  ///< v; paths are planned at it
  double speed_min_mps = 0.0;     ///< airspeed limits, for keeping time in wind
  double speed_max_mps = 0.0;
  double turn_radius_m = 0.0;       ///< r_min, at cruise speed
  double heading_gain_per_s = 1.0;  ///< W: d heading/dt = W (commanded - heading)
  double range_m = 0.0;             ///< L_max
  /// Kept in the battery: a full one flies range_m down to it, and below it nothing counts as
  /// range. Below 100.
  double battery_reserve_percent = 20.0;
  Recovery recovery = Recovery::home;
  Capabilities capabilities;
  double sensor_radius_m = 0.0;   ///< C^r: detection and the survey arc
  double assess_radius_m = 0.0;   ///< C^e: the assessment arc
  std::uint8_t loads = 0;         ///< C^s at the start
  double final_approach_m = 0.0;  ///< L^s: straight run into the site
  double height_m = 0.0;          ///< the vehicle's layer, above the mission origin
  /// Paths are planned at this factor times turn_radius_m, so that wind and tracking errors can be
  /// corrected without flying below the turn radius. >= 1.
  double turn_radius_margin = 1.1;
  Airframe airframe = Airframe::plane;
  double acceleration_max_mps2 = 3.0;  ///< horizontal, of a copter; a plane's is in its turn radius
  LandingSpec landing;

  [[nodiscard]] bool is_copter() const { return airframe == Airframe::copter; }
  /// It leaves the ground where it stands.
  [[nodiscard]] bool lifts_off() const { return airframe != Airframe::plane; }
  [[nodiscard]] double planning_radius_m() const { return turn_radius_m * turn_radius_margin; }
};

inline constexpr std::uint8_t kBatteryFull_percent = 100;
inline constexpr std::uint8_t kBatteryNotTold = 255;

/// What the flight controller reports. Trivially copyable.
struct VehicleState {
  Instant time{};
  double x_m = 0.0;  ///< mission frame
  double y_m = 0.0;
  double z_m = 0.0;
  double heading_rad = 0.0;
  double course_rad = 0.0;  ///< of the velocity over the ground
  double groundspeed_mps = 0.0;
  double airspeed_mps = 0.0;
  double distance_flown_m =
      0.0;                 ///< over the ground, since the start; what the range budget counts
  double climb_mps = 0.0;  ///< of a multirotor; 0 where it is not known
  /// What its gauge says is left of a full battery; kBatteryNotTold where there is none.
  std::uint8_t battery_percent = kBatteryNotTold;
  FlightPhase phase = FlightPhase::not_told;
  [[nodiscard]] bool on_ground() const {
    return phase == FlightPhase::landed || phase == FlightPhase::disarmed;
  }
  [[nodiscard]] Pose2 pose() const { return {x_m, y_m, heading_rad}; }
  /// Where it goes: its course, and its nose where it stands or hovers, whose course is noise.
  [[nodiscard]] Pose2 pose_over_ground() const {
    constexpr double kCourseKnownAbove_mps = 1.0;
    return {x_m, y_m, groundspeed_mps > kCourseKnownAbove_mps ? course_rad : heading_rad};
  }
  [[nodiscard]] Position<MissionEnu> position() const { return {x_m, y_m, z_m}; }
  /// Over the ground, mission frame.
  [[nodiscard]] Eigen::Vector3d velocity_mps() const {
    const Vec2 horizontal = groundspeed_mps * unit_vector(course_rad);
    return {horizontal.x(), horizontal.y(), climb_mps};
  }
};

/// What control asks of the flight controller of a fixed wing. Trivially copyable.
struct Setpoint {
  double heading_rad = 0.0;  ///< commanded heading, see VehicleSpec::heading_gain_per_s
  double airspeed_mps = 0.0;
  double height_m = 0.0;
  /// Where it is to come down to, as far as it can by itself; until it does, the rest is flown.
  /// One without it, while it comes down, calls that off.
  std::optional<Landing> landing{};
};

/// What control asks of the flight controller of a multirotor: to be where a moving point is.
/// Mission frame. A point above the ground lifts a vehicle that stands on it; where the point stays
/// at the ground or below it, the vehicle lands. Trivially copyable.
struct PositionSetpoint {
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.0;
  double vx_mps = 0.0;
  double vy_mps = 0.0;
  double vz_mps = 0.0;
  double ax_mps2 = 0.0;
  double ay_mps2 = 0.0;
  double az_mps2 = 0.0;
  double yaw_rad = 0.0;  ///< of the nose, from east, counter-clockwise

  [[nodiscard]] Eigen::Vector3d position_m() const { return {x_m, y_m, z_m}; }
  [[nodiscard]] Eigen::Vector3d velocity_mps() const { return {vx_mps, vy_mps, vz_mps}; }
  [[nodiscard]] Eigen::Vector3d acceleration_mps2() const { return {ax_mps2, ay_mps2, az_mps2}; }
  [[nodiscard]] bool finite() const {
    return position_m().allFinite() && velocity_mps().allFinite() &&
           acceleration_mps2().allFinite() && std::isfinite(yaw_rad);
  }
  /// The point so much later, its acceleration unchanged.
  [[nodiscard]] PositionSetpoint carried_on(double seconds) const {
    const Eigen::Vector3d velocity = velocity_mps() + seconds * acceleration_mps2();
    const Eigen::Vector3d position = position_m() + 0.5 * seconds * (velocity_mps() + velocity);
    PositionSetpoint later = *this;
    later.x_m = position.x();
    later.y_m = position.y();
    later.z_m = position.z();
    later.vx_mps = velocity.x();
    later.vy_mps = velocity.y();
    later.vz_mps = velocity.z();
    return later;
  }
};

/// What control asks of a flight controller. Trivially copyable.
using Demand = std::variant<Setpoint, PositionSetpoint>;

}  // namespace skein
