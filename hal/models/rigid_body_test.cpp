// SPDX-License-Identifier: Apache-2.0
#include "skein/models/rigid_body.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "skein/base/angles.hpp"
#include "skein/models/ground_contact.hpp"
#include "skein/models/runge_kutta.hpp"

namespace skein::models {
namespace {

MassProperties brick() {
  Eigen::Matrix3d inertia;
  inertia << 0.8, 0.05, -0.12, 0.05, 1.1, 0.02, -0.12, 0.02, 1.8;
  return {11.0, inertia};
}

RigidBodyState tumbling() {
  return {.position_m = {1.0, -2.0, -300.0},
          .velocity_mps = {20.0, -3.0, 5.0},
          .attitude = attitude_from({.roll_rad = 0.4, .pitch_rad = -0.7, .yaw_rad = 2.0}),
          .rates_radps = {1.5, -2.0, 0.8}};
}

RigidBodyVector fly(const RigidBodyVector& from, const MassProperties& mass, double seconds,
                    int steps, double gravity_mps2) {
  RigidBodyVector x = from;
  for (int i = 0; i < steps; ++i) {
    x = runge_kutta_step(x, seconds / steps, [&](const RigidBodyVector& at) {
      return rigid_body_derivative(from_vector(at), {}, mass, gravity_mps2);
    });
  }
  return x;
}

TEST(RigidBody, VectorsAndStatesAreTheSame) {
  const RigidBodyState state = tumbling();
  EXPECT_EQ(to_vector(from_vector(to_vector(state))), to_vector(state));
  EXPECT_EQ(to_vector(state)[6], state.attitude.w());
}

TEST(RigidBody, ConservesEnergyWithoutForces) {
  const MassProperties mass = brick();
  const RigidBodyState before = tumbling();
  for (const double gravity : {0.0, kGravity_mps2}) {
    const RigidBodyState after = from_vector(fly(to_vector(before), mass, 10.0, 4000, gravity));
    EXPECT_NEAR(energy(after, mass, gravity) / energy(before, mass, gravity), 1.0, 1e-9);
  }
}

TEST(RigidBody, ConservesMomentumOfTheFreeBody) {
  const MassProperties mass = brick();
  const RigidBodyState before = tumbling();
  const RigidBodyState after = from_vector(fly(to_vector(before), mass, 10.0, 4000, 0.0));
  EXPECT_LT((angular_momentum(after, mass) - angular_momentum(before, mass)).norm(), 1e-8);
  EXPECT_LT((after.velocity_ned_mps() - before.velocity_ned_mps()).norm(), 1e-7);
  // The body itself has turned on meanwhile.
  EXPECT_GT((after.rates_radps - before.rates_radps).norm(), 0.1);
}

TEST(RigidBody, QuaternionStaysUnit) {
  const RigidBodyState after = from_vector(fly(to_vector(tumbling()), brick(), 60.0, 24000, 0.0));
  EXPECT_NEAR(after.attitude.norm(), 1.0, 1e-8);  // without the normalising of the vehicles
}

TEST(RigidBody, FallsAsGalileiSays) {
  RigidBodyState state = tumbling();
  const Vec3 velocity = state.velocity_ned_mps();
  const RigidBodyState after =
      from_vector(fly(to_vector(state), brick(), 3.0, 1200, kGravity_mps2));
  const Vec3 fallen = state.position_m + 3.0 * velocity + 4.5 * kGravity_mps2 * Vec3::UnitZ();
  EXPECT_LT((after.position_m - fallen).norm(), 1e-6);
}

TEST(RigidBody, SymmetricTopPrecessesAsEulerSays) {
  const MassProperties mass{1.0, Vec3{2.0, 2.0, 3.0}.asDiagonal()};
  RigidBodyState state;
  state.rates_radps = {0.3, 0.0, 4.0};
  const double seconds = 5.0;
  const RigidBodyState after = from_vector(fly(to_vector(state), mass, seconds, 2000, 0.0));
  const double angle = (3.0 - 2.0) / 2.0 * 4.0 * seconds;  // (Iz - Ix) / Ix wz t
  EXPECT_NEAR(after.rates_radps.x(), 0.3 * std::cos(angle), 1e-8);
  EXPECT_NEAR(after.rates_radps.y(), 0.3 * std::sin(angle), 1e-8);
  EXPECT_NEAR(after.rates_radps.z(), 4.0, 1e-12);
}

TEST(RigidBody, RungeKuttaIsOfOrderFour) {
  const RigidBodyVector start = to_vector(tumbling());
  const MassProperties mass = brick();
  const RigidBodyVector truth = fly(start, mass, 2.0, 6400, kGravity_mps2);
  double before = (fly(start, mass, 2.0, 100, kGravity_mps2) - truth).norm();
  for (const int steps : {200, 400}) {
    const double error = (fly(start, mass, 2.0, steps, kGravity_mps2) - truth).norm();
    EXPECT_NEAR(before / error, 16.0, 1.6) << steps;
    before = error;
  }
}

TEST(RigidBody, AnglesThereAndBack) {
  for (const EulerAngles& angles :
       {EulerAngles{0.3, -0.4, 3.0}, EulerAngles{-2.0, 1.2, -1.0}, EulerAngles{0.0, 0.0, 0.0}}) {
    const EulerAngles back = euler_angles(attitude_from(angles));
    EXPECT_NEAR(back.roll_rad, angles.roll_rad, 1e-12);
    EXPECT_NEAR(back.pitch_rad, angles.pitch_rad, 1e-12);
    EXPECT_NEAR(back.yaw_rad, angles.yaw_rad, 1e-12);
  }
  // Nose up is up, right wing down is to the right, yaw is clockwise.
  EXPECT_LT((attitude_from({.pitch_rad = 0.1}) * Vec3::UnitX()).z(), 0.0);
  EXPECT_GT((attitude_from({.roll_rad = 0.1}) * Vec3::UnitY()).z(), 0.0);
  EXPECT_NEAR((attitude_from({.yaw_rad = kPi / 2}) * Vec3::UnitX()).y(), 1.0, 1e-12);
}

TEST(RigidBody, FramesThereAndBack) {
  const Position<MissionEnu> p{3.0, 4.0, 50.0};
  EXPECT_EQ(ned_from(p), Vec3(4.0, 3.0, -50.0));
  EXPECT_EQ(enu_from(ned_from(p)).metres(), p.metres());
}

TEST(GroundContact, PushesUpAndBrakesButNeverPulls) {
  GroundContactParams params;
  params.points.push_back({0.5, 0.0, 0.2});
  params.stiffness_n_per_m = 1000.0;
  params.damping_ns_per_m = 100.0;
  params.friction_along = 0.1;
  params.friction_across = 0.5;
  RigidBodyState state;
  state.position_m.z() = -0.1;  // 0.1 m deep
  state.velocity_mps = {10.0, 0.0, 0.0};
  EXPECT_TRUE(touches_ground(params, state));
  const Wrench rolling = ground_wrench(params, state);
  EXPECT_NEAR(rolling.force_n.z(), -100.0, 1e-9);
  EXPECT_NEAR(rolling.force_n.x(), -10.0, 0.01);
  EXPECT_NEAR(rolling.moment_nm.y(), 0.5 * 100.0 + 0.2 * -10.0, 0.01);  // nose up
  state.velocity_mps = {0.0, 0.0, -5.0};                                // torn upwards
  EXPECT_EQ(ground_wrench(params, state).force_n.norm(), 0.0);
  state.position_m.z() = -0.3;
  EXPECT_FALSE(touches_ground(params, state));
  EXPECT_EQ(ground_wrench(params, state).force_n.norm(), 0.0);
}

}  // namespace
}  // namespace skein::models
