// SPDX-License-Identifier: Apache-2.0
#include "skein/models/sensors.hpp"

#include <cmath>

#include "skein/base/assert.hpp"

namespace skein::models {
namespace {

Vec3 normals(Random& random, double standard_deviation) {
  const double x = random.normal(0.0, standard_deviation);
  const double y = random.normal(0.0, standard_deviation);
  const double z = random.normal(0.0, standard_deviation);
  return {x, y, z};
}

constexpr double kSeaLevel_pa = 101325.0;
constexpr double kSeaLevel_k = 288.15;
constexpr double kLapse_kpm = 0.0065;
constexpr double kExponent = 5.255877;

}  // namespace

Imu::Imu(const ImuParams& params, std::uint64_t seed)
    : params_{params},
      random_{seed},
      gyro_bias_{normals(random_, params.gyro_radps.bias)},
      accelerometer_bias_{normals(random_, params.accelerometer_mps2.bias)} {}

ImuSample Imu::sample(const RigidBodyState& state, const Vec3& specific_force, double seconds) {
  SKEIN_ASSERT(seconds > 0.0);
  const double root = std::sqrt(seconds);
  const auto measure = [&](const NoiseParams& noise, const Vec3& truth, Vec3& bias) -> Vec3 {
    bias += normals(random_, noise.walk_per_rts * root);
    return truth + bias + normals(random_, noise.white_per_rthz / root);
  };
  ImuSample sample;
  sample.rates_radps = measure(params_.gyro_radps, state.rates_radps, gyro_bias_);
  sample.specific_force_mps2 =
      measure(params_.accelerometer_mps2, specific_force, accelerometer_bias_);
  return sample;
}

Gnss::Gnss(const GnssParams& params, std::uint64_t seed)
    : params_{params}, random_{seed}, drift_m_{normals(random_, 1.0)} {
  SKEIN_ASSERT(params.drift_time_s > 0.0);
}

GnssSample Gnss::sample(const RigidBodyState& state, double seconds) {
  SKEIN_ASSERT(seconds > 0.0);
  const double d = seconds / params_.drift_time_s;
  drift_m_ = std::exp(-d) * drift_m_ + normals(random_, std::sqrt(-std::expm1(-2.0 * d)));
  const Vec3 drift{params_.drift_horizontal_m, params_.drift_horizontal_m,
                   params_.drift_vertical_m};
  const Vec3 white{params_.white_horizontal_m, params_.white_horizontal_m,
                   params_.white_vertical_m};
  GnssSample sample;
  sample.position_m =
      state.position_m + drift.cwiseProduct(drift_m_) + white.cwiseProduct(normals(random_, 1.0));
  sample.velocity_mps = state.velocity_ned_mps() + normals(random_, params_.velocity_mps);
  return sample;
}

double standard_pressure_pa(double height_m) {
  return kSeaLevel_pa * std::pow(1.0 - kLapse_kpm * height_m / kSeaLevel_k, kExponent);
}

double pressure_height_m(double pressure_pa) {
  return kSeaLevel_k / kLapse_kpm * (1.0 - std::pow(pressure_pa / kSeaLevel_pa, 1.0 / kExponent));
}

Barometer::Barometer(const BarometerParams& params, std::uint64_t seed)
    : params_{params}, random_{seed}, bias_pa_{random_.normal(0.0, params.pressure_pa.bias)} {}

double Barometer::sample(const RigidBodyState& state, double seconds) {
  SKEIN_ASSERT(seconds > 0.0);
  const NoiseParams& noise = params_.pressure_pa;
  const double root = std::sqrt(seconds);
  bias_pa_ += random_.normal(0.0, noise.walk_per_rts * root);
  return standard_pressure_pa(params_.origin_height_m - state.position_m.z()) + bias_pa_ +
         random_.normal(0.0, noise.white_per_rthz / root);
}

}  // namespace skein::models
