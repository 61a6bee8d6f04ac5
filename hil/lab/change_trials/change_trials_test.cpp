// SPDX-License-Identifier: Apache-2.0
#include "skein/change_trials/change_trials.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>

#include "skein/base/angles.hpp"
#include "skein/base/random.hpp"

namespace skein::change_trials {
namespace {

void expect_separation(std::size_t changes, std::size_t jobs) {
  std::size_t planned = 0;
  for (const JudgedChange& change : try_changes(1, changes, jobs)) {
    EXPECT_TRUE(change.violation.empty())
        << "skein-hil changes --runs 1 --first-seed " << change.seed << ": " << change.violation;
    planned += change.refused.empty() ? 1 : 0;
  }
  // Some have to be refused, where places are given out at random below a ceiling.
  EXPECT_GT(planned, changes * 8 / 10);
}

TEST(ChangeTrials, FiveHundredRandomChangesKeepTheirSeparation) { expect_separation(500, 1); }

/// Random changes seldom have everybody cross in the middle.
TEST(ChangeTrials, SwapsOnLevelsKeepTheirSeparation) {
  Random random{5};
  int on_levels = 0;
  for (int i = 0; i < 12; ++i) {
    const std::size_t n = 12 + random.index(60);
    formation::ChangeRequest request;
    request.limits = {.speed_mps = random.uniform(2.0, 8.0)};
    request.separation = {3.0, random.uniform(2.0, 5.0)};
    request.reserve_m = random.uniform(0.5, 1.5);
    const double radius_m = random.uniform(5.5, 9.0) * static_cast<double>(n) / kTwoPi;
    for (std::size_t k = 0; k < n; ++k) {
      const auto place = [&](double turn) {
        const Vec2 at =
            (radius_m + random.uniform(-0.2, 0.2)) *
            unit_vector(turn + kTwoPi * static_cast<double>(k) / static_cast<double>(n));
        return Vec3{at.x(), at.y(), random.uniform(20.0, 20.5)};
      };
      const Vec3 from = place(0.0);
      request.transfers.push_back({{static_cast<std::uint16_t>(k + 1)}, from, place(kPi)});
    }
    const auto planned = formation::plan_change(request);
    ASSERT_TRUE(planned.ok()) << planned.error().message;
    if (planned->way != formation::Way::roundabout) continue;
    for (const formation::Mover& mover : planned->change.movers) {
      if (mover.level < 2) continue;
      ++on_levels;
      break;
    }
    EXPECT_EQ(judge_change(request, *planned).violation, "") << n << " at " << radius_m << " m";
  }
  EXPECT_GT(on_levels, 4);
}

/// Minutes long: the test formation_changes, labelled slow.
TEST(ChangeTrials, DISABLED_TenThousandRandomChangesKeepTheirSeparation) {
  expect_separation(10'000, 2);
}

TEST(ChangeTrials, TheJudgeFindsWhatThePlannerWouldHaveToFind) {
  formation::ChangeRequest request;
  request.limits = {.speed_mps = 3.0};
  request.separation = {2.0, 2.0};
  request.reserve_m = 0.0;
  request.transfers = {{{1}, {0.0, 0.0, 20.0}, {20.0, 0.0, 20.0}},
                       {{2}, {20.0, 1.0, 20.0}, {0.0, 1.0, 20.0}}};
  formation::PlannedChange planned;
  planned.change.limits = request.limits;
  planned.change.separation = request.separation;
  for (const auto& transfer : request.transfers) {
    planned.change.movers.push_back({transfer.vehicle, {transfer.from, transfer.to}, 0});
  }
  planned.least_separation_m = 2.0;
  const auto judged = judge_change(request, planned);
  EXPECT_NEAR(judged.least_m, 1.0, 0.01);
  EXPECT_NE(judged.violation.find("come within"), std::string::npos) << judged.violation;

  planned.change.movers[1].points.back().y() = 5.0;
  EXPECT_EQ(judge_change(request, planned).violation, "it ends elsewhere");
  planned.change.movers[1].points.back().y() = 1.0;
  planned.change.limits.speed_mps = 4.0;
  EXPECT_NE(judge_change(request, planned).violation.find("faster"), std::string::npos);
}

}  // namespace
}  // namespace skein::change_trials
