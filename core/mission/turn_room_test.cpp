// SPDX-License-Identifier: Apache-2.0
#include "turn_room.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"

namespace skein::mission {
namespace {

constexpr double kStep_s = 0.1;

VehicleSpec plane() {
  VehicleSpec vehicle;
  vehicle.cruise_speed_mps = 25.0;
  vehicle.speed_min_mps = 20.0;
  vehicle.speed_max_mps = 30.0;
  vehicle.turn_radius_m = 66.0;
  vehicle.turn_radius_margin = 1.3;
  return vehicle;
}

/// Circles at one speed over the ground, in the wind that it is given.
class Circling {
 public:
  explicit Circling(TurnRoom& room) : room_{room} {}
  /// How often the radius changed.
  int fly(double seconds, const Vec2& wind_mps, double gust_mps = 0.0, std::uint64_t seed = 1) {
    Random random{seed};
    int changes = 0;
    for (int i = 0; i * kStep_s < seconds; ++i) {
      time_ += from_seconds(kStep_s);
      course_rad_ += 0.3 * kStep_s;
      const Vec2 gust{gust_mps * random.uniform(-1.7, 1.7), gust_mps * random.uniform(-1.7, 1.7)};
      const Vec2 ground = 25.0 * unit_vector(course_rad_);
      const Vec2 air = ground - wind_mps - gust;
      VehicleState state;
      state.time = time_;
      state.course_rad = wrap_pi(course_rad_);
      state.groundspeed_mps = ground.norm();
      state.heading_rad = std::atan2(air.y(), air.x());
      state.airspeed_mps = air.norm();
      changes += room_.on_state(state) ? 1 : 0;
    }
    return changes;
  }

 private:
  TurnRoom& room_;
  Instant time_{};
  double course_rad_ = 0.0;
};

TEST(TurnRoom, IsAsConfiguredInStillAir) {
  TurnRoom room{plane(), true};
  EXPECT_EQ(Circling{room}.fly(60.0, {0.0, 0.0}), 0);
  EXPECT_DOUBLE_EQ(room.radius_m(), 85.8);
  EXPECT_FALSE(room.lacks_room());
}

TEST(TurnRoom, IsWideEnoughForTheWind) {
  Random random{3};
  for (int i = 0; i < 50; ++i) {
    TurnRoom room{plane(), true};
    const double wind_mps = random.uniform(0.0, 6.5);
    Circling{room}.fly(90.0, wind_mps * unit_vector(random.uniform(-kPi, kPi)));
    const double stretched = (25.0 + wind_mps) / 25.0;
    const double held_m = 66.0 * stretched * stretched;
    EXPECT_GE(room.radius_m(), 1.04 * held_m) << wind_mps;
    EXPECT_LE(room.radius_m(), std::max(85.8, 1.16 * held_m)) << wind_mps;
    EXPECT_NEAR(room.wind_mps().norm(), wind_mps, 0.01);
  }
}

TEST(TurnRoom, GustsDoNotMakeItSwing) {
  TurnRoom room{plane(), true};
  EXPECT_LE(Circling{room}.fly(600.0, {-4.0, 3.0}, 1.5), 3);
}

TEST(TurnRoom, IsWiderInGusts) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    TurnRoom still{plane(), true};
    Circling{still}.fly(90.0, {4.0, 0.0});
    TurnRoom gusty{plane(), true};
    Circling{gusty}.fly(90.0, {4.0, 0.0}, 2.0, seed);
    EXPECT_GT(gusty.radius_m(), 1.08 * still.radius_m()) << seed;
    EXPECT_LT(gusty.radius_m(), 1.25 * still.radius_m()) << seed;
  }
}

TEST(TurnRoom, IsTighterAgainWhenTheWindDrops) {
  TurnRoom room{plane(), true};
  Circling circling{room};
  circling.fly(60.0, {5.0, 0.0});
  EXPECT_GT(room.radius_m(), 95.0);
  circling.fly(200.0, {0.5, 0.0});
  EXPECT_DOUBLE_EQ(room.radius_m(), 85.8);
}

TEST(TurnRoom, LeavesRoomForArcsAroundSites) {
  VehicleSpec vehicle = plane();
  vehicle.capabilities.add(TaskKind::survey).add(TaskKind::assess);
  vehicle.sensor_radius_m = 105.0;
  vehicle.assess_radius_m = 100.0;
  TurnRoom room{vehicle, true};
  Circling{room}.fly(60.0, {9.0, 0.0});
  EXPECT_DOUBLE_EQ(room.radius_m(), 100.0);
  EXPECT_TRUE(room.lacks_room());
}

TEST(TurnRoom, SaysWhenNoCircleIsHeld) {
  TurnRoom room{plane(), true};
  Circling{room}.fly(60.0, {26.0, 0.0});
  EXPECT_DOUBLE_EQ(room.radius_m(), TurnRoom::kWidest * 66.0);
  EXPECT_TRUE(room.lacks_room());
}

TEST(TurnRoom, StaysForWhoDoesNotHeedTheWindOrIsACopter) {
  TurnRoom simulated{plane(), false};
  EXPECT_EQ(Circling{simulated}.fly(60.0, {8.0, 0.0}), 0);
  VehicleSpec vehicle = plane();
  vehicle.airframe = Airframe::copter;
  TurnRoom copter{vehicle, true};
  EXPECT_EQ(Circling{copter}.fly(60.0, {8.0, 0.0}), 0);
}

TEST(TurnRoom, LearnsNothingOnTheGround) {
  TurnRoom room{plane(), true};
  VehicleState state;
  state.airspeed_mps = 3.0;
  for (int i = 1; i < 1000; ++i) {
    state.time = Instant{} + from_seconds(kStep_s * i);
    EXPECT_FALSE(room.on_state(state));
  }
  EXPECT_EQ(room.wind_mps(), (Vec2{0.0, 0.0}));
}

}  // namespace
}  // namespace skein::mission
