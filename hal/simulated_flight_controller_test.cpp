// SPDX-License-Identifier: Apache-2.0
#include "skein/hal/simulated_flight_controller.hpp"

#include <gtest/gtest.h>

namespace skein::hal {
namespace {

SimulatedFlightController controller() {
  VehicleSpec spec;
  spec.id = {3};
  spec.cruise_speed_mps = 50.0;
  spec.speed_min_mps = 40.0;
  spec.speed_max_mps = 60.0;
  spec.turn_radius_m = 100.0;
  spec.heading_gain_per_s = 2.0;
  return SimulatedFlightController{spec, Pose2{10.0, 20.0, 0.0}, {}};
}

TEST(SimulatedFlightController, StaysAtItsStartBeforeTheMission) {
  auto fc = controller();
  for (const double s : {-30.0, -10.0, 0.0}) {
    const auto state = fc.state(at_seconds(s));
    ASSERT_TRUE(state);
    EXPECT_EQ(state->time, at_seconds(s));
    EXPECT_DOUBLE_EQ(state->x_m, 10.0);
    EXPECT_DOUBLE_EQ(state->y_m, 20.0);
    EXPECT_DOUBLE_EQ(state->distance_flown_m, 0.0);
  }
}

TEST(SimulatedFlightController, FliesFromMissionTimeZero) {
  auto fc = controller();
  (void)fc.state(at_seconds(-1.0));
  EXPECT_EQ(fc.airborne(), Airborne::no);
  const auto state = fc.state(at_seconds(2.0));
  ASSERT_TRUE(state);
  EXPECT_NEAR(state->x_m, 110.0, 1e-6);
  EXPECT_EQ(state->time, at_seconds(2.0));
  EXPECT_EQ(fc.airborne(), Airborne::yes);
}

TEST(SimulatedFlightController, ACommandHoldsFromItsTimeOn) {
  auto fc = controller();
  fc.command(Setpoint{.heading_rad = 1.0, .airspeed_mps = 50.0, .height_m = 0.0}, at_seconds(1.0));
  const auto at_command = fc.state(at_seconds(1.0));
  ASSERT_TRUE(at_command);
  EXPECT_DOUBLE_EQ(at_command->heading_rad, 0.0);  // nothing turned before it was asked to
  EXPECT_NEAR(at_command->x_m, 60.0, 1e-6);
  EXPECT_NEAR(fc.state(at_seconds(10.0))->heading_rad, 1.0, 1e-4);
}

}  // namespace
}  // namespace skein::hal
