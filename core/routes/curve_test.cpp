// SPDX-License-Identifier: Apache-2.0
#include "skein/routes/curve.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "skein/base/random.hpp"
#include "skein/routes/fly_by.hpp"

namespace skein::routes {
namespace {

constexpr std::array kForms = {CurveForm::free_points, CurveForm::lateral_offsets,
                               CurveForm::turns_and_legs};

CurveProblem random_problem(Random& random) {
  CurveProblem problem{.start = {random.uniform(0, 200), random.uniform(0, 200)},
                       .site = {random.uniform(800, 1000), random.uniform(800, 1000)},
                       .hazards = {},
                       .waypoints = 1 + random.index(11),
                       .samples = 20 + random.index(300),
                       .weights = {random.uniform(), random.uniform(), random.uniform()}};
  for (int i = 0; i < 10; ++i) {
    RouteHazard hazard{.kind = static_cast<HazardKind>(random.index(3)),
                       .centre = {random.uniform(0, 1000), random.uniform(0, 1000)},
                       .radius_m = random.uniform(50, 250),
                       .peak = random.uniform(0.5, 1.0)};
    hazard.inner_radius_m = hazard.radius_m * random.uniform(0.01, 0.9);
    problem.hazards.push_back(hazard);
  }
  return problem;
}

std::vector<double> random_point(const Box& box, Random& random) {
  std::vector<double> point(box.dimension());
  for (std::size_t j = 0; j < point.size(); ++j) {
    point[j] = random.uniform(box.low[j], box.high[j]);
  }
  return point;
}

double exposure_at(const CurveProblem& problem, const Vec2& point) {
  double sum = 0.0;
  for (const RouteHazard& hazard : problem.hazards) {
    const bool bars =
        hazard.kind == HazardKind::keep_out && problem.reading == CostReading::of_flights;
    if (!bars) sum += hazard.value_at(point);
  }
  return sum;
}

/// By the definitions, from the samples and the waypoints; keep-outs that bar left out.
RouteCosts plain_costs(const CurveProblem& problem, const std::vector<Vec2>& curve,
                       const std::vector<Vec2>& waypoints) {
  RouteCosts costs;
  if (problem.reading == CostReading::as_printed) {
    for (const Vec2& point : curve) costs.exposure += exposure_at(problem, point);
    costs.exposure /= static_cast<double>(curve.size());
  } else {
    double length = 0.0;
    for (std::size_t k = 1; k < curve.size(); ++k) {
      const double leg = (curve[k] - curve[k - 1]).norm();
      costs.exposure +=
          leg * 0.5 * (exposure_at(problem, curve[k - 1]) + exposure_at(problem, curve[k]));
      length += leg;
    }
    costs.exposure /= length;
  }
  for (std::size_t k = 1; k < curve.size(); ++k) {
    costs.length_ratio += (curve[k] - curve[k - 1]).norm();
  }
  costs.length_ratio /= (problem.site - problem.start).norm();
  std::vector<Vec2> polygon = {problem.start};
  polygon.insert(polygon.end(), waypoints.begin(), waypoints.end());
  polygon.push_back(problem.site);
  for (std::size_t j = 2; j + 1 < polygon.size(); ++j) {
    costs.turning += std::abs(turn_at(polygon[j - 1], polygon[j], polygon[j + 1]) -
                              turn_at(polygon[j - 2], polygon[j - 1], polygon[j]));
  }
  if (waypoints.size() > 1) costs.turning /= static_cast<double>(waypoints.size() - 1);
  costs.total = problem.weights.exposure * costs.exposure +
                problem.weights.length * costs.length_ratio +
                problem.weights.turning * costs.turning;
  return costs;
}

/// By far more points than the costs look at.
bool enters_a_keep_out(const CurveProblem& problem, const std::vector<Vec2>& curve) {
  if (problem.reading == CostReading::as_printed) return false;
  for (std::size_t k = 1; k < curve.size(); ++k) {
    for (int i = 0; i <= 50; ++i) {
      const Vec2 point = curve[k - 1] + i / 50.0 * (curve[k] - curve[k - 1]);
      for (const RouteHazard& hazard : problem.hazards) {
        if (hazard.kind == HazardKind::keep_out && hazard.value_at(point) > 0.0) return true;
      }
    }
  }
  return false;
}

TEST(Curve, CostsAreTheirDefinitionsWithEveryWidth) {
  Random random{2};
  int barred_for_nothing = 0;
  for (int k = 0; k < 120; ++k) {
    CurveProblem problem = random_problem(random);
    problem.reading = k % 2 == 0 ? CostReading::of_flights : CostReading::as_printed;
    for (const CurveForm form : kForms) {
      CurveEvaluator evaluator{problem, form, CurveEvaluator::Width::baseline};
      const std::vector<double> point = random_point(evaluator.box(), random);
      const RouteCosts costs = evaluator.costs(point);
      const std::vector<Vec2> curve = evaluator.curve(point);
      ASSERT_EQ(curve.size(), problem.samples);
      EXPECT_NEAR((curve.front() - problem.start).norm(), 0.0, 1e-9);
      EXPECT_NEAR((curve.back() - problem.site).norm(), 0.0, 1e-9);
      const RouteCosts plain = plain_costs(problem, curve, evaluator.waypoints(point));
      EXPECT_NEAR(costs.exposure, plain.exposure, 1e-9);
      EXPECT_NEAR(costs.length_ratio, plain.length_ratio, 1e-9);
      EXPECT_NEAR(costs.turning, plain.turning, 1e-9);
      const bool barred = costs.total > kBarredCost;
      EXPECT_TRUE(barred || std::abs(costs.total - plain.total) < 1e-9);
      // What the curve may bulge between samples counts, too.
      const bool enters = enters_a_keep_out(problem, curve);
      EXPECT_TRUE(barred || !enters);
      barred_for_nothing += barred && !enters ? 1 : 0;
      for (const CurveEvaluator::Width width : CurveEvaluator::widths()) {
        CurveEvaluator wide{problem, form, width};
        const RouteCosts same = wide.costs(point);
        EXPECT_EQ(costs.exposure, same.exposure);
        EXPECT_EQ(costs.length_ratio, same.length_ratio);
        EXPECT_EQ(costs.turning, same.turning);
        EXPECT_EQ(costs.total, same.total);
      }
    }
  }
  EXPECT_LE(barred_for_nothing, 12);
}

TEST(Curve, GoesThroughItsWaypoints) {
  Random random{3};
  CurveProblem problem = random_problem(random);
  problem.waypoints = 4;
  problem.samples = 1 + 5 * 40;
  for (const CurveForm form : kForms) {
    CurveEvaluator evaluator{problem, form};
    const std::vector<double> point = random_point(evaluator.box(), random);
    const std::vector<Vec2> curve = evaluator.curve(point);
    const std::vector<Vec2> waypoints = evaluator.waypoints(point);
    for (std::size_t j = 0; j < 4; ++j) {
      EXPECT_NEAR((curve[40 * (j + 1)] - waypoints[j]).norm(), 0.0, 1e-9);
    }
    const std::vector<double> back = evaluator.point_of(waypoints);
    const std::vector<Vec2> again = evaluator.waypoints(back);
    for (std::size_t j = 0; j < again.size(); ++j) {
      EXPECT_NEAR((again[j] - waypoints[j]).norm(), 0.0, 1e-6);
    }
  }
}

TEST(Curve, AStraightLineCostsItsLengthAndWhatItCrosses) {
  CurveProblem problem{.start = {0, 0},
                       .site = {900, 0},
                       .hazards = {},
                       .samples = 10,
                       .reading = CostReading::as_printed};
  problem.hazards = {
      {.kind = HazardKind::keep_out, .centre = {500, 0}, .radius_m = 150},
      {.kind = HazardKind::detection, .centre = {0, 100}, .radius_m = 120, .inner_radius_m = 50},
      {.kind = HazardKind::ramp,
       .centre = {900, 0},
       .radius_m = 150,
       .inner_radius_m = 50,
       .peak = 0.8}};
  CurveEvaluator evaluator{problem, CurveForm::lateral_offsets};
  const std::vector<double> straight(5, 0.0);
  const RouteCosts costs = evaluator.costs(straight);
  // Samples every 100 m: 400, 500, 600 are kept out; 0 lies at 100 m of 50; 800 and 900 on the
  // ramp.
  EXPECT_NEAR(costs.exposure, (3.0 + 0.5 + 0.4 + 0.8) / 10.0, 1e-12);
  EXPECT_NEAR(costs.length_ratio, 1.0, 1e-12);
  EXPECT_NEAR(costs.turning, 0.0, 1e-12);
  CurveProblem flown = problem;
  flown.reading = CostReading::of_flights;
  // Each over the 100 m around it, and the ends over 50; the keep-out is no matter of degree.
  const RouteCosts barred = CurveEvaluator{flown, CurveForm::lateral_offsets}.costs(straight);
  EXPECT_NEAR(barred.exposure, (0.5 * 0.5 + 0.4 + 0.5 * 0.8) / 9.0, 1e-12);
  EXPECT_GT(barred.total, kBarredCost);
  problem.exposure_per_hazard = true;
  EXPECT_NEAR((CurveEvaluator{problem, CurveForm::lateral_offsets}.costs(straight).exposure),
              costs.exposure / 3.0, 1e-12);
}

}  // namespace
}  // namespace skein::routes
