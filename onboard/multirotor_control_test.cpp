// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "counted_calls.hpp"
#include "skein/hal/simulated_multirotor.hpp"
#include "skein/onboard/control_loop.hpp"

namespace skein::onboard {
namespace {

/// At rest at the start, and from then on at `z_m` above it.
MotionTrack climb_to(double z_m, Instant start) {
  MotionTrack track;
  track.number = 1;
  track.start = start;
  track.count = 2;
  track.points[1].position_m = {0.0, 0.0, z_m};
  return track;
}

TEST(MultirotorControl, NeitherAllocatesNorLocks) {
  if (!counted_calls::available()) GTEST_SKIP() << "a sanitizer stands in for what is counted";
  hal::SimulatedMultirotorParams params;
  params.gust_mps = 1.0;
  params.gnss = models::GnssParams{};
  hal::SimulatedMultirotor controller{params};
  ControlPorts ports;
  ControlLoop loop{VehicleSpec{}, controller, ports};
  const mission::Guidance up = climb_to(4.0, at_seconds(0.0));
  const mission::Guidance down = climb_to(0.0, at_seconds(6.0));
  counted_calls::reset();
  for (int i = 0; i < 1000; ++i) {
    if (i == 0) ports.guidance.write(up);
    if (i == 300) ports.guidance.write(down);
    loop.step(at_seconds(0.02 * i));
    if (i == 290) {
      EXPECT_TRUE(controller.flying());
    }
  }
  EXPECT_FALSE(controller.flying());
  EXPECT_EQ(counted_calls::allocations(), 0);
  EXPECT_EQ(counted_calls::locks(), 0);
  EXPECT_FALSE(ports.plans.pop());  // a track is no flight plan
  const auto first = ports.track.pop();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->plan_number, 1U);
}

}  // namespace
}  // namespace skein::onboard
