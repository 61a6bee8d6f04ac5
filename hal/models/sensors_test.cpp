// SPDX-License-Identifier: Apache-2.0
#include "skein/models/sensors.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace skein::models {
namespace {

TEST(Imu, WhiteNoiseHasItsDensityAtAnyRate) {
  for (const double seconds : {0.0025, 0.02}) {
    const ImuParams params{.gyro_radps = {.white_per_rthz = 1e-3},
                           .accelerometer_mps2 = {.white_per_rthz = 2e-3}};
    Imu imu{params, 7};
    double gyro = 0.0;
    double accelerometer = 0.0;
    constexpr int kSamples = 20000;
    for (int i = 0; i < kSamples; ++i) {
      const ImuSample s = imu.sample({}, {0.0, 0.0, -9.81}, seconds);
      gyro += s.rates_radps.squaredNorm() / (3 * kSamples);
      accelerometer +=
          (s.specific_force_mps2 + Vec3{0.0, 0.0, 9.81}).squaredNorm() / (3 * kSamples);
    }
    EXPECT_NEAR(std::sqrt(gyro * seconds), 1e-3, 2e-5);
    EXPECT_NEAR(std::sqrt(accelerometer * seconds), 2e-3, 4e-5);
  }
}

TEST(Imu, BiasWalks) {
  double square = 0.0;
  constexpr int kRuns = 400;
  for (int run = 0; run < kRuns; ++run) {
    Imu imu{{.gyro_radps = {.walk_per_rts = 1e-3}, .accelerometer_mps2 = {}},
            static_cast<std::uint64_t>(run)};
    for (int i = 0; i < 250; ++i) (void)imu.sample({}, Vec3::Zero(), 0.1);
    square += imu.gyro_bias_radps().squaredNorm() / (3 * kRuns);
  }
  EXPECT_NEAR(std::sqrt(square), 1e-3 * std::sqrt(25.0), 5e-4);
}

TEST(Gnss, DriftIsStationary) {
  double square = 0.0;
  constexpr int kRuns = 500;
  for (int run = 0; run < kRuns; ++run) {
    Gnss gnss{{.white_horizontal_m = 0.0, .white_vertical_m = 0.0},
              static_cast<std::uint64_t>(run)};
    GnssSample sample;
    for (int i = 0; i < 100; ++i) sample = gnss.sample({}, 5.0);
    square += sample.position_m.head<2>().squaredNorm() / (2 * kRuns);
  }
  EXPECT_NEAR(std::sqrt(square), 0.8, 0.08);
}

TEST(Barometer, StandardAtmosphere) {
  EXPECT_NEAR(standard_pressure_pa(0.0), 101325.0, 1e-9);
  EXPECT_NEAR(standard_pressure_pa(1000.0), 89874.6, 1.0);  // table of ICAO Doc 7488
  for (const double height : {-100.0, 0.0, 480.0, 3000.0}) {
    EXPECT_NEAR(pressure_height_m(standard_pressure_pa(height)), height, 1e-8);
  }
  RigidBodyState state;
  state.position_m.z() = -120.0;
  Barometer exact{{.pressure_pa = {}, .origin_height_m = 480.0}, 1};
  EXPECT_NEAR(pressure_height_m(exact.sample(state, 0.02)), 600.0, 1e-6);
}

TEST(Sensors, SameSeedSameNoise) {
  Imu a{{}, 3};
  Imu b{{}, 3};
  Gnss c{{}, 3};
  Gnss d{{}, 3};
  Barometer e{{}, 3};
  Barometer f{{}, 3};
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(a.sample({}, Vec3::Zero(), 0.01).rates_radps,
              b.sample({}, Vec3::Zero(), 0.01).rates_radps);
    EXPECT_EQ(c.sample({}, 0.2).position_m, d.sample({}, 0.2).position_m);
    EXPECT_EQ(e.sample({}, 0.02), f.sample({}, 0.02));
  }
}

}  // namespace
}  // namespace skein::models
