// SPDX-License-Identifier: Apache-2.0
#include "skein/models/lift_rotors.hpp"

#include <gtest/gtest.h>

namespace skein::models {
namespace {

constexpr LiftRotorParams kRotors{
    .arm_forward_m = 0.3, .arm_right_m = 0.2, .thrust_max_n = 8.0, .torque_per_lift_m = 0.02};

TEST(LiftRotors, ThatGiveTheSameLiftAndTurnNothing) {
  const Wrench all = lift_wrench(kRotors, {0.5, 0.5, 0.5, 0.5});
  EXPECT_NEAR(all.force_n.z(), -16.0, 1e-12) << "up, in a body's axes that point down";
  EXPECT_NEAR(all.force_n.head<2>().norm(), 0.0, 1e-12);
  EXPECT_NEAR(all.moment_nm.norm(), 0.0, 1e-12);
}

TEST(LiftRotors, TurnByWhereEachIsAndHowItTurns) {
  const auto moment = [](const RotorShares& shares) {
    return lift_wrench(kRotors, shares).moment_nm;
  };
  const Vec3 front = moment({0.5, 0.0, 0.5, 0.0});
  EXPECT_NEAR(front.y(), 2 * 4.0 * 0.3, 1e-12) << "nose up";
  EXPECT_NEAR(front.x(), 0.0, 1e-12);
  EXPECT_NEAR(front.z(), 0.0, 1e-12);
  const Vec3 right = moment({0.5, 0.0, 0.0, 0.5});
  EXPECT_NEAR(right.x(), -2 * 4.0 * 0.2, 1e-12) << "the right wing up";
  EXPECT_NEAR(right.y(), 0.0, 1e-12);
  const Vec3 counter_clockwise = moment({0.5, 0.5, 0.0, 0.0});
  EXPECT_NEAR(counter_clockwise.z(), 2 * 4.0 * 0.02, 1e-12) << "clockwise, against them";
  EXPECT_NEAR(counter_clockwise.head<2>().norm(), 0.0, 1e-12);
}

}  // namespace
}  // namespace skein::models
