// SPDX-License-Identifier: Apache-2.0
#include "skein/formation/motion_profile.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "skein/base/random.hpp"

namespace skein::formation {
namespace {

TEST(MotionProfile, KeepsItsLimitsAndArrives) {
  Random random{1};
  for (int i = 0; i < 500; ++i) {
    const MotionLimits limits{random.uniform(0.5, 15.0), random.uniform(0.3, 6.0),
                              random.uniform(0.5, 20.0)};
    const double length = std::exp(random.uniform(std::log(1e-3), std::log(1e3)));
    const MotionProfile profile{length, limits};
    const double end = profile.duration_s();
    EXPECT_EQ(profile.at(-1.0).distance_m, 0.0);
    EXPECT_EQ(profile.at(end + 1.0).distance_m, length);
    constexpr int kSteps = 400;
    MotionProfile::Point before;
    const double dt = end / kSteps;
    for (int k = 1; k <= kSteps; ++k) {
      const auto point = profile.at(k * dt);
      EXPECT_GE(point.distance_m, before.distance_m);
      EXPECT_LE(point.speed_mps, limits.speed_mps * (1.0 + 1e-9));
      EXPECT_LE(std::abs(point.acceleration_mps2), limits.acceleration_mps2 * (1.0 + 1e-9));
      EXPECT_LE(std::abs(point.acceleration_mps2 - before.acceleration_mps2),
                limits.jerk_mps3 * dt * (1.0 + 1e-6));
      // The three are derivatives of each other.
      EXPECT_NEAR(point.distance_m - before.distance_m,
                  0.5 * (point.speed_mps + before.speed_mps) * dt,
                  limits.jerk_mps3 * dt * dt * dt + 1e-9 * length);
      EXPECT_NEAR(point.speed_mps - before.speed_mps,
                  0.5 * (point.acceleration_mps2 + before.acceleration_mps2) * dt,
                  limits.jerk_mps3 * dt * dt + 1e-9);
      before = point;
    }
  }
}

TEST(MotionProfile, TakesTheTimeThatIsKnown) {
  // 1 s of easing and 1 s of acceleration, then speed: 2 m/s2 reached, 3 m/s with jerk 2.
  const MotionProfile profile{30.0, {3.0, 2.0, 2.0}};
  EXPECT_DOUBLE_EQ(profile.duration_s(), 30.0 / 3.0 + 3.0 / 2.0 + 1.0);
  EXPECT_DOUBLE_EQ(profile.at(profile.duration_s() / 2.0).distance_m, 15.0);
  // So short that only the jerk counts: four equal phases, length = jerk t^3 * 2.
  EXPECT_NEAR((MotionProfile{2.0 * 0.001, {3.0, 2.0, 1.0}}.duration_s()), 4.0 * 0.1, 1e-12);
}

TEST(MotionProfile, OfNoLengthTakesNoTime) {
  const MotionProfile profile{0.0, {3.0, 2.0, 2.0}};
  EXPECT_EQ(profile.duration_s(), 0.0);
  EXPECT_EQ(profile.at(1.0).distance_m, 0.0);
}

}  // namespace
}  // namespace skein::formation
