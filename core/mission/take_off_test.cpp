// SPDX-License-Identifier: Apache-2.0
#include "take_off.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace skein::mission {
namespace {

constexpr Duration kPeriod = std::chrono::milliseconds{40};

VehicleSpec copter() {
  VehicleSpec spec;
  spec.height_m = 40.0;
  spec.airframe = Airframe::copter;
  return spec;
}

VehicleState at_rest(const Vec3& place) {
  VehicleState state;
  state.x_m = place.x();
  state.y_m = place.y();
  state.z_m = place.z();
  return state;
}

/// Follows its tracks exactly; how long until it is at its height.
double climb_s(TakeOff& take_off, VehicleState& state, Instant now) {
  const Instant begin = now;
  MotionTrack track;
  while (!take_off.done(state, now) && now < begin + std::chrono::minutes{2}) {
    if (auto newest = take_off.poll_track()) track = *newest;
    now += kPeriod;
    const MotionTrack::Moment moment = track.at(now);
    EXPECT_EQ(moment.position_m.head<2>(), (Vec2{state.x_m, state.y_m}));
    EXPECT_LE(moment.velocity_mps.norm(), 2.05);
    EXPECT_LE(std::abs(moment.position_m.z() - state.z_m), 0.1) << "no jump";
    state.z_m = moment.position_m.z();
    state.climb_mps = moment.velocity_mps.z();
  }
  return to_seconds(now - begin);
}

TEST(TakeOff, ACopterClimbsStraightUpToItsHeight) {
  TakeOff take_off{copter()};
  VehicleState state = at_rest({3.0, -4.0, 0.0});
  const double seconds = climb_s(take_off, state, at_seconds(1.23));
  EXPECT_GT(seconds, 40.0 / 2.0);
  EXPECT_LT(seconds, 40.0 / 2.0 + 5.0);
  EXPECT_NEAR(state.z_m, 40.0, 1.0);
  EXPECT_FALSE(take_off.poll_track()) << "nothing is left to follow";
}

TEST(TakeOff, FromAPlaceThatCannotBeNothingIsBegun) {
  TakeOff take_off{copter()};
  VehicleState state = at_rest({7.0e6, -9.0e6, -6.0e6});  // 0, 0 on the globe
  EXPECT_FALSE(take_off.done(state, at_seconds(0.0)));
  EXPECT_FALSE(take_off.poll_track());
  state = at_rest({3.0, -4.0, 0.0});
  climb_s(take_off, state, at_seconds(1.0));
  EXPECT_NEAR(state.z_m, 40.0, 1.0);
}

TEST(TakeOff, WhoIsTooHighComesDown) {
  TakeOff take_off{copter()};
  VehicleState state = at_rest({3.0, -4.0, 55.0});
  EXPECT_LT(climb_s(take_off, state, at_seconds(0.0)), 15.0);
  EXPECT_NEAR(state.z_m, 40.0, 1.0);
}

TEST(TakeOff, WhoIsNotLiftedBeginsAnewFromWhereItIs) {
  TakeOff take_off{copter()};
  VehicleState state = at_rest({0.0, 0.0, 0.0});
  Instant now{};
  double highest_m = 0.0;
  for (; now < at_seconds(60.0); now += kPeriod) {
    ASSERT_FALSE(take_off.done(state, now));
    highest_m = std::max(highest_m, take_off.poll_track()->at(now).position_m.z());
  }
  EXPECT_GT(highest_m, 4.0);
  EXPECT_LT(highest_m, 6.0);
  // A pilot brings it up, and hands it over there.
  state = at_rest({5.0, 5.0, 20.0});
  EXPECT_LT(climb_s(take_off, state, now), 20.0 / 2.0 + 5.0);
  EXPECT_NEAR(state.z_m, 40.0, 1.0);
}

TEST(TakeOff, APlaneNeedsNone) {
  VehicleSpec plane = copter();
  plane.airframe = Airframe::plane;
  TakeOff take_off{plane};
  EXPECT_TRUE(take_off.done(at_rest({0.0, 0.0, 0.0}), Instant{}));
  EXPECT_FALSE(take_off.poll_track());
}

}  // namespace
}  // namespace skein::mission
