// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "skein/base/attitude.hpp"
#include "skein/base/random.hpp"
#include "skein/base/result.hpp"
#include "skein/planning/assignment.hpp"
#include "skein/planning/budget.hpp"

namespace skein::formation {

/// How n vehicles are given n places. Of all assignments:
enum class PlaceMethod : std::uint8_t {
  /// the least sum of squared straight lengths. Where the vehicles fly straight and under common
  /// timing (each the same fraction of its leg at the same moment), no two of them come nearer than
  /// 2 R if all starts and all places are at least 2 sqrt(2) R apart (Turpin, Michael, Kumar 2014,
  /// CAPT). It shares this with no other method here.
  least_squares,
  least_sum,      ///< the least sum of straight lengths; legs do not cross, but may come close
  least_longest,  ///< the least longest leg, and the least sum of squares among those
  /// Ant colony with a term for nearness (Zheng 2020, eq. 1-5). It can weigh how near pairs of
  /// paths
  /// come, which the exact ones cannot; but no gain was measured: with 5 vehicles and all points 3
  /// m
  /// apart in a square of 15 m, straight flight under common timing came nearer than 3 m in 20 to
  /// 24
  /// of 150 problems with k1 = 0.5 to 0.999, and in 13 with least_squares. Kept as the paper's.
  colony,
  count
};
[[nodiscard]] std::string_view to_string(PlaceMethod method);
[[nodiscard]] std::optional<PlaceMethod> place_method(std::string_view name);

/// What proves an exact answer to somebody who trusts nothing but the positions.
struct PlaceCertificate {
  /// Dual prices v_j, by place. For any prices, sum_j v_j + sum_i min_j (c_ij - v_j) is a lower
  /// bound of the sum (weak duality of linear programs); these reach it. c is the leg's length in m
  /// (least_sum) or its square in m^2 (the others). Prices are defined up to one constant.
  std::vector<double> place_price;
  /// Of least_longest, else empty (Hall 1935, Koenig 1931): these vehicles are nearer than the
  /// longest leg only to those places, which are fewer. Hence one of them flies at least that far.
  std::vector<int> crowded_vehicles;
  std::vector<int> near_places;
};

struct PlaceAssignment {
  PlaceMethod method = PlaceMethod::least_squares;
  std::vector<int> place_of;     ///< by vehicle; each place once
  PlaceCertificate certificate;  ///< empty for colony
};

struct PlaceLengths {
  double sum_m = 0.0;
  double sum_of_squares_m2 = 0.0;
  double longest_m = 0.0;
};
/// Of the straight legs. Precondition: place_of is an assignment of those vehicles and places.
[[nodiscard]] PlaceLengths lengths_of(std::span<const int> place_of, std::span<const Vec3> vehicles,
                                      std::span<const Vec3> places);

/// Coordinates must be finite and within this, any frame.
inline constexpr double kPlaceCoordinateMax_m = 1e8;
/// Squared legs longer than the longest by no more than this share count as equally long.
inline constexpr double kEqualLegs = 1e-12;

/// The exact methods, by planning's solver. It keeps its buffers, and those of the result: repeated
/// calls of one size do not allocate. O(n^3); deterministic, the same bits on every processor.
class PlaceSolver {
 public:
  using Width = planning::AssignmentSolver::Width;

  PlaceSolver() : PlaceSolver{planning::AssignmentSolver::widths().back()} {}
  /// Precondition: one of AssignmentSolver::widths().
  explicit PlaceSolver(Width width) : width_{width}, solver_{width} {}

  /// Errors: method is colony; counts differ; a coordinate that is not finite or too great.
  /// The result is untouched then.
  [[nodiscard]] Result<void> solve(PlaceMethod method, std::span<const Vec3> vehicles,
                                   std::span<const Vec3> places, PlaceAssignment& result);

 private:
  struct Columns {
    std::vector<double> x;
    std::vector<double> y;
    std::vector<double> z;
  };
  static void spread(std::span<const Vec3> points, const Vec3& origin, std::size_t stride,
                     Columns& to);
  [[nodiscard]] std::span<const double> guess(PlaceMethod method, std::span<const Vec3> vehicles,
                                              std::span<const Vec3> places);

  Width width_;
  planning::AssignmentSolver solver_;
  Columns vehicles_;
  Columns places_;
  std::vector<double> guess_;
};

/// The paper gives none of these; they are tuned on random instances of 5 and 32 vehicles.
struct PlaceColonyParams {
  double threat_weight = 0.0;  ///< k1, in [0, 1]
  /// Paths that cross seen from above cross if their heights there differ by less, m.
  double crossing_height_m = 3.0;
  int iterations = 150;            ///< at most
  int ants = 16;                   ///< of an iteration
  double alpha = 0.5;              ///< weight of the pheromone
  double beta = 3.0;               ///< weight of 1 / J of a node
  double q0 = 0.2;                 ///< how often the best node is taken without drawing
  double local_evaporation = 0.1;  ///< zeta
  double evaporation = 0.02;       ///< rho
  /// Improve the best ant of an iteration by exchanges of places between two vehicles, and then
  /// among three, until none helps. Not in the paper, whose ants alone do not reach 1 % at 32.
  bool exchanges = true;
};

/// What colony makes least: crossings first, then J.
struct PlaceColonyCost {
  int crossings = 0;  ///< pairs of legs that cross
  double total = 0.0;
  friend auto operator<=>(const PlaceColonyCost&, const PlaceColonyCost&) = default;
};
/// Zheng 2020, eq. 1-2: J = sum over vehicles i of L_i ((1 - k1) + k1 max_k 1 / d_ik^2), lengths in
/// m, where k goes over the vehicles before i and d_ik is the least distance of both at the
/// fractions 0, 1/6 ... 1 of their legs (at least 1 mm). The paper takes the largest of these,
/// which is the safest moment. Vehicles choose in their order, so that each assignment has one J.
[[nodiscard]] PlaceColonyCost colony_cost(const PlaceColonyParams& params,
                                          std::span<const int> place_of,
                                          std::span<const Vec3> vehicles,
                                          std::span<const Vec3> places);

struct PlaceParams {
  PlaceMethod method = PlaceMethod::least_squares;
  PlaceColonyParams colony;
};

/// Any method. Random and budget are of the colony only, whose step is an ant; at least one is
/// always sent out, and what is best so far is the answer. More budget never gives a greater cost.
/// Errors: as PlaceSolver; k1 outside [0, 1]; no ants, or iterations.
[[nodiscard]] Result<PlaceAssignment> assign_places(const PlaceParams& params,
                                                    std::span<const Vec3> vehicles,
                                                    std::span<const Vec3> places, Random random,
                                                    const planning::PlanningBudget& budget = {});

/// Success if the certificate proves that no assignment is better than this one, but for rounding
/// (1e-12 of the largest cost per vehicle; legs equal within kEqualLegs); else what is wrong.
/// O(n^2).
[[nodiscard]] Result<void> verify(const PlaceAssignment& assignment, std::span<const Vec3> vehicles,
                                  std::span<const Vec3> places);

}  // namespace skein::formation
