// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/ground_fence.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "skein/mission/fleet.hpp"

namespace skein::mission {
namespace {

Fence square(double half_m) {
  Fence fence;
  fence.corners = {{-half_m, -half_m}, {half_m, -half_m}, {half_m, half_m}, {-half_m, half_m}};
  return fence;
}

Fleet with_one_at(double x_m, double z_m) {
  Fleet fleet{{.expected = {{3}, {4}}}};
  Telemetry telemetry;
  telemetry.vehicle = {3};
  telemetry.state.x_m = x_m;
  telemetry.state.z_m = z_m;
  fleet.on_message(Message{telemetry}, {});
  return fleet;
}

std::vector<FenceOrder> said(GroundFence& ground) {
  std::vector<FenceOrder> all;
  while (const auto message = ground.poll_message()) all.push_back(std::get<FenceOrder>(*message));
  return all;
}

TEST(GroundFence, TellsOfItAgainAndAgain) {
  GroundFence ground{square(100.0)};
  EXPECT_FALSE(ground.ordered());
  const auto first = ground.order(square(500.0), with_one_at(0.0, 50.0), at_seconds(3.0));
  ASSERT_TRUE(first.ok());
  const auto second = ground.order(square(600.0), with_one_at(0.0, 50.0), at_seconds(3.0));
  EXPECT_GT(*second, *first);
  for (int s = 4; s < 30; ++s) ground.on_timeout(at_seconds(s));
  const auto all = said(ground);
  EXPECT_GE(all.size(), 6U);
  EXPECT_EQ(all.back().number, *second);
  EXPECT_EQ(all.back().corners, square(600.0).corners);
  EXPECT_EQ(ground.fence(), square(600.0));
}

TEST(GroundFence, NobodyIsShutOut) {
  GroundFence ground{{}};
  EXPECT_EQ(ground.order(square(500.0), with_one_at(501.0, 50.0), {}).error().message,
            "vehicle 3 is outside of it: widen it, or bring the vehicle in first");
  EXPECT_EQ(ground.order(square(500.0), with_one_at(0.0, 121.0), {}).error().message,
            "vehicle 3 flies above its height: raise that, or bring it down first");
  Fence line = square(500.0);
  line.corners.resize(2);
  EXPECT_FALSE(ground.order(line, with_one_at(0.0, 0.0), {}).ok());
  EXPECT_FALSE(ground.ordered());
  EXPECT_TRUE(said(ground).empty());
}

TEST(GroundFence, StandsAfterANewStart) {
  GroundFence before{{}};
  ASSERT_TRUE(before.order(square(500.0), with_one_at(0.0, 50.0), at_seconds(100.0)).ok());
  const auto told = said(before);
  GroundFence after{square(100.0)};
  after.recall(Message{told[0]}, {3}, at_seconds(120.0));
  EXPECT_EQ(after.fence(), square(100.0)) << "others do not order one";
  after.recall(Message{told[0]}, kGroundStation, at_seconds(120.0));
  EXPECT_EQ(after.fence(), square(500.0));
  after.on_timeout(at_seconds(120.0));
  EXPECT_EQ(said(after).size(), 1U);
}

}  // namespace
}  // namespace skein::mission
