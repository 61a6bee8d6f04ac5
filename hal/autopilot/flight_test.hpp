// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "skein/autopilot/fixed_wing_loops.hpp"
#include "skein/autopilot/hexarotor_loops.hpp"
#include "skein/models/dryden_gusts.hpp"
#include "skein/models/fixed_wing.hpp"
#include "skein/models/hexarotor.hpp"
#include "skein/models/sensors.hpp"

namespace skein::autopilot {

/// A fixed wing in wind, with an estimate from noisy sensors, for the tests of this module.
class TestFlight {
 public:
  static constexpr double kControl_s = 0.01;

  struct Conditions {
    double airspeed_mps = 50.0;
    double heading_rad = 0.0;
    double height_m = 300.0;       ///< 0 for on its wheels, at rest
    Vec3 wind_mps = Vec3::Zero();  ///< NED
    double gusts_wind_mps = 0.0;   ///< the wind at 6 m that makes the gusts
    std::uint64_t seed = 1;
    bool noise = false;
  };

  explicit TestFlight(const Conditions& c)
      : conditions_{c},
        gusts_{c.gusts_wind_mps, c.seed},
        imu_{{}, c.seed + 1},
        random_{c.seed + 2},
        plane_{start(c)} {}

  /// One control period under a command; models::FixedWing takes two steps.
  void advance(const SurfaceCommand& command) {
    for (int i = 0; i < 2; ++i) {
      const double airspeed = models::air_data(plane_.state(), wind_).airspeed_mps;
      (void)gusts_.step(kControl_s / 2, airspeed, -plane_.state().position_m.z());
      wind_ = conditions_.wind_mps +
              gusts_.velocity_ned_mps(euler_angles(plane_.state().attitude).yaw_rad);
      plane_.step({command.elevator_rad, command.aileron_rad, command.rudder_rad, command.throttle},
                  wind_, kControl_s / 2);
    }
    seconds_ += kControl_s;
  }

  [[nodiscard]] Estimate estimate() {
    const models::RigidBodyState& state = plane_.state();
    Estimate e;
    e.position_m = state.position_m;
    e.velocity_mps = state.velocity_ned_mps();
    e.attitude = state.attitude;
    e.rates_radps = state.rates_radps;
    e.specific_force_mps2 = plane_.specific_force(wind_);
    e.airspeed_mps = airspeed_mps();
    if (conditions_.noise) {
      const models::ImuSample sample = imu_.sample(state, e.specific_force_mps2, kControl_s);
      e.rates_radps = sample.rates_radps - imu_.gyro_bias_radps();
      e.specific_force_mps2 = sample.specific_force_mps2;
      e.velocity_mps.x() += random_.normal(0.0, 0.05);
      e.velocity_mps.y() += random_.normal(0.0, 0.05);
      e.velocity_mps.z() += random_.normal(0.0, 0.1);
      e.position_m.z() += random_.normal(0.0, 0.2);
      e.airspeed_mps += random_.normal(0.0, 0.2);
    }
    return e;
  }

  [[nodiscard]] double airspeed_mps() const {
    return models::air_data(plane_.state(), wind_).airspeed_mps;
  }
  [[nodiscard]] double seconds() const { return seconds_; }
  [[nodiscard]] const models::FixedWing& plane() const { return plane_; }
  [[nodiscard]] double height_m() const { return -plane_.state().position_m.z(); }
  [[nodiscard]] double course_rad() const {
    const Vec3 v = plane_.state().velocity_ned_mps();
    return std::atan2(v.y(), v.x());
  }

 private:
  static models::FixedWing start(const Conditions& c) {
    const models::FixedWingParams params = models::fast_fixed_wing();
    if (c.height_m == 0.0) {
      models::RigidBodyState parked;
      parked.position_m.z() = -0.46;
      parked.attitude = attitude_from({.yaw_rad = c.heading_rad});
      return {params, parked, {}};
    }
    const models::Trim trim = models::trim(params, {.airspeed_mps = c.airspeed_mps}).value();
    models::RigidBodyState state = trim.state;
    state.position_m.z() = -c.height_m;
    EulerAngles angles = euler_angles(state.attitude);
    angles.yaw_rad = c.heading_rad;
    state.attitude = attitude_from(angles);
    state.velocity_mps += state.attitude.conjugate() * c.wind_mps;
    return {params, state, trim.input};
  }

