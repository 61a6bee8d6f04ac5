// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "skein/base/angles.hpp"
#include "skein/domain/path.hpp"
#include "skein/domain/site.hpp"

namespace skein {
namespace {

static_assert(std::is_trivially_copyable_v<Segment>);

TEST(TimedPath, FliesItsSegmentsThenHoldsForEver) {
  TimedPath plan;
  plan.start_time = at_seconds(10.0);
  plan.speed_mps = 50.0;
  plan.tail_curvature_per_m = 1.0 / 100.0;
  ASSERT_TRUE(plan.path.append(Segment{0.0, 500.0}));
  EXPECT_EQ(plan.end_time(), at_seconds(20.0));
  EXPECT_NEAR(plan.pose_at(at_seconds(15.0)).x_m, 250.0, 1e-9);
  EXPECT_NEAR(plan.pose_at(at_seconds(5.0)).x_m, 0.0, 1e-9);
  // Half an orbit later it is a diameter to the left, and after a whole one back at the end.
  const double half = kPi * 100.0 / 50.0;
  const Pose2 opposite = plan.pose_at(at_seconds(20.0 + half));
  EXPECT_NEAR(opposite.x_m, 500.0, 1e-6);
  EXPECT_NEAR(opposite.y_m, 200.0, 1e-6);
  EXPECT_NEAR(plan.pose_at(at_seconds(20.0 + 2 * half)).y_m, 0.0, 1e-6);
}

TEST(TimedPath, APieceOfItIsFlownTheSame) {
  TimedPath plan;
  plan.speed_mps = 10.0;
  plan.tail_curvature_per_m = -0.02;
  ASSERT_TRUE(plan.path.append(Segment{0.0, 100.0}));
  ASSERT_TRUE(plan.path.append(Segment{0.01, 50.0}));
  const auto piece = plan.piece(60.0, 300.0);
  ASSERT_TRUE(piece);
  EXPECT_EQ(piece->segments.size(), 3U);
  EXPECT_NEAR(piece->length_m(), 240.0, 1e-9);
  for (int d = 0; d <= 240; d += 7) {
    const Pose2 a = piece->pose_at(d);
    const Pose2 b = plan.pose_at_distance(60.0 + d);
    EXPECT_NEAR(a.x_m, b.x_m, 1e-9);
    EXPECT_NEAR(a.y_m, b.y_m, 1e-9);
  }
}

TEST(Path, RefusesMoreSegmentsThanItHolds) {
  Path path;
  for (std::size_t i = 0; i < kPathSegmentsMax; ++i) ASSERT_TRUE(path.append(Segment{0.0, 1.0}));
  EXPECT_FALSE(path.append(Segment{0.0, 1.0}));
  EXPECT_TRUE(path.append(Segment{0.0, 0.0})) << "a piece of no length needs no room";
  EXPECT_DOUBLE_EQ(path.length_m(), static_cast<double>(kPathSegmentsMax));
}

TEST(Site, ListsItsTasksInOrder) {
  Site site;
  site.id = SiteId{3};
  site.deliveries.resize(2);
  site.assessments.resize(1);
  const auto tasks = tasks_after_survey(site);
  ASSERT_EQ(tasks.size(), 3U);
  EXPECT_EQ(to_string(tasks[1]), "site 3 deliver 2");
  EXPECT_EQ(to_string(tasks[2]), "site 3 assess 1");
}

TEST(Capabilities, BitsSurviveARoundTripAndNothingElseDoes) {
  Capabilities c;
  c.add(TaskKind::deliver);
  EXPECT_TRUE(c.has(TaskKind::deliver));
  EXPECT_FALSE(c.has(TaskKind::assess));
  EXPECT_EQ(Capabilities::from_bits(c.bits()), c);
  EXPECT_EQ(Capabilities::from_bits(0xF8).bits(), 0);
}

}  // namespace
}  // namespace skein
