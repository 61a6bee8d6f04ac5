// SPDX-License-Identifier: Apache-2.0
#include "air.hpp"

#include <cmath>

#include "skein/base/frames.hpp"
#include "skein/models/fixed_wing.hpp"

namespace skein::hil {
namespace {

constexpr double kWindFilterTime_s = 10.0;
// ArduPlane 4.6.3's simulator with SIM_WIND_TURB 1.5: airspeed less what it moved at had a standard
// deviation of 0.71 m/s, and 0.1 s later nothing in common.
constexpr double kShortShare = 0.47;
/// Of a copter: four of them are then as far from their places (0.10 m rms) as four on ArduCopter.
constexpr double kShortShareCopter = 0.65;
constexpr double kShortTime_s = 0.04;
constexpr std::uint64_t kShortSeed = 3;
/// Standard deviations of what a filter tells, m/s and m, and of how far it drifts off what is
/// true.
struct FilterErrors {
  double velocity_mps;
  double climb_mps;
  double horizontal_m;
  double height_m;
  double drift_horizontal_m;
  double drift_height_m;
};
/// Of two aircraft on ArduPlane 4.6.3, in 105 s each: drifts of 0.40 to 0.46 m rms along each
/// horizontal axis and 0.31 to 0.52 m in height, of which 0.26 and 0.66 were left after 5 s.
constexpr FilterErrors kPlane{0.05, 0.1, 0.1, 0.2, 0.43, 0.42};
/// Four on ArduCopter, which bank little and not for long, were off by 0.06 m in all.
constexpr FilterErrors kCopter{0.02, 0.02, 0.03, 0.03, 0.02, 0.02};
constexpr double kAirspeedNoise_mps = 0.2;
constexpr double kDriftTime_s = 6.0;
constexpr std::uint64_t kDriftSeed = 4;

constexpr const FilterErrors& errors_of(Airframe airframe) {
  return airframe == Airframe::copter ? kCopter : kPlane;
}

}  // namespace

Air::Air(const EmulatorConfig& config)
    : steady_{ned_from_enu({config.wind_mps.x(), config.wind_mps.y(), 0.0})},
      gusts_{config.gusts_wind_mps, config.seed},
      gusty_{config.gusts_wind_mps > 0.0 || config.turbulence_mps > 0.0},
      short_deviation_mps_{(config.airframe == Airframe::copter ? kShortShareCopter : kShortShare) *
                           config.turbulence_mps},
      random_{config.seed + kShortSeed},
      wind_{steady_},
      estimated_{steady_} {}

void Air::step(const models::RigidBodyState& state, double seconds) {
  if (!gusty_) return;
  (void)gusts_.step(seconds, airspeed_mps(state), -state.position_m.z());
  const double keep = std::exp(-seconds / kShortTime_s);
  const double fresh = short_deviation_mps_ * std::sqrt(1.0 - keep * keep);
  for (double& axis : short_mps_) axis = keep * axis + random_.normal(0.0, fresh);
  wind_ = steady_ + gusts_.velocity_ned_mps(euler_angles(state.attitude).yaw_rad) + short_mps_;
  estimated_ += seconds / kWindFilterTime_s * (wind_ - estimated_);
}

double Air::airspeed_mps(const models::RigidBodyState& state) const {
  return models::air_data(state, wind_).airspeed_mps;
}

Senses::Senses(const EmulatorConfig& config)
    : noise_{config.noise},
      imu_{{}, config.seed + 1},
      random_{config.seed + 2},
      airframe_{config.airframe},
      drift_random_{config.seed + kDriftSeed} {}

const Vec3& Senses::drift(double seconds) {
  const double keep = std::exp(-seconds / kDriftTime_s);
  const double fresh = std::sqrt(1.0 - keep * keep);
  const auto next = [&](double deviation) { return drift_random_.normal(0.0, deviation * fresh); };
  const FilterErrors& errors = errors_of(airframe_);
  const Vec3 news{next(errors.drift_horizontal_m), next(errors.drift_horizontal_m),
                  next(errors.drift_height_m)};
  drift_m_ = keep * drift_m_ + news;
  return drift_m_;
}

autopilot::Estimate Senses::estimate(const models::RigidBodyState& state,
                                     const Vec3& specific_force_mps2, double airspeed_mps,
                                     double seconds) {
  autopilot::Estimate e;
  e.position_m = state.position_m;
  e.velocity_mps = state.velocity_ned_mps();
  e.attitude = state.attitude;
  e.rates_radps = state.rates_radps;
  e.specific_force_mps2 = specific_force_mps2;
  e.airspeed_mps = airspeed_mps;
  if (!noise_) return e;
  const models::ImuSample sample = imu_.sample(state, specific_force_mps2, seconds);
  e.rates_radps = sample.rates_radps - imu_.gyro_bias_radps();
  e.specific_force_mps2 = sample.specific_force_mps2;
  e.position_m += drift(seconds);
  const FilterErrors& errors = errors_of(airframe_);
  const auto add = [this](double& value, double deviation) {
    value += random_.normal(0.0, deviation);
  };
  add(e.velocity_mps.x(), errors.velocity_mps);
  add(e.velocity_mps.y(), errors.velocity_mps);
  add(e.velocity_mps.z(), errors.climb_mps);
  add(e.position_m.x(), errors.horizontal_m);
  add(e.position_m.y(), errors.horizontal_m);
  add(e.position_m.z(), errors.height_m);
  add(e.airspeed_mps, kAirspeedNoise_mps);
  return e;
}

}  // namespace skein::hil
