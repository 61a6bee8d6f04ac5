// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "skein/base/geometry.hpp"
#include "skein/base/vector_width.hpp"
#include "skein/routes/hazards.hpp"
#include "skein/routes/optimiser.hpp"

namespace skein::routes {

/// w1, w2, w3 of f = w1 f_t + w2 f_line + w3 f_s (Wu 2022, eq. 26). The paper has them sum to 1;
/// the values that it prints are those of the plain sum.
struct CostWeights {
  double exposure = 1.0;
  double length = 1.0;
  double turning = 1.0;
};

/// What a curve costs by its samples.
enum class CostReading : std::uint8_t {
  /// Exposure is averaged over the curve's length, so that nothing is gained by where its samples
  /// are dense. Keep-outs are not entered, between samples neither: whatever enters one costs
  /// kBarredCost and more, by how far it does.
  of_flights,
  /// As Wu 2022 has it: exposure is averaged over samples at equal steps of the parameter (eq. 23),
  /// and a keep-out costs its `peak` (eq. 4).
  as_printed,
};
inline constexpr double kBarredCost = 1e3;

/// Costs of one route (eq. 23-26), without units.
struct RouteCosts {
  double exposure = 0.0;      ///< f_t: hazard values, averaged
  double length_ratio = 0.0;  ///< f_line: length over the straight distance, >= 1
  double turning = 0.0;       ///< f_s: mean absolute difference of successive waypoints' turns, rad
  double total = 0.0;         ///< weighted; from kBarredCost up where it enters a keep-out
};

/// One vehicle's route as a smooth curve: a natural cubic spline through the start, some free
/// waypoints and the site, uniform in its parameter, and sampled.
struct CurveProblem {
  Vec2 start{0.0, 0.0};
  Vec2 site{0.0, 0.0};
  std::vector<RouteHazard> hazards{};
  std::size_t waypoints = 5;  ///< D free ones, >= 1
  std::size_t samples = 200;  ///< n, ends included, >= 4
  CostWeights weights{};
  CostReading reading = CostReading::of_flights;
  /// Divide f_t by the number of hazards too, as eq. 23 is printed. Then every hazard weighs less
  /// the more there are far away.
  bool exposure_per_hazard = false;
  /// The world; free waypoints lie within it. Lateral offsets reach half the straight distance to
  /// either side, whatever the world.
  Vec2 world_low{0.0, 0.0};
  Vec2 world_high{1000.0, 1000.0};
};

inline constexpr double kTurnStep_rad = 0.02;
/// What a number of turns_and_legs is beyond the step that counts as none, and back.
[[nodiscard]] double beyond_turn_step(double number);
[[nodiscard]] double with_turn_step(double rad);

/// What the optimiser's numbers are.
enum class CurveForm : std::uint8_t {
  free_points,      ///< x of all waypoints, then y of all, mission frame (the paper's)
  lateral_offsets,  ///< metres to the left of the straight line, at equal distances along it
  /// The polygon of start, waypoints and site by its shape, which is then turned and scaled to fit:
  /// the first turn and the D - 1 differences of successive turns, rad; D + 1 relative
  /// legs, 1 on average. Differences below kTurnStep_rad are none. What f_s adds up are these
  /// numbers, so that its kinks lie along the axes, and routes of even turning are not a needle in
  /// a haystack.
  turns_and_legs,
  count
};

/// Costs of curves, fast: length and exposure are linear algebra over all samples at once.
/// Keeps buffers, so one thread uses one. The same bits on every processor.
class CurveEvaluator {
 public:
  using Width = VectorWidth;
  /// Of this processor, narrowest first.
  [[nodiscard]] static std::span<const Width> widths() { return vector_widths(); }

  /// Preconditions: start and site apart; waypoints, samples and hazards as above.
  CurveEvaluator(const CurveProblem& problem, CurveForm form, Width width = widths().back());
  ~CurveEvaluator();
  CurveEvaluator(CurveEvaluator&&) noexcept;
  CurveEvaluator& operator=(CurveEvaluator&&) noexcept;
  CurveEvaluator(const CurveEvaluator&) = delete;
  CurveEvaluator& operator=(const CurveEvaluator&) = delete;

  [[nodiscard]] const Box& box() const;
  /// The weighted sum. Precondition: point.size() == box().dimension().
  [[nodiscard]] double operator()(std::span<const double> point) { return costs(point).total; }
  [[nodiscard]] RouteCosts costs(std::span<const double> point);
  /// Of the curve that was asked about last: how far it passes outside of each keep-out (of
  /// flights), with what it may bulge between samples, over the straight distance. By keep-out, and
  /// by equal parts of its samples; `far` where it is that or more. Negative: inside.
  void keep_out_room(std::size_t parts, double far, std::vector<double>& room) const;
  /// The sampled curve, mission frame.
  [[nodiscard]] std::vector<Vec2> curve(std::span<const double> point);
  /// The free waypoints, mission frame.
  [[nodiscard]] std::vector<Vec2> waypoints(std::span<const double> point);
  /// The point that gives these free waypoints; of lateral offsets, their lateral parts.
  [[nodiscard]] std::vector<double> point_of(std::span<const Vec2> free_waypoints) const;

 private:
  struct Tables;
  std::unique_ptr<Tables> tables_;
};

}  // namespace skein::routes
