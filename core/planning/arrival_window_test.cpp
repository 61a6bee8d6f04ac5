// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/arrival_window.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "skein/base/angles.hpp"
#include "skein/planning/path_follower.hpp"

namespace skein::planning {
namespace {

VehicleSpec vehicle() {
  VehicleSpec v;
  v.id = VehicleId{1};
  v.cruise_speed_mps = 50.0;
  v.speed_min_mps = 46.0;
  v.speed_max_mps = 54.0;
  v.turn_radius_m = 150.0;
  v.heading_gain_per_s = 1.5;
  return v;
}

TimedPath straight_then_turn() {
  TimedPath plan{.start_time = at_seconds(10.0),
                 .speed_mps = 50.0,
                 .tail_curvature_per_m = 0.0,
                 .path = {.start = {0, 0, 0}, .segments = {}}};
  EXPECT_TRUE(plan.path.append(Segment{0.0, 1000.0}));
  EXPECT_TRUE(plan.path.append(Segment{1.0 / 200.0, 100.0 * kPi}));
  EXPECT_TRUE(plan.path.append(Segment{0.0, 2000.0}));
  return plan;
}

VehicleState state_in(const Vec2& wind, const Vec2& position) {
  VehicleState s;
  s.x_m = position.x();
  s.y_m = position.y();
  s.airspeed_mps = 50.0;
  const Vec2 ground = Vec2{50.0, 0.0} + wind;
  s.groundspeed_mps = ground.norm();
  s.course_rad = std::atan2(ground.y(), ground.x());
  return s;
}

TEST(ArrivalWindow, IsDistanceBySpeedInStillAir) {
  const auto plan = straight_then_turn();
  const auto window =
      arrival_window(vehicle(), plan, state_in({0, 0}, {0, 0}), 1000.0, at_seconds(10.0));
  EXPECT_NEAR(to_seconds(window.earliest), 10.0 + 1000.0 / 54.0, 1e-6);
  EXPECT_NEAR(to_seconds(window.latest), 10.0 + 1000.0 / 46.0, 1e-6);
}

TEST(ArrivalWindow, CountsFromWhereTheVehicleIs) {
  const auto plan = straight_then_turn();
  // 100 m behind its time, and 30 m beside the line.
  const auto window =
      arrival_window(vehicle(), plan, state_in({0, 0}, {400, 30}), 1000.0, at_seconds(20.0));
  EXPECT_NEAR(to_seconds(window.earliest), 20.0 + 600.0 / 54.0, 1e-6);
  const auto past =
      arrival_window(vehicle(), plan, state_in({0, 0}, {1000, 0}), 900.0, at_seconds(30.0));
  EXPECT_EQ(past.earliest, at_seconds(30.0));
  EXPECT_EQ(past.latest, at_seconds(30.0));
}

TEST(ArrivalWindow, HasTheWindInIt) {
  const auto plan = straight_then_turn();
  const auto ahead =
      arrival_window(vehicle(), plan, state_in({-8, 0}, {0, 0}), 1000.0, at_seconds(10.0));
  EXPECT_NEAR(to_seconds(ahead.earliest), 10.0 + 1000.0 / 46.0, 1e-6);
  const auto across =
      arrival_window(vehicle(), plan, state_in({0, 8}, {0, 0}), 1000.0, at_seconds(10.0));
  EXPECT_NEAR(to_seconds(across.earliest), 10.0 + 1000.0 / std::sqrt(54.0 * 54.0 - 64.0), 1e-6);
}

/// The model of Wang 2022, eq. (2), in a wind with gusts, as fast or as slow as it may.
TEST(ArrivalWindow, IsWhenTheFollowerGetsThereWhoIsAskedForTooMuch) {
  const VehicleSpec spec = vehicle();
  const Vec2 steady{-4.0, 3.0};
  for (const double asked : {54.0, 40.0}) {
    TimedPath plan = straight_then_turn();
    const auto window =
        arrival_window(spec, plan, state_in(steady, {0, 0}), 1200.0, at_seconds(10.0));
    plan.speed_mps = asked;
    const Vec2 goal = plan.path.pose_at(1200.0).position();
    Vec2 position{0, 0};
    double heading = 0.0;
    double airspeed = asked > 50.0 ? spec.speed_max_mps : spec.speed_min_mps;
    double t = 10.0;
    double nearest_m = 1e9;
    double nearest_t = 0.0;
    while (t < 60.0) {
      const Vec2 gust{0.5 * std::sin(0.7 * t), 0.5 * std::sin(0.9 * t)};
      const Vec2 ground = airspeed * unit_vector(heading) + steady + gust;
      VehicleState state;
      state.x_m = position.x();
      state.y_m = position.y();
      state.heading_rad = wrap_pi(heading);
      state.course_rad = std::atan2(ground.y(), ground.x());
      state.groundspeed_mps = ground.norm();
      state.airspeed_mps = airspeed;
      const Setpoint s = follow_path({}, spec, plan, state, at_seconds(t));
      heading += std::clamp(spec.heading_gain_per_s * wrap_pi(s.heading_rad - heading),
                            -airspeed / spec.turn_radius_m, airspeed / spec.turn_radius_m) *
                 0.02;
      airspeed += (s.airspeed_mps - airspeed) * 0.02;
      position += ground * 0.02;
      t += 0.02;
      if (const double d = (position - goal).norm(); d < nearest_m) {
        nearest_m = d;
        nearest_t = t;
      }
    }
    const double predicted = to_seconds(asked > 50.0 ? window.earliest : window.latest);
    EXPECT_LT(nearest_m, 60.0);
    EXPECT_NEAR(nearest_t, predicted, 1.0) << asked;
  }
}

}  // namespace
}  // namespace skein::planning
