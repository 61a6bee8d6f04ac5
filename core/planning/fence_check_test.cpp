// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/fence_check.hpp"

#include <gtest/gtest.h>

namespace skein::planning {
namespace {

const Fence kSquare{{{-100.0, -100.0}, {100.0, -100.0}, {100.0, 100.0}, {-100.0, 100.0}}, 120.0};

TEST(FenceCheck, ALineIsFoundWhereItLeavesTheFence) {
  EXPECT_FALSE(first_outside(kSquare, {0.0, 0.0}, {99.0, 0.0}));
  const auto out = first_outside(kSquare, {0.0, 50.0}, {300.0, 50.0});
  ASSERT_TRUE(out);
  EXPECT_NEAR(out->x(), 100.0, 0.6);
  EXPECT_EQ(place_text({99.6, -40.2}), "[100, -40]");
}

TEST(FenceCheck, WhoBeginsOutsideMayComeInAndNotLeaveAgain) {
  EXPECT_FALSE(first_outside(kSquare, {150.0, 0.0}, {0.0, 0.0}));
  EXPECT_TRUE(first_outside(kSquare, {150.0, 0.0}, {-150.0, 0.0}));
  EXPECT_TRUE(first_outside(kSquare, {150.0, 0.0}, {160.0, 0.0}));
}

TEST(FenceCheck, TheOrbitAtTheEndCounts) {
  TimedPath timed;
  timed.speed_mps = 20.0;
  timed.path.start = {-50.0, 40.0, 0.0};
  ASSERT_TRUE(timed.path.append(Segment{0.0, 100.0}));
  timed.tail_curvature_per_m = -1.0 / 40.0;
  EXPECT_FALSE(first_outside(kSquare, timed));
  timed.tail_curvature_per_m = 1.0 / 40.0;
  EXPECT_TRUE(first_outside(kSquare, timed)) << "80 m to the north of the end";
  EXPECT_FALSE(first_outside(kSquare, timed.path));
}

TEST(FenceCheck, CornersAreNotFlownOver) {
  EXPECT_TRUE(can_be_flown_over(kSquare, {99.0, 0.0}, 40.0)) << "along the edge";
  EXPECT_TRUE(can_be_flown_over(kSquare, {85.0, 85.0}, 40.0));
  EXPECT_FALSE(can_be_flown_over(kSquare, {95.0, 95.0}, 40.0));
  EXPECT_TRUE(can_be_flown_over(kSquare, {95.0, 95.0}, 5.0));
  const Fence corridor{{{-500.0, -10.0}, {500.0, -10.0}, {500.0, 10.0}, {-500.0, 10.0}}, 120.0};
  EXPECT_TRUE(can_be_flown_over(corridor, {0.0, 0.0}, 40.0)) << "straight through";
  EXPECT_FALSE(orbit_leads_over(corridor, {0.0, 0.0}, 40.0));
  EXPECT_TRUE(can_be_flown_over({}, {0.0, 0.0}, 40.0));
}

TEST(FenceCheck, WithoutAFenceNothingIsOutside) {
  EXPECT_FALSE(first_outside({}, {0.0, 0.0}, {1e6, 0.0}));
}

}  // namespace
}  // namespace skein::planning
