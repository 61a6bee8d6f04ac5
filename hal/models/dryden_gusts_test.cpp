// SPDX-License-Identifier: Apache-2.0
#include "skein/models/dryden_gusts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

#include "skein/base/angles.hpp"

namespace skein::models {
namespace {

constexpr double kAirspeed = 50.0;
constexpr double kHeight = 700.0;  // above 2000 ft: all scales 533 m, all intensities equal

TEST(GustScales, AreThoseOfTheSpecification) {
  const GustScales low = gust_scales(100.0 * 0.3048, 15.0);
  EXPECT_NEAR(low.vertical_mps, 1.5, 1e-12);
  EXPECT_NEAR(low.length_vertical_m, 100.0 * 0.3048, 1e-9);
  EXPECT_NEAR(low.length_along_m, 100.0 * 0.3048 / std::pow(0.2593, 1.2), 1e-9);
  EXPECT_NEAR(low.along_mps, 1.5 / std::pow(0.2593, 0.4), 1e-12);
  const GustScales high = gust_scales(1000.0, 15.0);
  EXPECT_NEAR(high.length_along_m, 1750.0 * 0.3048, 1e-9);
  EXPECT_NEAR(high.length_vertical_m, 1750.0 * 0.3048, 1e-9);
  EXPECT_NEAR(high.along_mps, 1.5, 1e-12);
  const GustScales between = gust_scales(1500.0 * 0.3048, 15.0);
  EXPECT_GT(between.length_vertical_m, 1000.0 * 0.3048);
  EXPECT_LT(between.length_vertical_m, high.length_vertical_m);
  EXPECT_NEAR(gust_scales(0.0, 15.0).length_vertical_m, 3.048, 1e-9);
}

TEST(DrydenGusts, HaveTheAskedVarianceAtAnyStep) {
  for (const double seconds : {0.1, 0.5, 5.0}) {
    DrydenGusts gusts{20.0, 11};
    const double sigma = gust_scales(kHeight, 20.0).along_mps;
    Vec3 square = Vec3::Zero();
    // The same number of independent values: some 4000 correlation times.
    const int samples = static_cast<int>(40000.0 / seconds);
    for (int i = 0; i < samples; ++i) {
      const Vec3 gust = gusts.step(seconds, kAirspeed, kHeight);
      square += gust.cwiseProduct(gust) / samples;
    }
    for (const int axis : {0, 1, 2}) {
      EXPECT_NEAR(std::sqrt(square[axis]) / sigma, 1.0, 0.04) << seconds << " s, axis " << axis;
    }
  }
}

TEST(DrydenGusts, HaveTheSpectrumOfTheSpecification) {
  DrydenGusts gusts{20.0, 5};
  const GustScales scales = gust_scales(kHeight, 20.0);
  const double time = scales.length_along_m / kAirspeed;
  constexpr double kStep = 0.1;
  constexpr int kLength = 2048;
  constexpr int kSegments = 400;
  const std::vector<int> bins{2, 5, 10, 30, 100};
  std::vector<Eigen::Vector2d> power(bins.size(), Eigen::Vector2d::Zero());
  std::vector<Vec3> segment(kLength);
  for (int s = 0; s < kSegments; ++s) {
    for (Vec3& gust : segment) gust = gusts.step(kStep, kAirspeed, kHeight);
    for (std::size_t b = 0; b < bins.size(); ++b) {
      std::complex<double> along{};
      std::complex<double> across{};
      for (int i = 0; i < kLength; ++i) {
        // Hann's window, so that the low frequencies do not leak into the high ones.
        const double window = 1.0 - std::cos(kTwoPi * (i + 0.5) / kLength);
        const std::complex<double> turn =
            window * std::polar(1.0, -kTwoPi * bins[b] * i / static_cast<double>(kLength));
        along += segment[static_cast<std::size_t>(i)].x() * turn;
        across += segment[static_cast<std::size_t>(i)].y() * turn;
      }
      // One-sided density per rad/s; the window's mean square is 3/2.
      const double scale = kStep / (kPi * kLength * 1.5);
      power[b] += scale / kSegments * Eigen::Vector2d{std::norm(along), std::norm(across)};
    }
  }
  const double sigma2 = scales.along_mps * scales.along_mps;
  for (std::size_t b = 0; b < bins.size(); ++b) {
    const double w = kTwoPi * bins[b] / (kLength * kStep);
    const double tw2 = time * time * w * w;
    const double along = 2.0 * sigma2 * time / kPi / (1.0 + tw2);
    const double across = sigma2 * time / kPi * (1.0 + 3.0 * tw2) / ((1.0 + tw2) * (1.0 + tw2));
    EXPECT_NEAR(power[b].x() / along, 1.0, 0.2) << "bin " << bins[b];
    EXPECT_NEAR(power[b].y() / across, 1.0, 0.2) << "bin " << bins[b];
  }
}

TEST(DrydenGusts, SameSeedSameGusts) {
  DrydenGusts a{10.0, 3};
  DrydenGusts b{10.0, 3};
  DrydenGusts other{10.0, 4};
  bool differs = false;
  for (int i = 0; i < 100; ++i) {
    const Vec3 gust = a.step(0.02, 50.0, 100.0);
    EXPECT_EQ(gust, b.step(0.02, 50.0, 100.0));
    differs = differs || gust != other.step(0.02, 50.0, 100.0);
  }
  EXPECT_TRUE(differs);
  DrydenGusts calm{0.0, 3};
  EXPECT_EQ(calm.step(0.02, 50.0, 100.0), Vec3::Zero());
}

TEST(DrydenGusts, TurnWithTheVehicle) {
  DrydenGusts gusts{10.0, 3};
  const Vec3 gust = gusts.step(0.02, 50.0, 100.0);
  const Vec3 east = gusts.velocity_ned_mps(kPi / 2);
  EXPECT_NEAR(east.y(), gust.x(), 1e-12);
  EXPECT_NEAR(east.x(), -gust.y(), 1e-12);
  EXPECT_NEAR(east.z(), gust.z(), 1e-12);
}

}  // namespace
}  // namespace skein::models
