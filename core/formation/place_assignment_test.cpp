// SPDX-License-Identifier: Apache-2.0
#include "skein/formation/place_assignment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "skein/planning/assignment.hpp"

namespace skein::formation {
namespace {

using Points = std::vector<Vec3>;

constexpr std::array<PlaceMethod, 3> kExact = {PlaceMethod::least_squares, PlaceMethod::least_sum,
                                               PlaceMethod::least_longest};

struct Problem {
  Points vehicles;
  Points places;
};

Points random_points(Random& random, std::size_t count, double height_m) {
  Points points;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = random.uniform(0.0, 100.0);
    const double y = random.uniform(0.0, 100.0);
    points.emplace_back(x, y, random.uniform(0.0, height_m));
  }
  return points;
}

Problem random_problem(Random& random, std::size_t count, double height_m = 30.0) {
  return {random_points(random, count, height_m), random_points(random, count, height_m)};
}

Points row_of_points(std::size_t count, const Vec3& from, const Vec3& step) {
  Points points;
  for (std::size_t i = 0; i < count; ++i) points.emplace_back(from + static_cast<double>(i) * step);
  return points;
}

Points circle(std::size_t count, double radius_m, double turn) {
  Points points;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle =
        turn + 6.283185307179586 * static_cast<double>(i) / static_cast<double>(count);
    points.emplace_back(radius_m * std::cos(angle), radius_m * std::sin(angle), -20.0);
  }
  return points;
}

/// Ties in every form that formations have them.
std::vector<Problem> degenerate_problems(std::size_t count) {
  std::vector<Problem> problems;
  const Points line = row_of_points(count, {0.0, 0.0, -10.0}, {0.0, 5.0, 0.0});
  problems.push_back({line, row_of_points(count, {40.0, 0.0, -10.0}, {5.0, 0.0, 0.0})});
  problems.push_back({line, line});
  problems.push_back({line, row_of_points(count, {0.0, 2.5, -10.0}, {0.0, 5.0, 0.0})});
  problems.push_back({line, row_of_points(count, {1000.0, -300.0, -10.0}, {0.0, -5.0, 0.0})});
  problems.push_back({line, Points(count, Vec3{3.0, 4.0, 0.0})});  // all places equal
  problems.push_back({Points(count, Vec3::Zero()), Points(count, Vec3::Zero())});
  problems.push_back({circle(count, 20.0, 0.0), circle(count, 20.0, 3.141592653589793)});
  problems.push_back({circle(count, 20.0, 0.0), circle(count, 30.0, 0.1)});
  Points grid;
  for (std::size_t i = 0; i < count; ++i) {
    grid.emplace_back(static_cast<double>(i % 7) * 4.0,
                      4.0 * std::floor(static_cast<double>(i) / 7.0), 0.0);
  }
  problems.push_back({grid, line});
  Points twice = grid;
  for (std::size_t i = 0; i + 1 < count; i += 2) twice[i + 1] = twice[i];
  problems.push_back({grid, twice});
  return problems;
}

PlaceAssignment solved(PlaceMethod method, const Problem& problem) {
  PlaceSolver solver;
  PlaceAssignment result;
  const auto done = solver.solve(method, problem.vehicles, problem.places, result);
  EXPECT_TRUE(done.ok());
  return result;
}

PlaceLengths lengths(const PlaceAssignment& assignment, const Problem& problem) {
  return lengths_of(assignment.place_of, problem.vehicles, problem.places);
}

testing::AssertionResult is_proven(const PlaceAssignment& assignment, const Problem& problem) {
  const auto verified = verify(assignment, problem.vehicles, problem.places);
  if (verified) return testing::AssertionSuccess();
  return testing::AssertionFailure()
         << to_string(assignment.method) << ": " << verified.error().message;
}

template <typename Visit>
void for_every_assignment(std::size_t count, const Visit& visit) {
  std::vector<int> place_of(count);
  std::iota(place_of.begin(), place_of.end(), 0);
  do {
    visit(place_of);
  } while (std::next_permutation(place_of.begin(), place_of.end()));
}

