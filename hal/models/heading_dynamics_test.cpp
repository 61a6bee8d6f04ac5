// SPDX-License-Identifier: Apache-2.0
#include "skein/models/heading_dynamics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "skein/base/angles.hpp"

namespace skein::models {
namespace {

VehicleSpec vehicle() {
  VehicleSpec spec;
  spec.id = {1};
  spec.cruise_speed_mps = 50.0;
  spec.speed_min_mps = 40.0;
  spec.speed_max_mps = 60.0;
  spec.turn_radius_m = 100.0;
  spec.heading_gain_per_s = 2.0;
  spec.height_m = 120.0;
  return spec;
}

HeadingDynamics at_origin(const WindParams& wind = {}) {
  return HeadingDynamics{vehicle(), Wind{wind}, Pose2{0.0, 0.0, 0.0}, Instant{}};
}

TEST(HeadingDynamics, FliesStraightAtCruiseSpeed) {
  HeadingDynamics model = at_origin();
  model.advance_to(at_seconds(10.0));
  EXPECT_NEAR(model.state().x_m, 500.0, 1e-6);
  EXPECT_NEAR(model.state().y_m, 0.0, 1e-6);
  EXPECT_NEAR(model.state().distance_flown_m, 500.0, 1e-6);
  EXPECT_EQ(model.state().time, at_seconds(10.0));
  EXPECT_DOUBLE_EQ(model.state().z_m, 120.0);
}

TEST(HeadingDynamics, SmallTurnIsTheExponentialOfTheEquation) {
  HeadingDynamics model = at_origin();
  // 0.2 rad * W = 0.4 rad/s lies below the limit of 50/100 rad/s
  model.command({.heading_rad = 0.2, .airspeed_mps = 50.0, .height_m = 120.0});
  model.advance_to(at_seconds(0.7));
  EXPECT_NEAR(model.state().heading_rad, 0.2 * (1.0 - std::exp(-2.0 * 0.7)), 1e-9);
}

TEST(HeadingDynamics, LargeTurnHoldsTheTurnRadius) {
  HeadingDynamics model = at_origin();
  model.command({.heading_rad = 3.0, .airspeed_mps = 50.0, .height_m = 120.0});
  model.advance_to(at_seconds(4.0));  // 2 rad at 0.5 rad/s
  EXPECT_NEAR(model.state().heading_rad, 2.0, 1e-9);
  EXPECT_NEAR(model.state().x_m, 100.0 * std::sin(2.0), 1e-5);
  EXPECT_NEAR(model.state().y_m, 100.0 * (1.0 - std::cos(2.0)), 1e-5);
}

TEST(HeadingDynamics, TurnsTheShortWayRound) {
  HeadingDynamics model{vehicle(), Wind{{}}, Pose2{0.0, 0.0, 3.0}, Instant{}};
  model.command({.heading_rad = -3.0, .airspeed_mps = 50.0, .height_m = 120.0});
  double least = 3.0;
  for (int i = 1; i <= 500; ++i) {
    model.advance_to(at_seconds(0.02 * i));
    least = std::min(least, std::abs(model.state().heading_rad));
  }
  EXPECT_GT(least, 2.99);  // through pi, not through 0
  EXPECT_NEAR(model.state().heading_rad, -3.0, 1e-6);
}

TEST(HeadingDynamics, NeverTurnsTighterThanItsRadius) {
  HeadingDynamics model = at_origin();
  double before = 0.0;
  for (int i = 1; i <= 3000; ++i) {
    // a hectic pilot
    model.command({.heading_rad = 2.5 * std::sin(0.31 * i),
                   .airspeed_mps = 50.0 + 20.0 * std::cos(0.17 * i),
                   .height_m = 120.0});
    const double slowest = model.state().airspeed_mps;
    model.advance_to(at_seconds(0.02 * i));
    const double turned = std::abs(wrap_pi(model.state().heading_rad - before));
    const double fastest = std::max(slowest, model.state().airspeed_mps);
    ASSERT_LE(turned, fastest / 100.0 * 0.02 * (1.0 + 1e-9));
    ASSERT_GE(model.state().airspeed_mps, 40.0);
    ASSERT_LE(model.state().airspeed_mps, 60.0);
    before = model.state().heading_rad;
  }
}

TEST(HeadingDynamics, AirspeedAndHeightAreFirstOrder) {
  HeadingDynamics model = at_origin();
  model.command({.heading_rad = 0.0, .airspeed_mps = 100.0, .height_m = 150.0});
  model.advance_to(at_seconds(1.0));
  EXPECT_NEAR(model.state().airspeed_mps, 60.0 - 10.0 * std::exp(-1.0), 1e-9);  // limit, not 100
  EXPECT_NEAR(model.state().z_m, 150.0 - 30.0 * std::exp(-1.0 / 3.0), 1e-9);
}

TEST(HeadingDynamics, WindCarriesIt) {
  HeadingDynamics model = at_origin({.steady_mps = {0.0, 10.0}});
  model.advance_to(at_seconds(2.0));
  EXPECT_NEAR(model.state().x_m, 100.0, 1e-6);
  EXPECT_NEAR(model.state().y_m, 20.0, 1e-6);
  EXPECT_NEAR(model.state().course_rad, std::atan2(10.0, 50.0), 1e-12);
  EXPECT_NEAR(model.state().groundspeed_mps, std::hypot(10.0, 50.0), 1e-12);
  EXPECT_NEAR(model.state().distance_flown_m, 2.0 * std::hypot(10.0, 50.0), 1e-6);
  EXPECT_DOUBLE_EQ(model.state().heading_rad, 0.0);
}

TEST(HeadingDynamics, HowOftenItIsAskedDoesNotMatter) {
  const WindParams wind{.steady_mps = {4.0, 3.0}, .gust_mps = 2.0, .seed = 5};
  HeadingDynamics often = at_origin(wind);
  HeadingDynamics once = at_origin(wind);
  for (HeadingDynamics* model : {&often, &once}) {
    model->command({.heading_rad = 2.0, .airspeed_mps = 57.0, .height_m = 120.0});
  }
  for (int i = 1; i <= 1000; ++i) often.advance_to(at_seconds(0.0137 * i));
  once.advance_to(at_seconds(13.7));
  EXPECT_NEAR(often.state().x_m, once.state().x_m, 1e-5);
  EXPECT_NEAR(often.state().y_m, once.state().y_m, 1e-5);
  EXPECT_NEAR(often.state().heading_rad, once.state().heading_rad, 1e-5);
}

TEST(HeadingDynamics, IgnoresASetpointThatIsNoNumber) {
  HeadingDynamics model = at_origin();
  model.command({.heading_rad = std::numeric_limits<double>::quiet_NaN(),
                 .airspeed_mps = 50.0,
                 .height_m = 120.0});
  model.advance_to(at_seconds(1.0));
  EXPECT_NEAR(model.state().x_m, 50.0, 1e-6);
}

}  // namespace
}  // namespace skein::models
