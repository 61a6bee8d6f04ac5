// SPDX-License-Identifier: Apache-2.0
#include "curve_polish.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace skein::routes {
namespace {

CurveProblem past_one(double offset_m) {
  CurveProblem problem{.start = {0, 0}, .site = {1000, 0}};
  problem.hazards = {{.id = HazardId{1}, .centre = {500, offset_m}, .radius_m = 100}};
  return problem;
}

/// A straight line enters the keep-out by 60 m; the taut way round it costs 0.8 % of length.
TEST(CurvePolish, LeavesAKeepOutAndHugsIt) {
  const CurveProblem problem = past_one(-40);
  CurveEvaluator evaluator{problem, CurveForm::turns_and_legs};
  std::vector<double> straight(11, 1.0);
  std::fill_n(straight.begin(), 5, 0.0);
  EXPECT_GE(evaluator(straight), kBarredCost);
  EXPECT_LT(cost_with_slopes(problem.weights, evaluator.costs(straight)), kBarredCost);
  const auto polished = CurvePolish{problem, evaluator}.polish(straight, 600);
  EXPECT_LE(polished.evaluations, 600U);
  EXPECT_EQ(polished.value, evaluator(polished.point));
  EXPECT_LT(polished.value, 1.02);
  EXPECT_GT(polished.value, 1.008);
}

TEST(CurvePolish, SpendsNoMoreThanItMay) {
  const CurveProblem problem = past_one(20);
  CurveEvaluator evaluator{problem, CurveForm::turns_and_legs};
  std::vector<double> bent(11, 1.0);
  std::fill_n(bent.begin(), 5, 0.1);
  for (const std::uint64_t allowed : {0U, 1U, 11U, 12U, 13U, 50U}) {
    const auto polished = CurvePolish{problem, evaluator}.polish(bent, allowed);
    EXPECT_LE(polished.evaluations, allowed);
    EXPECT_EQ(polished.point.empty(), allowed == 0);
  }
}

TEST(CurvePolish, RoomIsTheDistanceToTheKeepOutsEdge) {
  CurveProblem problem = past_one(130);
  problem.hazards.push_back(
      {.kind = HazardKind::detection, .centre = {200, 0}, .radius_m = 50, .inner_radius_m = 1});
  problem.hazards.push_back({.id = HazardId{2}, .centre = {800, 20}, .radius_m = 50});
  CurveEvaluator evaluator{problem, CurveForm::turns_and_legs};
  std::vector<double> straight(11, 1.0);
  std::fill_n(straight.begin(), 5, 0.0);
  (void)evaluator.costs(straight);
  std::vector<double> room;
  evaluator.keep_out_room(24, 0.04, room);
  ASSERT_EQ(room.size(), 48U);  // of the two keep-outs
  EXPECT_NEAR(*std::min_element(room.begin(), room.begin() + 24), 0.03, 1e-9);
  EXPECT_NEAR(*std::min_element(room.begin() + 24, room.end()), -0.03, 1e-9);
  EXPECT_EQ(room.front(), 0.04);
}

}  // namespace
}  // namespace skein::routes
