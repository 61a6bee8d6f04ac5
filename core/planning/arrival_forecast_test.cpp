// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/arrival_forecast.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"

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

TimedPath straight(double length_m) {
  TimedPath plan{.start_time = at_seconds(10.0),
                 .speed_mps = 50.0,
                 .tail_curvature_per_m = 0.0,
                 .path = {.start = {0, 0, 0}, .segments = {}}};
  EXPECT_TRUE(plan.path.append(Segment{0.0, length_m}));
  return plan;
}

TimedPath there_and_back() {
  TimedPath plan = straight(1000.0);
  EXPECT_TRUE(plan.path.append(Segment{1.0 / 250.0, 250.0 * kPi}));
  EXPECT_TRUE(plan.path.append(Segment{0.0, 1500.0}));
  return plan;
}

double forecast_m(const TimedPath& plan, double along_m, const Vec2& wind) {
  return forecast_arrival({}, vehicle(), plan, along_m, wind, plan.start_time, plan.end_time())
      .along_m;
}

TEST(ArrivalForecast, InStillAirSpeedMakesUpForWhatItCan) {
  EXPECT_EQ(forecast_m(straight(1000.0), 0.0, {0, 0}), 0.0);
  EXPECT_NEAR(forecast_m(straight(2000.0), 20.0, {0, 0}), 0.0, 0.1);
  // 20 s at 4 m/s.
  EXPECT_NEAR(forecast_m(straight(1000.0), -150.0, {0, 0}), -70.0, 1e-6);
  EXPECT_NEAR(forecast_m(straight(1000.0), 150.0, {0, 0}), 70.0, 1e-6);
}

TEST(ArrivalForecast, WindTakesWhatTheLimitsDoNotHave) {
  EXPECT_EQ(forecast_m(straight(1000.0), 0.0, {-4, 0}), 0.0);
  EXPECT_NEAR(forecast_m(straight(1000.0), 0.0, {-7, 0}), 20.0 * (54.0 - 7.0 - 50.0), 1e-6);
  EXPECT_NEAR(forecast_m(straight(1000.0), 0.0, {8, 0}), 20.0 * (46.0 + 8.0 - 50.0), 1e-6);
  const double across = std::sqrt(54.0 * 54.0 - 30.0 * 30.0);
  EXPECT_NEAR(forecast_m(straight(1000.0), 0.0, {0, 30}), 20.0 * (across - 50.0), 1e-6);
}

TEST(ArrivalForecast, WhatWasLostAgainstTheWindIsMadeUpForBeforeIt) {
  const auto plan = there_and_back();
  VehicleSpec spec = vehicle();
  spec.speed_min_mps = 40.0;
  const auto forecast =
      forecast_arrival({}, spec, plan, 0.0, {-6, 0}, plan.start_time, plan.end_time());
  EXPECT_GT(forecast.astray_m, 35.0);
  EXPECT_NEAR(forecast.along_m, 0.0, 1.0);
  // And not where it blows against the end.
  const auto against =
      forecast_arrival({}, spec, plan, 0.0, {6, 0}, plan.start_time, plan.end_time());
  EXPECT_LT(against.along_m, -50.0);
}

TEST(ArrivalForecast, EndsWhereThereIsNoTimeLeft) {
  const auto plan = straight(1000.0);
  const auto forecast =
      forecast_arrival({}, vehicle(), plan, -12.0, {5, 5}, at_seconds(31.0), at_seconds(30.0));
  EXPECT_EQ(forecast.along_m, -12.0);
  EXPECT_EQ(forecast.astray_m, 12.0);
}

/// The model of Wang 2022, eq. (2), in gusts, under the follower.
TEST(ArrivalForecast, IsWhatTheFollowerMakesOfIt) {
  const VehicleSpec spec = vehicle();
  Random random{7};
  for (int run = 0; run < 20; ++run) {
    const auto plan = there_and_back();
    const Vec2 steady = random.uniform(0.0, 12.0) * unit_vector(random.uniform(-kPi, kPi));
    const double gust = random.uniform(0.3, 0.7);
    Vec2 position{0, 0};
    double heading = 0.0;
    double airspeed = 50.0;
    VehicleState state;
    constexpr double kPeriod_s = 0.02;
    double t = 10.0;
    while (t < to_seconds(plan.end_time())) {
      const Vec2 gusts{0.5 * std::sin(gust * t), 0.5 * std::sin(1.3 * gust * t)};
      const Vec2 ground = airspeed * unit_vector(heading) + steady + gusts;
      state.x_m = position.x();
      state.y_m = position.y();
      state.heading_rad = wrap_pi(heading);
      state.course_rad = std::atan2(ground.y(), ground.x());
      state.groundspeed_mps = ground.norm();
      state.airspeed_mps = airspeed;
      EXPECT_LT((wind_of(state) - steady - gusts).norm(), 1e-9);
      const Setpoint s = follow_path({}, spec, plan, state, at_seconds(t));
      const double rate_max = airspeed / spec.turn_radius_m;
      heading += std::clamp(spec.heading_gain_per_s * wrap_pi(s.heading_rad - heading), -rate_max,
                            rate_max) *
                 kPeriod_s;
      airspeed += (s.airspeed_mps - airspeed) * kPeriod_s;
      position += ground * kPeriod_s;
      t += kPeriod_s;
    }
    const auto forecast =
        forecast_arrival({}, spec, plan, 0.0, steady, plan.start_time, plan.end_time());
    // Far from its time the follower no longer finds where on its path the vehicle is.
    if (forecast.astray_m > 120.0) continue;
    EXPECT_NEAR(follow_error(plan, state, at_seconds(t)).along_m, forecast.along_m, 15.0)
        << run << ": wind " << steady.x() << ", " << steady.y();
  }
}

}  // namespace
}  // namespace skein::planning
