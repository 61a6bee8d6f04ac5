// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

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

/// A copter of a coalition, in gusts: straight on, half a circle, then orbits.
TEST(MultirotorControl, FollowsAFlightPlanAndNeitherAllocatesNorLocks) {
  if (!counted_calls::available()) GTEST_SKIP() << "a sanitizer stands in for what is counted";
  hal::SimulatedMultirotorParams params;
  params.wind_mps = {2.0, -1.0};
  params.gust_mps = 0.5;
  hal::SimulatedMultirotor controller{params};
  VehicleSpec copter;
  copter.airframe = Airframe::copter;
  copter.height_m = 20.0;
  ControlPorts ports;
  ControlLoop loop{copter, controller, ports};
  mission::FlightPlan plan;
  plan.number = 7;
  plan.timed.start_time = at_seconds(15.0);
  plan.timed.speed_mps = 7.0;
  plan.timed.tail_curvature_per_m = -1.0 / 30.0;
  ASSERT_TRUE(plan.timed.path.append(Segment{0.0, 70.0}));
  ASSERT_TRUE(plan.timed.path.append(Segment{1.0 / 30.0, M_PI * 30.0}));
  ASSERT_TRUE(plan.timed.path.append(Segment{0.0, 70.0}));
  const mission::Guidance up = climb_to(20.0, at_seconds(0.0));
  const mission::Guidance along = plan;
  double worst_m = 0.0;
  counted_calls::reset();
  for (int i = 0; i < 4000; ++i) {
    const Instant now = at_seconds(0.02 * i);
    if (i == 0) ports.guidance.write(up);
    if (i == 750) ports.guidance.write(along);
    loop.step(now);
    if (i < 1000) continue;  // it starts from rest
    const Vec3 off = controller.true_position().metres() -
                     (Vec3{} << plan.timed.pose_at(now).position(), 20.0).finished();
    worst_m = std::max(worst_m, off.norm());
  }
  EXPECT_EQ(counted_calls::allocations(), 0);
  EXPECT_EQ(counted_calls::locks(), 0);
  std::printf("worst %.2f m\n", worst_m);
  EXPECT_LT(worst_m, 2.0);
  EXPECT_TRUE(ports.plans.pop());
}

}  // namespace
}  // namespace skein::onboard
