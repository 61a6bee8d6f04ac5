// SPDX-License-Identifier: Apache-2.0
#include "skein/models/hexarotor.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "skein/base/angles.hpp"

namespace skein::models {
namespace {

RotorSpeeds all(double speed) {
  RotorSpeeds speeds{};
  speeds.fill(speed);
  return speeds;
}

Hexarotor hovering() {
  RigidBodyState state;
  state.position_m.z() = -10.0;
  Hexarotor vehicle{firefly(), state};
  vehicle.set_speeds(all(hover_speed_radps(firefly())));
  return vehicle;
}

TEST(Hexarotor, HoversAtItsHoverSpeed) {
  Hexarotor vehicle = hovering();
  const RotorSpeeds hover = vehicle.speeds_radps();
  EXPECT_LT(hover[0], 0.7 * firefly().speed_max_radps);
  for (int i = 0; i < 4000; ++i) vehicle.step(hover, Vec3::Zero(), 0.0025);
  EXPECT_LT((vehicle.state().position_m - Vec3{0.0, 0.0, -10.0}).norm(), 1e-6);
  EXPECT_LT(vehicle.state().rates_radps.norm(), 1e-9);
  EXPECT_NEAR(vehicle.specific_force(Vec3::Zero()).z(), -kGravity_mps2, 1e-9);
}

TEST(Hexarotor, MotorsLagByTheirTimes) {
  Hexarotor vehicle = hovering();
  const double from = vehicle.speeds_radps()[0];
  const double to = from + 100.0;
  for (int i = 0; i < 25; ++i) vehicle.step(all(to), Vec3::Zero(), 0.0005);  // one time up
  EXPECT_NEAR((vehicle.speeds_radps()[0] - from) / 100.0, 1.0 - std::exp(-1.0), 1e-3);
  for (int i = 0; i < 400; ++i) vehicle.step(all(to), Vec3::Zero(), 0.0005);
  for (int i = 0; i < 50; ++i) vehicle.step(all(from), Vec3::Zero(), 0.0005);  // one time down
  EXPECT_NEAR((vehicle.speeds_radps()[0] - from) / 100.0, std::exp(-1.0), 1e-3);
  for (int i = 0; i < 400; ++i) vehicle.step(all(2000.0), Vec3::Zero(), 0.0025);
  EXPECT_NEAR(vehicle.speeds_radps()[0], firefly().speed_max_radps, 1e-6);
}

TEST(Hexarotor, RotorsTurnTheBodyTheOtherWay) {
  const HexarotorParams params = firefly();
  const RigidBodyState level;
  RotorSpeeds speeds = all(500.0);
  const auto moment = [&] {
    return hexarotor_wrench(params, level, speeds, Vec3::Zero()).moment_nm;
  };
  EXPECT_LT(moment().norm(), 1e-12);  // they cancel
  const double more = params.lift_ns2_per_rad2 * (550.0 * 550.0 - 500.0 * 500.0);
  for (std::size_t i = 0; i < kRotors; ++i) {
    speeds = all(500.0);
    speeds[i] = 550.0;
    const Vec3& arm = params.rotor_m[i];
    EXPECT_NEAR(arm.norm(), 0.215, 1e-12);
    // A rotor on the right pushes the right side up: a roll to the left. In front: nose up.
    EXPECT_NEAR(moment().x(), -arm.y() * more, 1e-9);
    EXPECT_NEAR(moment().y(), arm.x() * more, 1e-9);
    EXPECT_NEAR(moment().z(), -params.turning[i] * 0.016 * more, 1e-9);
  }
}

TEST(Hexarotor, RotorDragAndWindAct) {
  const HexarotorParams params = firefly();
  const RotorSpeeds hover = all(hover_speed_radps(params));
  RigidBodyState state;
  state.velocity_mps = {3.0, 0.0, 0.0};
  const double drag = -hexarotor_wrench(params, state, hover, Vec3::Zero()).force_n.x();
  EXPECT_NEAR(drag, 6.0 * params.drag_ns_per_rad_m * hover[0] * 3.0 + 0.02 * 9.0, 1e-9);
  state.velocity_mps.setZero();
  EXPECT_NEAR(hexarotor_wrench(params, state, hover, {-3.0, 0.0, 0.0}).force_n.x(), -drag, 1e-9);
  // With the wind it feels nothing.
  state.velocity_mps = {3.0, 0.0, 0.0};
  EXPECT_NEAR(hexarotor_wrench(params, state, hover, {3.0, 0.0, 0.0}).force_n.x(), 0.0, 1e-12);
}

TEST(Hexarotor, LandsOnItsFeetAndStays) {
  RigidBodyState state;
  state.position_m.z() = -0.3;
  state.attitude = attitude_from({.roll_rad = 0.1});
  Hexarotor vehicle{firefly(), state};
  for (int i = 0; i < 2000; ++i) vehicle.step(all(0.0), {0.0, 5.0, 0.0}, 0.0025);
  EXPECT_TRUE(vehicle.on_ground());
  EXPECT_LT(vehicle.state().velocity_mps.norm(), 0.02);
  EXPECT_LT(vehicle.state().rates_radps.norm(), 0.01);
  EXPECT_NEAR(euler_angles(vehicle.state().attitude).roll_rad, 0.0, 0.02);
}

TEST(Hexarotor, StepIsOfOrderFour) {
  const auto fly = [](int steps) {
    Hexarotor vehicle = hovering();
    RotorSpeeds command = vehicle.speeds_radps();
    command[0] += 30.0;
    command[3] += 10.0;
    for (int i = 0; i < steps; ++i) vehicle.step(command, {1.0, 2.0, 0.0}, 0.4 / steps);
    return to_vector(vehicle.state());
  };
  const RigidBodyVector truth = fly(6400);
  EXPECT_NEAR((fly(200) - truth).norm() / (fly(400) - truth).norm(), 16.0, 2.0);
}

}  // namespace
}  // namespace skein::models
