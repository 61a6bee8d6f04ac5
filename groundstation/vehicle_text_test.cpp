// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/vehicle_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace skein::groundstation {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(VehicleText, TellsAllOfOneVehicleAndWhereItsPicturesAre) {
  mission::Fleet fleet{{.expected = {{3}}}};
  console::Picture picture{{.expected = {{3}}}};
  mission::Telemetry told;
  told.vehicle = {3};
  told.state.x_m = 120.0;
  told.state.groundspeed_mps = 24.0;
  fleet.on_message(mission::Message{told}, at_seconds(1.0));
  mission::Health health;
  health.vehicle = {3};
  health.program = "skein-onboard 1.0";
  health.flight_controller = "simulated";
  health.heard = {{kGroundStation, std::chrono::milliseconds{200}, 100, 1}};
  fleet.on_message(mission::Message{health}, at_seconds(1.0));
  const Answer with =
      vehicle_answer({3}, picture, fleet, "rtsp://192.168.1.23/stream", at_seconds(1.5));
  ASSERT_TRUE(with.done);
  for (const char* part :
       {"E 120 N 0 m", "24.0 m/s", "skein-onboard 1.0", "simulated", "ground 10.0/s 1 %",
        "video              rtsp://192.168.1.23/stream\n"}) {
    EXPECT_THAT(with.text, HasSubstr(part));
  }
  EXPECT_THAT(vehicle_answer({3}, picture, fleet, "", at_seconds(1.5)).text,
              Not(HasSubstr("video")));
  EXPECT_FALSE(vehicle_answer({4}, picture, fleet, "", at_seconds(1.5)).done);
}

}  // namespace
}  // namespace skein::groundstation