TEST(PlaceMethods, HaveNames) {
  for (int i = 0; i < static_cast<int>(PlaceMethod::count); ++i) {
    const auto method = static_cast<PlaceMethod>(i);
    EXPECT_EQ(place_method(to_string(method)), method);
  }
  EXPECT_EQ(to_string(PlaceMethod::least_squares), "least_squares");
  EXPECT_FALSE(place_method("hungarian"));
  EXPECT_EQ(to_string(PlaceMethod::count), "unknown");
}

TEST(PlaceAssignment, ExactMethodsAgreeWithEveryAssignment) {
  Random random{51};
  for (std::size_t count = 1; count <= 7; ++count) {
    std::vector<Problem> problems = degenerate_problems(count);
    for (int i = 0; i < (count < 7 ? 60 : 15); ++i) {
      problems.push_back(random_problem(random, count));
      if (i % 3 != 0) continue;
      for (Points* points : {&problems.back().vehicles, &problems.back().places}) {
        for (Vec3& point : *points) point = (point / 25.0).array().round();  // ties
      }
    }
    for (const Problem& problem : problems) {
      double sum = std::numeric_limits<double>::infinity();
      double squares = sum;
      double longest = sum;
      for_every_assignment(count, [&](const std::vector<int>& place_of) {
        const auto found = lengths_of(place_of, problem.vehicles, problem.places);
        sum = std::min(sum, found.sum_m);
        squares = std::min(squares, found.sum_of_squares_m2);
        longest = std::min(longest, found.longest_m);
      });
      double squares_of_longest = std::numeric_limits<double>::infinity();
      for_every_assignment(count, [&](const std::vector<int>& place_of) {
        const auto found = lengths_of(place_of, problem.vehicles, problem.places);
        if (found.longest_m > longest * (1.0 + 1e-13)) return;
        squares_of_longest = std::min(squares_of_longest, found.sum_of_squares_m2);
      });
      const auto by = [&](PlaceMethod method) { return lengths(solved(method, problem), problem); };
      EXPECT_NEAR(by(PlaceMethod::least_sum).sum_m, sum, 1e-10 * (1.0 + sum));
      EXPECT_NEAR(by(PlaceMethod::least_squares).sum_of_squares_m2, squares,
                  1e-10 * (1.0 + squares));
      const auto least_longest = by(PlaceMethod::least_longest);
      EXPECT_NEAR(least_longest.longest_m, longest, 1e-11 * (1.0 + longest));
      EXPECT_NEAR(least_longest.sum_of_squares_m2, squares_of_longest,
                  1e-10 * (1.0 + squares_of_longest));
    }
  }
}

TEST(PlaceAssignment, CertificatesProveRandomAndDegenerateProblems) {
  Random random{53};
  for (const std::size_t count : {1U, 2U, 5U, 8U, 9U, 16U, 31U, 64U, 100U, 200U}) {
    std::vector<Problem> problems = degenerate_problems(count);
    for (int i = 0; i < 5; ++i) problems.push_back(random_problem(random, count));
    problems.push_back(random_problem(random, count, 0.0));
    problems.push_back(random_problem(random, count));
    for (Vec3& place : problems.back().places) place += Vec3{2e4, -5e4, 100.0};
    problems.push_back(random_problem(random, count));  // a formation that moves on, and grows
    for (Vec3& place : problems.back().places) place = 3.0 * place + Vec3{400.0, 100.0, 0.0};
    for (const Problem& problem : problems) {
      for (const PlaceMethod method : kExact) {
        EXPECT_TRUE(is_proven(solved(method, problem), problem)) << count;
      }
    }
  }
}

TEST(PlaceAssignment, WrongCertificatesAreRejected) {
  Random random{54};
  int assignments = 0;
  for (int i = 0; i < 40; ++i) {
    const Problem problem = random_problem(random, 12);
    for (const PlaceMethod method : kExact) {
      const PlaceAssignment good = solved(method, problem);
      ASSERT_TRUE(is_proven(good, problem));

      PlaceAssignment other = good;  // not the best one
      std::swap(other.place_of[random.index(6)], other.place_of[6 + random.index(6)]);
      EXPECT_FALSE(is_proven(other, problem));
      ++assignments;

      if (method != PlaceMethod::least_longest) {  // whose place may be open to one vehicle alone
        other = good;
        other.certificate.place_price[random.index(12)] += 200.0 + 1e5 * random.uniform();
        EXPECT_FALSE(is_proven(other, problem));
      }
      other = good;
      other.certificate.place_price[3] = std::numeric_limits<double>::quiet_NaN();
      EXPECT_FALSE(is_proven(other, problem));
      other = good;
      other.certificate.place_price.pop_back();
      EXPECT_FALSE(is_proven(other, problem));
      other = good;
      other.place_of[0] = other.place_of[1];
      EXPECT_FALSE(is_proven(other, problem));
      other = good;
      other.place_of[0] = 12;
      EXPECT_FALSE(is_proven(other, problem));
      EXPECT_FALSE(is_proven(good, {problem.vehicles, Points(11, Vec3::Zero())}));
    }
  }
  EXPECT_EQ(assignments, 120);
}

