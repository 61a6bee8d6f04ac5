// SPDX-License-Identifier: Apache-2.0
#include "skein/formation/field_avoidance.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "skein/base/random.hpp"

namespace skein::formation {
namespace {

Vec3 random_point(Random& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

TEST(Field, TheForceIsTheGradientOfThePotential) {
  Random random{3};
  const FieldParams params{.range_m = 9.0, .gain = 40.0, .goal_power = 1.3, .speed_mps = 2.0};
  int pushed = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 self = random_point(random, 4.0);
    const Vec3 goal = random_point(random, 30.0);
    const Vec3 other = random_point(random, 4.0);
    if ((self - other).norm() < 0.5 || (self - goal).norm() < 0.5) continue;
    const Vec3 force = field_force(params, self, goal, other);
    if (force.norm() > 0.0) ++pushed;
    constexpr double kStep = 1e-5;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 step = kStep * Vec3::Unit(axis);
      const double slope = (field_potential(params, self + step, goal, other) -
                            field_potential(params, self - step, goal, other)) /
                           (2.0 * kStep);
      EXPECT_NEAR(-slope, force[axis], 1e-5 * (1.0 + force.norm()));
    }
  }
  EXPECT_GT(pushed, 500);
}

TEST(Field, IsNothingOutOfRangeAndAtTheGoal) {
  const FieldParams params;
  const Vec3 goal{50.0, 0.0, 0.0};
  EXPECT_EQ(field_force(params, Vec3::Zero(), goal, {params.range_m, 0.0, 0.0}), Vec3(0, 0, 0));
  EXPECT_NE(field_force(params, Vec3::Zero(), goal, {params.range_m - 0.1, 0.0, 0.0}),
            Vec3(0, 0, 0));
  EXPECT_EQ(field_force(params, goal, goal, goal + Vec3(1.0, 0.0, 0.0)), Vec3(0, 0, 0));
}

FieldSelf at_origin(std::uint16_t id) {
  FieldSelf self;
  self.id = VehicleId{id};
  self.goal_m = {50.0, 0.0, 0.0};
  return self;
}

TEST(Field, TheLowerIdGivesWayUnlessTheOtherIsAtItsGoal) {
  const MotionLimits limits;
  FieldNeighbour beside{VehicleId{5}, {0.0, 4.0, 0.0}, Vec3::Zero(), 0.0, false};
  const auto velocity = [&](std::uint16_t id) {
    return field_velocity({}, limits, at_origin(id), std::array{beside}, 0.02);
  };
  EXPECT_LT(velocity(4).y(), 0.0);
  EXPECT_EQ(velocity(6).y(), 0.0);
  beside.at_goal = true;
  EXPECT_LT(velocity(6).y(), 0.0);
}

TEST(Field, ANeighbourIsWhereItHasFlownSinceItsMessage) {
  const FieldNeighbour old{VehicleId{5}, {0.0, 20.0, 0.0}, {0.0, -5.0, 0.0}, 3.2, false};
  const FieldNeighbour now{VehicleId{5}, {0.0, 4.0, 0.0}, Vec3::Zero(), 0.0, false};
  const MotionLimits limits;
  const Vec3 by_old = field_velocity({}, limits, at_origin(1), std::array{old}, 0.02);
  const Vec3 by_now = field_velocity({}, limits, at_origin(1), std::array{now}, 0.02);
  EXPECT_LT((by_old - by_now).norm(), 1e-12);
}

/// Flies those vehicles with messages of no age; false where one is not at its goal in time.
bool fly(std::vector<FieldSelf>& vehicles, double seconds, double& least_m) {
  constexpr double kPeriod = 0.02;
  const MotionLimits limits;
  const auto at_goal = [](const FieldSelf& v) { return (v.goal_m - v.position_m).norm() < 0.05; };
  for (int step = 0; step * kPeriod < seconds; ++step) {
    std::vector<Vec3> velocities;
    for (const FieldSelf& self : vehicles) {
      std::vector<FieldNeighbour> others;
      for (const FieldSelf& other : vehicles) {
        if (other.id == self.id) continue;
        others.push_back({other.id, other.position_m, other.velocity_mps, 0.0, at_goal(other)});
        least_m = std::min(least_m, (other.position_m - self.position_m).norm());
      }
      velocities.push_back(field_velocity({}, limits, self, others, kPeriod));
      EXPECT_LE(velocities.back().norm(), limits.speed_mps + 1e-12);
      EXPECT_LE((velocities.back() - self.velocity_mps).norm(),
                limits.acceleration_mps2 * kPeriod + 1e-12);
    }
    bool all = true;
    for (std::size_t i = 0; i < vehicles.size(); ++i) {
      vehicles[i].velocity_mps = velocities[i];
      vehicles[i].position_m += velocities[i] * kPeriod;
      all = all && at_goal(vehicles[i]);
    }
    if (all) return true;
  }
  return false;
}

TEST(Field, TwoThatCrossKeepTheirDistanceWithinTheLimits) {
  std::vector<FieldSelf> vehicles(2);
  vehicles[0] = {VehicleId{1}, {0.0, -30.0, 0.0}, Vec3::Zero(), {0.0, 30.0, 0.0}, 1.0};
  vehicles[1] = {VehicleId{2}, {30.0, 0.0, 0.0}, Vec3::Zero(), {-30.0, 0.0, 0.0}, 1.0};
  double least_m = 1e9;
  EXPECT_TRUE(fly(vehicles, 60.0, least_m));
  EXPECT_GT(least_m, 3.0);
}

TEST(Field, ThoseWithAShorterWayFlySlowerAndAllArriveTogether) {
  std::vector<FieldSelf> vehicles(1);
  vehicles[0] = {VehicleId{1}, {0.0, 0.0, 0.0}, Vec3::Zero(), {40.0, 0.0, 0.0}, 0.5};
  double least_m = 1e9;
  EXPECT_FALSE(fly(vehicles, 40.0, least_m));
  EXPECT_TRUE(fly(vehicles, 8.0, least_m));
}

}  // namespace
}  // namespace skein::formation
