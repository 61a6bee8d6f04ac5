// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "emulator_test.hpp"

namespace skein::hil {
namespace {

/// The speeds of a small plane, in flight.
EmulatorConfig small_plane() {
  EmulatorConfig config = in_flight();
  config.airspeed_mps = 25.0;
  config.airspeed_min_mps = 20.0;
  config.airspeed_max_mps = 30.0;
  config.turn_radius_m = 66.0;
  return config;
}

TEST(SmallPlane, FliesItsSpeedsAtItsHeight) {
  Companion companion{small_plane()};
  companion.run(15.0);
  for (const float wanted : {20.0F, 30.0F, 25.0F}) {
    EXPECT_EQ(companion.command(mavlink::Command::do_change_speed, 0.0F, wanted),
              mavlink::CommandResult::accepted);
    companion.run(25.0);
    const auto hud = companion.last<mavlink::VfrHud>().value();
    EXPECT_NEAR(hud.airspeed, wanted, 0.5);
    EXPECT_NEAR(hud.alt, 780.0F, 3.0);
  }
}

TEST(SmallPlane, TakesOff) {
  EmulatorConfig config = small_plane();
  config.airborne = false;
  Companion companion{config};
  companion.run(1.0);
  EXPECT_EQ(companion.mode(13), mavlink::CommandResult::accepted);
  EXPECT_EQ(companion.command(mavlink::Command::component_arm_disarm, 1.0F),
            mavlink::CommandResult::accepted);
  EXPECT_TRUE(companion.run_until(
      [&] { return companion.last<mavlink::VfrHud>().value().alt > 535.0F; }, 60.0));
}

}  // namespace
}  // namespace skein::hil
