// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/telemetry_pace.hpp"

#include <gtest/gtest.h>

namespace skein::mission {
namespace {

using namespace std::chrono_literals;

VehicleState at(double x_m, double speed_mps) {
  VehicleState state;
  state.x_m = x_m;
  state.groundspeed_mps = speed_mps;
  return state;
}

TEST(TelemetryPace, IsSlowWhereNobodyIsNear) {
  TelemetryPace pace{{100ms, 500ms}};
  EXPECT_EQ(pace.period(at(0.0, 25.0), at_seconds(0.0)), 500ms);
  pace.hear({2}, at(250.0, 25.0), at_seconds(0.0));
  EXPECT_EQ(pace.period(at(0.0, 25.0), at_seconds(0.0)), 500ms);
}

TEST(TelemetryPace, IsFasterTheNearerTheNearestIs) {
  TelemetryPace pace{{100ms, 500ms}};
  pace.hear({2}, at(1000.0, 25.0), at_seconds(0.0));
  pace.hear({3}, at(150.0, 25.0), at_seconds(0.0));
  EXPECT_EQ(pace.period(at(0.0, 25.0), at_seconds(0.0)), 250ms);  // 0.3 s would do
  pace.hear({3}, at(100.0, 25.0), at_seconds(0.1));
  EXPECT_EQ(pace.period(at(0.0, 25.0), at_seconds(0.1)), Duration{500ms} / 3);  // 0.2 s would do
}

TEST(TelemetryPace, HasAShortest) {
  TelemetryPace pace{{100ms, 500ms}};
  pace.hear({2}, at(0.0, 25.0), at_seconds(0.0));
  EXPECT_EQ(pace.period(at(0.0, 25.0), at_seconds(0.0)), 100ms);
}

TEST(TelemetryPace, WhoStandsStillNextToAnotherNeedsNoMore) {
  TelemetryPace pace{{100ms, 500ms}};
  pace.hear({2}, at(1.0, 0.0), at_seconds(0.0));
  EXPECT_EQ(pace.period(at(0.0, 0.0), at_seconds(0.0)), 500ms);
}

TEST(TelemetryPace, ForgetsWhoIsSilent) {
  TelemetryPace pace{{100ms, 500ms}};
  pace.hear({2}, at(50.0, 25.0), at_seconds(0.0));
  EXPECT_EQ(pace.period(at(0.0, 25.0), at_seconds(2.9)), 100ms);
  EXPECT_EQ(pace.period(at(0.0, 25.0), at_seconds(3.1)), 500ms);
}

}  // namespace
}  // namespace skein::mission