TEST(PlaceAssignment, WrongThresholdsAreRejected) {
  Random random{55};
  for (int i = 0; i < 40; ++i) {
    const Problem problem = random_problem(random, 12);
    const PlaceAssignment good = solved(PlaceMethod::least_longest, problem);

    PlaceAssignment other = good;  // one vehicle less: no more crowded
    other.certificate.crowded_vehicles.pop_back();
    EXPECT_FALSE(is_proven(other, problem));
    other = good;
    other.certificate.crowded_vehicles.back() = -1;
    EXPECT_FALSE(is_proven(other, problem));
    if (good.certificate.crowded_vehicles.size() > 1) {
      other = good;
      other.certificate.crowded_vehicles[0] = other.certificate.crowded_vehicles[1];
      EXPECT_FALSE(is_proven(other, problem));
      other = good;  // one of the places that are near is not named
      other.certificate.near_places.pop_back();
      EXPECT_FALSE(is_proven(other, problem));
    }
    // Least squares has a longer leg, mostly, which its prices cannot excuse.
    other = solved(PlaceMethod::least_squares, problem);
    if (lengths(other, problem).longest_m > lengths(good, problem).longest_m) {
      other.method = PlaceMethod::least_longest;
      other.certificate.crowded_vehicles = good.certificate.crowded_vehicles;
      other.certificate.near_places = good.certificate.near_places;
      EXPECT_FALSE(is_proven(other, problem));
    }
  }
}

TEST(PlaceAssignment, EveryWidthGivesTheSameBits) {
  Random random{56};
  for (const std::size_t count : {1U, 5U, 8U, 13U, 64U, 150U}) {
    std::vector<Problem> problems = degenerate_problems(count);
    for (int i = 0; i < 4; ++i) problems.push_back(random_problem(random, count));
    for (const Problem& problem : problems) {
      for (const PlaceMethod method : kExact) {
        PlaceAssignment first;
        for (const auto width : planning::AssignmentSolver::widths()) {
          PlaceSolver solver{width};
          PlaceAssignment result;
          ASSERT_TRUE(solver.solve(method, problem.vehicles, problem.places, result).ok());
          if (width == planning::AssignmentSolver::widths().front()) first = result;
          EXPECT_EQ(result.place_of, first.place_of);
          EXPECT_EQ(result.certificate.place_price, first.certificate.place_price);
          EXPECT_EQ(result.certificate.crowded_vehicles, first.certificate.crowded_vehicles);
          EXPECT_EQ(result.certificate.near_places, first.certificate.near_places);
        }
      }
    }
  }
}

TEST(PlaceAssignment, OneSolverForSizesUpAndDown) {
  Random random{57};
  PlaceSolver solver;
  PlaceAssignment result;
  for (const std::size_t count : {40U, 3U, 0U, 17U, 70U, 8U}) {
    const Problem problem = random_problem(random, count);
    for (const PlaceMethod method : kExact) {
      ASSERT_TRUE(solver.solve(method, problem.vehicles, problem.places, result).ok());
      EXPECT_TRUE(is_proven(result, problem));
      EXPECT_EQ(result.place_of, solved(method, problem).place_of);
    }
  }
}

