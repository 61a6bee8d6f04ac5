// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/base/random.hpp"
#include "skein/models/rigid_body.hpp"

namespace skein::models {

/// The error of one axis: white noise, a bias that walks at random, and a constant one drawn once.
struct NoiseParams {
  double white_per_rthz = 0.0;  ///< density: unit / sqrt(Hz); a sample has density / sqrt(step)
  double walk_per_rts = 0.0;    ///< bias walk: unit / sqrt(s)
  double bias = 0.0;            ///< standard deviation of the constant bias
};

/// An inertial measurement unit at the centre of mass. The defaults are what data sheets of MEMS
/// units on small autopilots give (gyro 0.005 deg/s/rtHz, accelerometer 100 ug/rtHz).
struct ImuParams {
  NoiseParams gyro_radps{.white_per_rthz = 8.7e-5, .walk_per_rts = 2e-5, .bias = 2e-3};
  NoiseParams accelerometer_mps2{.white_per_rthz = 1e-3, .walk_per_rts = 1e-4, .bias = 0.03};
};
struct ImuSample {
  Vec3 rates_radps = Vec3::Zero();
  Vec3 specific_force_mps2 = Vec3::Zero();
};
class Imu {
 public:
  Imu(const ImuParams& params, std::uint64_t seed);
  /// `seconds` since the last sample, > 0.
  ImuSample sample(const RigidBodyState& state, const Vec3& specific_force_mps2, double seconds);
  [[nodiscard]] const Vec3& gyro_bias_radps() const { return gyro_bias_; }

 private:
  ImuParams params_;
  Random random_;
  Vec3 gyro_bias_;
  Vec3 accelerometer_bias_;
};

/// Satellite navigation: white noise on position and velocity, and a position error that comes and
/// goes (first-order Gauss-Markov; Rankin 1994, as Beard and McLain, sec. 7.5.1, have it).
struct GnssParams {
  double white_horizontal_m = 0.2;
  double white_vertical_m = 0.4;
  double drift_horizontal_m = 0.8;
  double drift_vertical_m = 1.5;
  double drift_time_s = 1100.0;
  double velocity_mps = 0.05;
};
struct GnssSample {
  Vec3 position_m = Vec3::Zero();    ///< NED
  Vec3 velocity_mps = Vec3::Zero();  ///< NED
};
class Gnss {
 public:
  Gnss(const GnssParams& params, std::uint64_t seed);
  GnssSample sample(const RigidBodyState& state, double seconds);

 private:
  GnssParams params_;
  Random random_;
  Vec3 drift_m_;
};

/// The pressure of the standard atmosphere (ICAO, troposphere) at a height above sea level, Pa, and
/// back.
[[nodiscard]] double standard_pressure_pa(double height_m);
[[nodiscard]] double pressure_height_m(double pressure_pa);

struct BarometerParams {
  NoiseParams pressure_pa{.white_per_rthz = 0.6, .walk_per_rts = 0.05, .bias = 12.0};
  double origin_height_m = 0.0;  ///< of NED down = 0, above sea level
};
class Barometer {
 public:
  Barometer(const BarometerParams& params, std::uint64_t seed);
  /// Pressure, Pa.
  double sample(const RigidBodyState& state, double seconds);

 private:
  BarometerParams params_;
  Random random_;
  double bias_pa_;
};

}  // namespace skein::models
