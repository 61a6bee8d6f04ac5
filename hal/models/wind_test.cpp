// SPDX-License-Identifier: Apache-2.0
#include "skein/models/wind.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace skein::models {
namespace {

TEST(Wind, WithoutGustsIsSteady) {
  const Wind wind{{.steady_mps = {3.0, -2.0}}};
  for (const double s : {-10.0, 0.0, 1.5, 1e4}) {
    EXPECT_EQ(wind.velocity_at(at_seconds(s)), Vec2(3.0, -2.0));
  }
}

TEST(Wind, SameSeedSameGusts) {
  const WindParams params{.gust_mps = 2.0, .seed = 7};
  WindParams other = params;
  other.seed = 8;
  EXPECT_EQ(Wind{params}.velocity_at(at_seconds(12.5)), Wind{params}.velocity_at(at_seconds(12.5)));
  EXPECT_NE(Wind{params}.velocity_at(at_seconds(12.5)), Wind{other}.velocity_at(at_seconds(12.5)));
}

TEST(Wind, GustsHaveTheAskedStrengthAndCorrelation) {
  const WindParams params{
      .steady_mps = {5.0, 0.0}, .gust_mps = 2.0, .gust_time = std::chrono::seconds{4}, .seed = 3};
  const Wind wind{params};
  Vec2 mean{0.0, 0.0};
  Vec2 square{0.0, 0.0};
  Vec2 lagged{0.0, 0.0};
  constexpr int kSamples = 40000;
  for (int i = 0; i < kSamples; ++i) {
    const double s = 0.5 * i;
    const Vec2 gust = wind.velocity_at(at_seconds(s)) - params.steady_mps;
    const Vec2 later = wind.velocity_at(at_seconds(s + 4.0)) - params.steady_mps;
    mean += gust / kSamples;
    square += gust.cwiseProduct(gust) / kSamples;
    lagged += gust.cwiseProduct(later) / kSamples;
  }
  for (const int axis : {0, 1}) {
    EXPECT_NEAR(mean[axis], 0.0, 0.1);
    EXPECT_NEAR(std::sqrt(square[axis]), 2.0, 0.1);
    // exp(-lag / T), as a first-order process has it; 16 sines follow it roughly
    EXPECT_NEAR(lagged[axis] / square[axis], std::exp(-1.0), 0.15);
  }
}

}  // namespace
}  // namespace skein::models
