// SPDX-License-Identifier: Apache-2.0
#include "skein/autopilot/hexarotor_loops.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "flight_test.hpp"
#include "skein/base/angles.hpp"

namespace skein::autopilot {
namespace {

constexpr double kStep = TestHover::kControl_s;

TEST(Mixer, GivesTheAskedForceAndMoment) {
  const HexarotorTuning tuning;
  const models::HexarotorParams params = models::firefly();
  const Vec3 moment{0.1, -0.2, 0.02};
  const RotorCommand command = mix(tuning, {16.0, moment});
  const models::Wrench wrench =
      models::hexarotor_wrench(params, {}, TestHover::speeds(command), Vec3::Zero());
  EXPECT_NEAR(wrench.force_n.z(), -16.0, 0.05);  // the rotors' greatest thrust is 6.003 N
  EXPECT_LT((wrench.moment_nm - moment).norm(), 2e-3);
}

TEST(Mixer, KeepsRollAndPitchWhereItCannotHaveAll) {
  const HexarotorTuning tuning;
  for (const double thrust : {0.0, 18.0, 36.0}) {
    const RotorCommand command = mix(tuning, {thrust, {0.3, 0.0, 5.0}});
    double roll = 0.0;
    for (std::size_t i = 0; i < RotorCommand::kRotors; ++i) {
      EXPECT_GE(command.thrust[i], 0.0);
      EXPECT_LE(command.thrust[i], 1.0);
      roll -= 6.0 * command.thrust[i] * tuning.arm_m *
              std::sin(radians(30.0 + 60.0 * static_cast<double>(i)));
    }
    EXPECT_NEAR(roll, 0.3, 1e-9) << thrust;
  }
}

TEST(HexarotorLoops, HoldsItsPlaceInWindWithGusts) {
  TestHover flight{{.height_m = 30.0,
                    .wind_mps = {3.0, -4.0, 0.0},
                    .gusts_wind_mps = 5.0,
                    .seed = 4,
                    .noise = true}};
  HexarotorLoops loops{{}};
  double worst = 0.0;
  while (flight.seconds() < 60.0) {
    flight.advance(
        loops.fly(flight.estimate(), {.horizontal_m = Vec2{0.0, 0.0}, .down_m = -30.0}, kStep));
    if (flight.seconds() < 10.0) continue;
    worst = std::max(worst, (flight.state().position_m - Vec3{0.0, 0.0, -30.0}).norm());
  }
  EXPECT_LT(worst, 0.5);
}

TEST(HexarotorLoops, FliesACircleAtSixMetresASecond) {
  // As a companion flies it: position and velocity, ten times a second.
  TestHover flight{{.height_m = 30.0,
                    .wind_mps = {3.0, -4.0, 0.0},
                    .gusts_wind_mps = 5.0,
                    .seed = 9,
                    .noise = true}};
  HexarotorLoops loops{{}};
  constexpr double kRadius = 30.0;
  constexpr double kSpeed = 6.0;
  MotionDemand demand;
  double worst = 0.0;
  int tick = 0;
  while (flight.seconds() < 90.0) {
    const double angle = kSpeed / kRadius * flight.seconds();
    const Vec2 place = kRadius * Vec2{std::sin(angle), 1.0 - std::cos(angle)};
    if (tick++ % 40 == 0) {
      demand.horizontal_m = place;
      demand.down_m = -30.0;
      demand.velocity_mps = kSpeed * Vec3{std::cos(angle), std::sin(angle), 0.0};
      demand.yaw_rad = angle;
      demand.yaw_rate_radps = kSpeed / kRadius;
    } else {
      *demand.horizontal_m += kStep * demand.velocity_mps.head<2>();
    }
    flight.advance(loops.fly(flight.estimate(), demand, kStep));
    if (flight.seconds() < 10.0) continue;
    worst = std::max(worst, (flight.state().position_m.head<2>() - place).norm());
    EXPECT_NEAR(flight.state().position_m.z(), -30.0, 0.5);
  }
  EXPECT_LT(worst, 1.0);
}

TEST(HexarotorLoops, FollowsAVelocity) {
  TestHover flight{{.height_m = 30.0, .wind_mps = {0.0, 5.0, 0.0}}};
  HexarotorLoops loops{{}};
  while (flight.seconds() < 15.0) {
    flight.advance(loops.fly(flight.estimate(), {.velocity_mps = {4.0, -3.0, -1.0}}, kStep));
  }
  EXPECT_LT((flight.state().velocity_ned_mps() - Vec3{4.0, -3.0, -1.0}).norm(), 0.2);
  const double tilt = std::acos((flight.state().attitude * Vec3::UnitZ()).z());
  EXPECT_LT(tilt, loops.tuning().tilt_max_rad);
}

TEST(HexarotorLoops, AttitudeStepSettlesFast) {
  TestHover flight{{.height_m = 30.0}};
  HexarotorLoops loops{{}};
  double settled = 0.0;
  double peak = 0.0;
  while (flight.seconds() < 1.5) {
    flight.advance(
        loops.hold_attitude(flight.estimate(), 0.3, 0.0, 0.5, 0.0, loops.hover_thrust(), kStep));
    const double roll = euler_angles(flight.state().attitude).roll_rad;
    peak = std::max(peak, roll);
    if (std::abs(roll - 0.3) > 0.03) settled = flight.seconds();
  }
  EXPECT_LT(settled, 0.7);
  EXPECT_LT(peak, 0.36);
  EXPECT_NEAR(euler_angles(flight.state().attitude).yaw_rad, 0.5, 0.1);
}

TEST(HexarotorLoops, RightsItselfFromAnyAttitude) {
  for (const double roll : {1.5, 3.0, -2.5}) {
    TestHover flight{{.height_m = 100.0, .roll_rad = roll}};
    HexarotorLoops loops{{}};
    while (flight.seconds() < 8.0) {
      flight.advance(
          loops.fly(flight.estimate(), {.horizontal_m = Vec2{0.0, 0.0}, .down_m = -100.0}, kStep));
      EXPECT_LT(flight.state().position_m.z(), -60.0);
    }
    EXPECT_LT(std::abs(euler_angles(flight.state().attitude).roll_rad), 0.2);
  }
}

}  // namespace
}  // namespace skein::autopilot
