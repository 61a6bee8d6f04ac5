// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "counted_calls.hpp"
#include "skein/hal/simulated_multirotor.hpp"

namespace skein::onboard {
namespace {

TEST(MultirotorControl, NeitherAllocatesNorLocks) {
  if (!counted_calls::available()) GTEST_SKIP() << "a sanitizer stands in for what is counted";
  hal::SimulatedMultirotorParams params;
  params.gust_mps = 1.0;
  params.gnss = models::GnssParams{};
  hal::SimulatedMultirotor controller{params};
  counted_calls::reset();
  PositionSetpoint point;
  for (int i = 0; i < 1000; ++i) {  // up, and down again
    const Instant now = at_seconds(0.02 * i);
    point.z_m = i < 300 ? 4.0 : 0.0;
    ASSERT_TRUE(controller.state(now));
    controller.command(point, now);
  }
  EXPECT_FALSE(controller.flying());
  EXPECT_EQ(counted_calls::allocations(), 0);
  EXPECT_EQ(counted_calls::locks(), 0);
}

}  // namespace
}  // namespace skein::onboard