/// Starts and places 2 sqrt(2) R apart: straight flight under common timing keeps 2 R.
TEST(PlaceAssignment, LeastSquaresKeepsApart) {
  constexpr double kRadius_m = 1.0;
  Random random{58};
  const auto spaced = [&](std::size_t count) {
    Points points;
    while (points.size() < count) {
      const Vec3 point = 0.25 * random_points(random, 1, 0.0)[0];
      const bool clear = std::all_of(points.begin(), points.end(), [&](const Vec3& other) {
        return (other - point).norm() >= 2.0 * std::sqrt(2.0) * kRadius_m;
      });
      if (clear) points.push_back(point);
    }
    return points;
  };
  double least_m = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 200; ++round) {
    const Problem problem{spaced(20), spaced(20)};
    const auto place_of = solved(PlaceMethod::least_squares, problem).place_of;
    for (std::size_t i = 0; i < 20; ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        const Vec3 start = problem.vehicles[i] - problem.vehicles[k];
        const Vec3 end = problem.places[static_cast<std::size_t>(place_of[i])] -
                         problem.places[static_cast<std::size_t>(place_of[k])];
        const Vec3 change = end - start;
        const double at = change.squaredNorm() > 0.0
                              ? std::clamp(-start.dot(change) / change.squaredNorm(), 0.0, 1.0)
                              : 0.0;
        least_m = std::min(least_m, (start + at * change).norm());
      }
    }
  }
  EXPECT_GE(least_m, 2.0 * kRadius_m);
}

TEST(PlaceAssignment, RefusesWhatIsNotAProblem) {
  PlaceSolver solver;
  PlaceAssignment result;
  const Points two(2, Vec3::Zero());
  const auto refused = [&](PlaceMethod method, const Points& vehicles, const Points& places) {
    const auto done = solver.solve(method, vehicles, places, result);
    return done.ok() ? std::string{} : done.error().message;
  };
  EXPECT_EQ(refused(PlaceMethod::least_sum, two, Points(3, Vec3::Zero())),
            "2 vehicles cannot take 3 places one each: give equally many");
  EXPECT_EQ(refused(PlaceMethod::colony, two, two), "the method colony is not an exact one");
  Points bad = two;
  bad[1].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refused(PlaceMethod::least_squares, two, bad),
            "place 1 has a coordinate that is not a number or beyond 1e8 m");
  bad[1].y() = -2e8;
  EXPECT_EQ(refused(PlaceMethod::least_squares, bad, two),
            "vehicle 1 has a coordinate that is not a number or beyond 1e8 m");
  EXPECT_FALSE(verify({PlaceMethod::colony, {0, 1}, {}}, two, two).ok());

  PlaceParams params;
  params.method = PlaceMethod::colony;
  params.colony.threat_weight = 1.5;
  EXPECT_FALSE(assign_places(params, two, two, Random{1}).ok());
  params.colony.threat_weight = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(assign_places(params, two, two, Random{1}).ok());
  params.colony = {};
  params.colony.ants = 0;
  EXPECT_FALSE(assign_places(params, two, two, Random{1}).ok());
  params.colony = {};
  EXPECT_TRUE(assign_places(params, two, two, Random{1}).ok());
  EXPECT_FALSE(assign_places(params, two, Points(1, Vec3::Zero()), Random{1}).ok());
  EXPECT_TRUE(assign_places(params, {}, {}, Random{1})->place_of.empty());
  params.method = PlaceMethod::least_longest;
  EXPECT_TRUE(assign_places(params, two, two, Random{1}).ok());
}

// --- the colony -----------------------------------------------------------------------------

PlaceColonyParams with_threat(double weight) {
  PlaceColonyParams params;
  params.threat_weight = weight;
  return params;
}

std::vector<int> by_colony(const PlaceColonyParams& params, const Problem& problem,
                           std::uint64_t seed, std::uint64_t ants_max = 1'000'000'000) {
  const auto result = assign_places({PlaceMethod::colony, params}, problem.vehicles, problem.places,
                                    Random{seed}, {ants_max, {}});
  EXPECT_TRUE(result.ok());
  EXPECT_EQ(result->method, PlaceMethod::colony);
  return result->place_of;
}

