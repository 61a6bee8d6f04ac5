// SPDX-License-Identifier: Apache-2.0
#include "skein/planning/task_path.hpp"

#include <gtest/gtest.h>

#include "skein/base/angles.hpp"

namespace skein::planning {
namespace {

Site site_at(const Vec2& position) {
  Site site;
  site.id = SiteId{1};
  site.position = position;
  return site;
}

TEST(TaskPath, ADeliveryEndsOverTheSiteOnItsBearing) {
  const Site site = site_at({3500, 2800});
  for (const double bearing : {0.0, 1.0, kPi, -2.5, 6.0}) {
    const TaskPath task = delivery_path(site, {bearing, {}}, 400.0);
    const Pose2 end = advance(task.entry, task.run.curvature_per_m, task.run.length_m);
    EXPECT_NEAR((end.position() - site.position).norm(), 0.0, 1e-9);
    EXPECT_NEAR(wrap_pi(end.heading_rad - bearing), 0.0, 1e-12);
    EXPECT_EQ(task.run.curvature_per_m, 0.0);
    EXPECT_EQ(task.run.length_m, 400.0);
  }
}

TEST(TaskPath, AnArcStaysOnItsCircleForTheDwell) {
  const Site site = site_at({100, -50});
  for (const int turn : {1, -1}) {
    for (const double angle : {0.0, 2.0, -3.0}) {
      const TaskPath task = arc_path(site, angle, std::chrono::seconds{20}, 300.0, 50.0, turn, 1.1);
      EXPECT_NEAR(task.run.length_m / 50.0, 22.0, 1e-9);
      const Vec2 out = task.entry.position() - site.position;
      EXPECT_NEAR(wrap_pi(std::atan2(out.y(), out.x()) - angle), 0.0, 1e-12);
      for (int i = 0; i <= 10; ++i) {
        const double s = task.run.length_m * i / 10.0;
        const Pose2 at = advance(task.entry, task.run.curvature_per_m, s);
        const Vec2 spoke = at.position() - site.position;
        EXPECT_NEAR(spoke.norm(), 300.0, 1e-9);
        // The direction from the site turns the way that was asked for (Wang 2022, eq. 16).
        EXPECT_NEAR(wrap_pi(std::atan2(spoke.y(), spoke.x()) - angle - turn * s / 300.0), 0.0,
                    1e-9);
      }
    }
  }
}

}  // namespace
}  // namespace skein::planning