  Conditions conditions_;
  models::DrydenGusts gusts_;
  models::Imu imu_;
  Random random_;
  models::FixedWing plane_;
  Vec3 wind_ = Vec3::Zero();
  double seconds_ = 0.0;
};

/// A hexarotor in wind, likewise.
class TestHover {
 public:
  static constexpr double kControl_s = 0.0025;

  struct Conditions {
    double height_m = 0.0;  ///< 0 for on its feet, motors off
    double roll_rad = 0.0;
    Vec3 wind_mps = Vec3::Zero();
    double gusts_wind_mps = 0.0;
    std::uint64_t seed = 1;
    bool noise = false;
  };

  explicit TestHover(const Conditions& c)
      : conditions_{c},
        gusts_{c.gusts_wind_mps, c.seed},
        imu_{{}, c.seed + 1},
        random_{c.seed + 2},
        vehicle_{start(c)} {}

  static models::RotorSpeeds speeds(const RotorCommand& command) {
    static const double fastest = models::firefly().speed_max_radps;
    models::RotorSpeeds speeds{};
    for (std::size_t i = 0; i < speeds.size(); ++i) {
      speeds[i] = fastest * std::sqrt(command.thrust[i]);
    }
    return speeds;
  }

  void advance(const RotorCommand& command) {
    const Vec3 air = state().velocity_ned_mps() - conditions_.wind_mps;
    (void)gusts_.step(kControl_s, air.norm(), -state().position_m.z());
    wind_ = conditions_.wind_mps + gusts_.velocity_ned_mps(euler_angles(state().attitude).yaw_rad);
    vehicle_.step(speeds(command), wind_, kControl_s);
    seconds_ += kControl_s;
  }

  [[nodiscard]] Estimate estimate() {
    Estimate e;
    e.position_m = state().position_m;
    e.velocity_mps = state().velocity_ned_mps();
    e.attitude = state().attitude;
    e.rates_radps = state().rates_radps;
    e.specific_force_mps2 = vehicle_.specific_force(wind_);
    if (conditions_.noise) {
      const models::ImuSample sample = imu_.sample(state(), e.specific_force_mps2, kControl_s);
      e.rates_radps = sample.rates_radps - imu_.gyro_bias_radps();
      e.specific_force_mps2 = sample.specific_force_mps2;
      for (const int axis : {0, 1, 2}) {
        e.velocity_mps[axis] += random_.normal(0.0, 0.05);
        e.position_m[axis] += random_.normal(0.0, 0.1);
      }
    }
    return e;
  }

  [[nodiscard]] const models::RigidBodyState& state() const { return vehicle_.state(); }
  [[nodiscard]] bool on_ground() const { return vehicle_.on_ground(); }
  [[nodiscard]] double height_m() const { return -state().position_m.z(); }
  [[nodiscard]] double seconds() const { return seconds_; }

 private:
  static models::Hexarotor start(const Conditions& c) {
    models::RigidBodyState state;
    state.position_m.z() = c.height_m > 0.0 ? -c.height_m : -0.075;
    state.attitude = attitude_from({.roll_rad = c.roll_rad});
    models::Hexarotor vehicle{models::firefly(), state};
    if (c.height_m > 0.0) {
      models::RotorSpeeds hover{};
      hover.fill(models::hover_speed_radps(models::firefly()));
      vehicle.set_speeds(hover);
    }
    return vehicle;
  }

  Conditions conditions_;
  models::DrydenGusts gusts_;
  models::Imu imu_;
  Random random_;
  models::Hexarotor vehicle_;
  Vec3 wind_ = Vec3::Zero();
  double seconds_ = 0.0;
};

}  // namespace skein::autopilot
