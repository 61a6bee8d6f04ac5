// SPDX-License-Identifier: Apache-2.0
#include "return_track.hpp"

#include <gtest/gtest.h>

#include "skein/base/angles.hpp"

namespace skein::planning {
namespace {

constexpr double kApart_m = 30.0;
constexpr double kRadius_m = 60.0;

/// Straight on for so long, then around to the left.
ReturnTrack straight_on(const Pose2& from, double length_m) {
  TimedPath timed;
  timed.speed_mps = 20.0;
  timed.path.start = from;
  EXPECT_TRUE(timed.path.append(Segment{0.0, length_m}));
  timed.tail_curvature_per_m = 1.0 / kRadius_m;
  return {timed, Instant{}};
}

TEST(ReturnTrack, RingsOfOneHeightKeepTheirDistance) {
  for (const double more_m : {-1.0, 1.0}) {
    const auto a = straight_on({-2000.0, 0.0, 0.0}, 1000.0);
    const auto b = straight_on({-2000.0, 2.0 * kRadius_m + kApart_m + more_m, 0.0}, 1000.0);
    EXPECT_EQ(stay_apart(a, b, kApart_m), more_m > 0.0) << more_m;
  }
}

/// One arrives on the far side of its orbit: by itself it is far from the other one, which passes
/// the near side before as much time has gone by as the two would need to meet.
TEST(ReturnTrack, WhoArrivesIsAnywhereOnItsOrbitAtOnce) {
  const auto arrives = straight_on({-kRadius_m, 1.0, -kPi / 2.0}, 1.0);
  EXPECT_NEAR(arrives.ring().centre.norm(), 0.0, 1e-9);
  const auto passes = straight_on({kRadius_m + 5.0, 0.0, 0.0}, 2000.0);
  EXPECT_FALSE(stay_apart(arrives, passes, kApart_m));
  EXPECT_FALSE(stay_apart(passes, arrives, kApart_m));
  const auto passes_by = straight_on({kRadius_m + kApart_m + 5.0, 0.0, 0.0}, 2000.0);
  EXPECT_TRUE(stay_apart(arrives, passes_by, kApart_m));
}

}  // namespace
}  // namespace skein::planning