TEST(PlaceColony, CostIsThatOfThePaper) {
  // Two parallel legs of 30 m and 10 m, side by side at 4 m in the beginning.
  const Problem apart{{{0.0, 0.0, 0.0}, {0.0, 4.0, 0.0}}, {{30.0, 0.0, 0.0}, {10.0, 4.0, 0.0}}};
  const std::vector<int> straight = {0, 1};
  const std::vector<int> swapped = {1, 0};
  const auto cost = [](double weight, const std::vector<int>& place_of, const Problem& problem) {
    return colony_cost(with_threat(weight), place_of, problem.vehicles, problem.places);
  };
  EXPECT_EQ(cost(0.0, straight, apart).crossings, 0);
  EXPECT_DOUBLE_EQ(cost(0.0, straight, apart).total, 40.0);
  EXPECT_DOUBLE_EQ(cost(1.0, straight, apart).total, 10.0 / 16.0);  // the second vehicle's alone
  EXPECT_DOUBLE_EQ(cost(0.25, straight, apart).total, 30.0 + 2.5 / 16.0);
  EXPECT_EQ(cost(0.0, swapped, apart).crossings, 1);

  // Paths that meet in the middle, at half way: 4 m of height apart.
  const Problem stacked{{{0.0, 0.0, 0.0}, {6.0, -6.0, 4.0}}, {{12.0, 0.0, 0.0}, {6.0, 6.0, 4.0}}};
  EXPECT_EQ(cost(1.0, straight, stacked).crossings, 0);
  EXPECT_DOUBLE_EQ(cost(1.0, straight, stacked).total, 12.0 / 16.0);
  PlaceColonyParams params;
  params.crossing_height_m = 4.5;
  EXPECT_EQ(colony_cost(params, straight, stacked.vehicles, stacked.places).crossings, 1);
}

TEST(PlaceColony, FindsTheOptimumOfFive) {
  Random random{61};
  int found = 0;
  int crossing = 0;
  constexpr int kProblems = 120;
  for (int i = 0; i < kProblems; ++i) {
    const Problem problem = random_problem(random, 5, i % 2 == 0 ? 0.0 : 30.0);
    const PlaceColonyParams params = with_threat(i % 3 == 0 ? 0.0 : i % 3 == 1 ? 0.5 : 0.98);
    PlaceColonyCost best{100, 0.0};
    for_every_assignment(5, [&](const std::vector<int>& place_of) {
      best = std::min(best, colony_cost(params, place_of, problem.vehicles, problem.places));
    });
    const auto place_of = by_colony(params, problem, static_cast<std::uint64_t>(i));
    const auto cost = colony_cost(params, place_of, problem.vehicles, problem.places);
    if (cost.crossings == best.crossings && cost.total <= best.total * (1.0 + 1e-12)) ++found;
    crossing += best.crossings;
  }
  EXPECT_EQ(found, kProblems);
  EXPECT_EQ(crossing, 0);
}

TEST(PlaceColony, IsWithinOnePercentAtThirtyTwo) {
  Random random{62};
  for (int i = 0; i < 4; ++i) {
    const Problem problem = random_problem(random, 32, 0.0);
    const auto least = lengths(solved(PlaceMethod::least_sum, problem), problem).sum_m;
    const auto place_of = by_colony({}, problem, static_cast<std::uint64_t>(i));
    const auto cost = colony_cost({}, place_of, problem.vehicles, problem.places);
    EXPECT_EQ(cost.crossings, 0);
    EXPECT_GE(cost.total, least * (1.0 - 1e-12));
    EXPECT_LE(cost.total, least * 1.01);
  }
}

TEST(PlaceColony, IsReproducibleAndAnytime) {
  Random random{63};
  const Problem problem = random_problem(random, 14);
  const PlaceColonyParams params = with_threat(0.5);
  EXPECT_EQ(by_colony(params, problem, 7), by_colony(params, problem, 7));
  PlaceColonyCost before{1000, 0.0};
  for (const std::uint64_t ants : {0U, 1U, 2U, 5U, 16U, 40U, 200U}) {
    const auto place_of = by_colony(params, problem, 7, ants);
    const auto cost = colony_cost(params, place_of, problem.vehicles, problem.places);
    EXPECT_LE(cost, before);
    before = cost;
  }
  bool asked = false;
  const auto expired = [&asked] { return asked = true; };
  const auto result = assign_places({PlaceMethod::colony, params}, problem.vehicles, problem.places,
                                    Random{7}, {1'000'000, expired});
  ASSERT_TRUE(result.ok());
  EXPECT_TRUE(asked);
  EXPECT_EQ(result->place_of, by_colony(params, problem, 7, 1));
}

}  // namespace
}  // namespace skein::formation
