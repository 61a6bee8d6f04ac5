// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/guidance.hpp"

#include <gtest/gtest.h>

#include "skein/base/angles.hpp"

namespace skein::mission {
namespace {

constexpr double kSpeed_mps = 8.0;
constexpr double kRadius_m = 32.0;
constexpr double kHeight_m = 40.0;

VehicleSpec vehicle(Airframe airframe) {
  VehicleSpec spec;
  spec.cruise_speed_mps = kSpeed_mps;
  spec.speed_min_mps = 1.0;
  spec.speed_max_mps = 12.0;
  spec.turn_radius_m = kRadius_m;
  spec.height_m = kHeight_m;
  spec.airframe = airframe;
  return spec;
}

/// From (10, 20) east for 10 s, half a circle to the left, then west; and to the right in the hold.
FlightPlan plan() {
  FlightPlan p;
  p.number = 3;
  p.timed.start_time = at_seconds(5.0);
  p.timed.speed_mps = kSpeed_mps;
  p.timed.tail_curvature_per_m = -1.0 / (2.0 * kRadius_m);
  p.timed.path.start = {10.0, 20.0, 0.0};
  EXPECT_TRUE(p.timed.path.append(Segment{0.0, 80.0}));
  EXPECT_TRUE(p.timed.path.append(Segment{1.0 / kRadius_m, kPi * kRadius_m}));
  EXPECT_TRUE(p.timed.path.append(Segment{0.0, 40.0}));
  return p;
}

VehicleState at_height() {
  VehicleState state;
  state.z_m = kHeight_m;
  return state;
}

PositionSetpoint point_at(double seconds) {
  const Demand demand =
      follow(HeldGuidance{plan()}, {}, vehicle(Airframe::copter), at_height(), at_seconds(seconds));
  EXPECT_TRUE(std::holds_alternative<PositionSetpoint>(demand));
  return std::get<PositionSetpoint>(demand);
}

/// As plan(), and 7 m above the layer from 9.5 s on, for which it climbs from 6 s on.
FlightPlan higher_plan() {
  FlightPlan p = plan();
  p.height_to_m = 7.0;
  p.height_since = at_seconds(6.0);
  return p;
}

TEST(Guidance, APlansHeightGoesFromOneToTheOtherAtItsRate) {
  EXPECT_EQ(height_offset_m(plan(), at_seconds(100.0)), 0.0);
  EXPECT_EQ(height_offset_m(higher_plan(), at_seconds(1.0)), 0.0);
  EXPECT_NEAR(height_offset_m(higher_plan(), at_seconds(8.0)), 4.0, 1e-9);
  EXPECT_EQ(height_offset_m(higher_plan(), at_seconds(10.0)), 7.0);
  FlightPlan back = plan();
  back.height_from_m = 7.0;
  EXPECT_NEAR(height_offset_m(back, at_seconds(1.0)), 5.0, 1e-9);
  EXPECT_EQ(height_offset_m(back, at_seconds(4.0)), 0.0);
}

TEST(Guidance, WhatIsAskedForIsOffTheLayerAsThePlanSays) {
  const HeldGuidance held{higher_plan()};
  VehicleState state = at_height();
  state.groundspeed_mps = state.airspeed_mps = kSpeed_mps;
  const auto plane = follow(held, {}, vehicle(Airframe::plane), state, at_seconds(8.0));
  EXPECT_NEAR(std::get<Setpoint>(plane).height_m, kHeight_m + 4.0, 1e-9);

  const auto climbs = std::get<PositionSetpoint>(
      follow(held, {}, vehicle(Airframe::copter), state, at_seconds(8.0)));
  EXPECT_NEAR(climbs.z_m, kHeight_m + 4.0, 1e-9);
  EXPECT_EQ(climbs.vz_mps, kHeightRate_mps);
  EXPECT_EQ(climbs.vx_mps, kSpeed_mps) << "it goes on meanwhile";

  state.z_m = kHeight_m + 7.0;
  const auto there = std::get<PositionSetpoint>(
      follow(held, {}, vehicle(Airframe::copter), state, at_seconds(12.0)));
  EXPECT_EQ(there.z_m, kHeight_m + 7.0);
  EXPECT_EQ(there.vz_mps, 0.0);
  EXPECT_EQ(there.vx_mps, kSpeed_mps) << "there its plan is flown";
}

TEST(Guidance, ACopterIsWhereItsPlanIsWithItsNoseAlongIt) {
  const PositionSetpoint straight = point_at(10.0);
  EXPECT_LT((straight.position_m() - Vec3{50.0, 20.0, kHeight_m}).norm(), 1e-9);
  EXPECT_LT((straight.velocity_mps() - Vec3{kSpeed_mps, 0.0, 0.0}).norm(), 1e-9);
  EXPECT_EQ(straight.acceleration_mps2().norm(), 0.0);
  EXPECT_NEAR(straight.yaw_rad, 0.0, 1e-12);

  // A quarter of a circle further: north of its centre's east, and pulled towards it.
  const PositionSetpoint turn = point_at(15.0 + 0.5 * kPi * kRadius_m / kSpeed_mps);
  EXPECT_LT((turn.position_m() - Vec3{90.0 + kRadius_m, 20.0 + kRadius_m, kHeight_m}).norm(), 1e-6);
  EXPECT_LT((turn.velocity_mps() - Vec3{0.0, kSpeed_mps, 0.0}).norm(), 1e-6);
  const Vec3 to_centre{-kSpeed_mps * kSpeed_mps / kRadius_m, 0.0, 0.0};
  EXPECT_LT((turn.acceleration_mps2() - to_centre).norm(), 1e-6);
  EXPECT_NEAR(turn.yaw_rad, kPi / 2.0, 1e-6);
}

TEST(Guidance, ACopterRestsWhereItsPlanBeginsUntilThen) {
  const PositionSetpoint before = point_at(2.0);
  EXPECT_LT((before.position_m() - Vec3{10.0, 20.0, kHeight_m}).norm(), 1e-9);
  EXPECT_EQ(before.velocity_mps().norm(), 0.0);
}

TEST(Guidance, VelocityAndAccelerationAreThoseOfThePoint) {
  constexpr double kStep_s = 1e-3;
  for (int i = 0; i < 200; ++i) {  // into the hold
    const double t = 6.0 + 0.37 * i;
    const PositionSetpoint now = point_at(t);
    const Vec3 velocity = (point_at(t + kStep_s).position_m() - now.position_m()) / kStep_s;
    EXPECT_LT((velocity - now.velocity_mps()).norm(), 0.01) << t;
    const Vec3 acceleration = (point_at(t + kStep_s).velocity_mps() - now.velocity_mps()) / kStep_s;
    EXPECT_LT((acceleration - now.acceleration_mps2()).norm(), 0.01) << t;
  }
}

TEST(Guidance, ACopterFarFromItsHeightComesToItFirst) {
  const VehicleSpec copter = vehicle(Airframe::copter);
  for (const double off_m : {-5.5, 5.5}) {
    VehicleState state;
    state.x_m = -30.0;
    state.y_m = 7.0;
    state.z_m = kHeight_m + off_m;
    state.heading_rad = 1.0;
    const auto up = std::get<PositionSetpoint>(
        follow(HeldGuidance{plan()}, {}, copter, state, at_seconds(10.0)));
    EXPECT_EQ(up.position_m(), (Vec3{-30.0, 7.0, kHeight_m}));
    EXPECT_EQ(up.velocity_mps().norm(), 0.0);
    EXPECT_EQ(up.yaw_rad, 1.0);
    state.z_m = kHeight_m + 0.9 * off_m;
    const auto on = std::get<PositionSetpoint>(
        follow(HeldGuidance{plan()}, {}, copter, state, at_seconds(10.0)));
    EXPECT_NEAR(on.x_m, 50.0, 1e-9);
  }
}

TEST(Guidance, APlaneFliesTheSamePlanByHeadingAndAirspeed) {
  VehicleState state;
  state.airspeed_mps = state.groundspeed_mps = kSpeed_mps;
  const Demand demand =
      follow(HeldGuidance{plan()}, {}, vehicle(Airframe::plane), state, at_seconds(10.0));
  ASSERT_TRUE(std::holds_alternative<Setpoint>(demand));
  EXPECT_EQ(std::get<Setpoint>(demand).height_m, kHeight_m);
}

TEST(Guidance, ACopterIsAsFarOffAsWhenItsStateWasMeasured) {
  VehicleState state;
  state.time = at_seconds(10.0);
  state.x_m = 47.0;  // the plan is at (50, 20)
  state.y_m = 22.0;
  const Deviation off =
      deviation(HeldGuidance{plan()}, vehicle(Airframe::copter), state, at_seconds(10.3));
  EXPECT_EQ(off.number, 3U);
  EXPECT_NEAR(off.along_error_m, -3.0, 1e-9);
  EXPECT_NEAR(off.cross_error_m, 2.0, 1e-9);
}

}  // namespace
}  // namespace skein::mission
