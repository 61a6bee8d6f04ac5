// SPDX-License-Identifier: Apache-2.0
#include "skein/routes/curve.hpp"

#include <algorithm>
#include <cmath>

#include "curve_lanes.hpp"
#include "skein/base/assert.hpp"
#include "skein/routes/fly_by.hpp"

namespace skein::routes {
namespace {

/// Values at `samples` equal steps of the natural cubic spline through `knots` at 0, 1, 2, ...
std::vector<double> natural_spline(const std::vector<double>& knots, std::size_t samples) {
  const std::size_t last = knots.size() - 1;
  // Second derivatives, by elimination of the tridiagonal system 1 4 1.
  std::vector<double> second(knots.size());
  std::vector<double> factor(knots.size());
  for (std::size_t i = 1; i < last; ++i) {
    const double below = 4.0 - factor[i - 1];
    factor[i] = 1.0 / below;
    const double right = 6.0 * (knots[i + 1] - 2.0 * knots[i] + knots[i - 1]);
    second[i] = (right - second[i - 1]) / below;
  }
  for (std::size_t i = last; i-- > 1;) second[i] -= factor[i] * second[i + 1];
  std::vector<double> values(samples);
  for (std::size_t k = 0; k < samples; ++k) {
    const double at =
        static_cast<double>(k) * static_cast<double>(last) / static_cast<double>(samples - 1);
    const std::size_t i = std::min(static_cast<std::size_t>(at), last - 1);
    const double b = at - static_cast<double>(i);
    const double a = 1.0 - b;
    values[k] = a * knots[i] + b * knots[i + 1] +
                ((a * a * a - a) * second[i] + (b * b * b - b) * second[i + 1]) / 6.0;
  }
  return values;
}

/// Bounds of turns_and_legs.
constexpr double kFirstTurnMax_rad = 1.2;
constexpr double kTurnDifferenceMax_rad = 1.2;
constexpr double kLegMin = 0.1;
constexpr double kLegMax = 2.0;

int kind_number(HazardKind kind, CostReading reading) {
  switch (kind) {
    case HazardKind::detection:
      return 0;
    case HazardKind::ramp:
      return 1;
    default:
      return reading == CostReading::as_printed ? 2 : 3;
  }
}

}  // namespace

double beyond_turn_step(double number) {
  return number > kTurnStep_rad ? number - kTurnStep_rad : std::min(number + kTurnStep_rad, 0.0);
}
double with_turn_step(double rad) {
  return rad == 0.0 ? 0.0 : rad + std::copysign(kTurnStep_rad, rad);
}

struct CurveEvaluator::Tables {
  CurveForm form = CurveForm::free_points;
  Width width = Width::baseline;
  CostWeights weights;
  CostReading reading = CostReading::of_flights;
  double straight_m = 0.0;
  double exposure_scale = 0.0;  ///< of the sum over samples; of flights, over metres
  // The frame: origin and direction of its x axis.
  Vec2 origin{0.0, 0.0};
  Vec2 along{1.0, 0.0};
  Box box;
  std::size_t samples = 0;
  std::size_t stride = 0;
  std::size_t waypoints = 0;
  std::vector<double> station_m;  ///< of the waypoints, along the line
  std::vector<double> basis, base_x, base_y, mask, x, y;
  std::vector<double> leg, weight;  ///< empty as printed
  std::vector<Vec2> polygon;        ///< start, waypoints and site in this frame, of the last point
  std::vector<double> waypoint_x, waypoint_y;
  std::vector<double> hazard_x, hazard_y, radius, inner, peak, slope;
  std::vector<int> kind;

  [[nodiscard]] Vec2 local(const Vec2& p) const {
    const Vec2 d = p - origin;
    return {d.dot(along), cross(along, d)};
  }
  [[nodiscard]] Vec2 mission(double px, double py) const {
    return origin + px * along + py * left_of(along);
  }
  [[nodiscard]] CurveTable table() {
    const bool by_length = reading == CostReading::of_flights;
    return {samples,
            stride,
            waypoints,
            basis.data(),
            base_x.data(),
            base_y.data(),
            mask.data(),
            x.data(),
            y.data(),
            by_length ? leg.data() : nullptr,
            by_length ? weight.data() : nullptr};
  }
  [[nodiscard]] CurveHazards hazards() const {
    return {hazard_x.size(), hazard_x.data(), hazard_y.data(), radius.data(),
            inner.data(),    peak.data(),     slope.data(),    kind.data()};
  }
  void place(std::span<const double> point);
  void place_by_shape(std::span<const double> point);
  CurveSums evaluate(std::span<const double> point) {
    place(point);
    const double* const px = form == CurveForm::lateral_offsets ? nullptr : waypoint_x.data();
    CurveSums sums{};
#if defined(__x86_64__)
    if (width == Width::avx2) {
      curve_evaluate_avx2(table(), hazards(), px, waypoint_y.data(), sums);
      return sums;
    }
#endif
    CurveLanes<2>::evaluate(table(), hazards(), px, waypoint_y.data(), sums);
    return sums;
  }
  [[nodiscard]] double turning() const {
    if (waypoints < 2) return 0.0;
    double sum = 0.0;
    double before = 0.0;
    for (std::size_t j = 1; j <= waypoints; ++j) {
      const double turn = turn_at(polygon[j - 1], polygon[j], polygon[j + 1]);
      if (j > 1) sum += std::abs(turn - before);
      before = turn;
    }
    return sum / static_cast<double>(waypoints - 1);
  }
  void add_hazard(const RouteHazard& hazard) {
    const Vec2 centre = local(hazard.centre);
    hazard_x.push_back(centre.x());
    hazard_y.push_back(centre.y());
    radius.push_back(hazard.radius_m);
    inner.push_back(hazard.inner_radius_m);
    peak.push_back(hazard.peak);
    slope.push_back(hazard.peak / (hazard.radius_m - hazard.inner_radius_m));
    kind.push_back(kind_number(hazard.kind, reading));
  }
  void add_samples(const Vec2& from, const Vec2& to);
};

void CurveEvaluator::Tables::place(std::span<const double> point) {
  SKEIN_ASSERT(point.size() == box.dimension());
  if (form == CurveForm::turns_and_legs) {
    place_by_shape(point);
  } else {
    for (std::size_t j = 0; j < waypoints; ++j) {
      const bool is_free = form == CurveForm::free_points;
      polygon[j + 1] =
          is_free ? Vec2{point[j], point[waypoints + j]} : Vec2{station_m[j], point[j]};
    }
  }
  for (std::size_t j = 0; j < waypoints; ++j) {
    waypoint_x[j] = polygon[j + 1].x();
    waypoint_y[j] = polygon[j + 1].y();
  }
}

void CurveEvaluator::Tables::place_by_shape(std::span<const double> point) {
  const Vec2 from = polygon.front();
  const Vec2 to = polygon.back();
  double heading = 0.0;
  double turn = point[0];
  Vec2 at{0.0, 0.0};
  for (std::size_t j = 0; j <= waypoints; ++j) {
    at += point[waypoints + j] * unit_vector(heading);
    polygon[j + 1] = at;
    heading += turn;
    if (j + 1 < waypoints) turn += beyond_turn_step(point[j + 1]);
  }
  // A similarity takes (0, 0) and `at` to the ends: a product of complex numbers.
  const double reach_sq = std::max(at.squaredNorm(), 1e-12);
  const Vec2 span = to - from;
  const double re = span.dot(at) / reach_sq;
  const double im = cross(at, span) / reach_sq;
  for (std::size_t j = 1; j <= waypoints; ++j) {
    const Vec2 p = polygon[j];
    polygon[j] = from + Vec2{re * p.x() - im * p.y(), im * p.x() + re * p.y()};
  }
  polygon.back() = to;
}

void CurveEvaluator::Tables::add_samples(const Vec2& from, const Vec2& to) {
  const std::size_t column = stride + kCurveBlock;
  for (std::vector<double>* v : {&base_x, &base_y, &mask, &x, &y}) {
    v->assign(column, 0.0);
  }
  std::fill_n(mask.begin(), samples, 1.0);
  leg.assign(column + kCurveBlock, 0.0);
  weight.assign(column, 0.0);
  const auto spread = [&](const std::vector<double>& knots, std::vector<double>& to_column) {
    const std::vector<double> values = natural_spline(knots, samples);
    std::copy(values.begin(), values.end(), to_column.begin());
  };
  std::vector<double> knots(waypoints + 2);
  for (std::size_t j = 0; j < waypoints; ++j) {
    std::fill(knots.begin(), knots.end(), 0.0);
    knots[j + 1] = 1.0;
    std::vector<double> one(column);
    spread(knots, one);
    basis.insert(basis.end(), one.begin(), one.end());
  }
  std::fill(knots.begin(), knots.end(), 0.0);
  knots.front() = from.x();
  knots.back() = to.x();
  if (form == CurveForm::lateral_offsets) {
    for (std::size_t j = 0; j < waypoints; ++j) knots[j + 1] = station_m[j];
  }
  spread(knots, base_x);
  knots.assign(waypoints + 2, 0.0);
  knots.front() = from.y();
  knots.back() = to.y();
  spread(knots, base_y);
  if (form == CurveForm::lateral_offsets) {
    x = base_x;
    CurveLanes<2>::pad(x.data(), samples, stride);
  }
}

CurveEvaluator::CurveEvaluator(const CurveProblem& problem, CurveForm form, Width width)
    : tables_{std::make_unique<Tables>()} {
  SKEIN_ASSERT(problem.waypoints >= 1 && problem.samples >= 4);
  Tables& t = *tables_;
  t.form = form;
  t.width = width;
  t.weights = problem.weights;
  t.reading = problem.reading;
  t.samples = problem.samples;
  t.stride = (problem.samples + kCurveBlock - 1) / kCurveBlock * kCurveBlock;
  t.waypoints = problem.waypoints;
  const Vec2 straight = problem.site - problem.start;
  t.straight_m = straight.norm();
  SKEIN_ASSERT(t.straight_m > 0.0);
  t.exposure_scale =
      t.reading == CostReading::of_flights ? 1.0 : 1.0 / static_cast<double>(problem.samples);
  if (problem.exposure_per_hazard && !problem.hazards.empty()) {
    t.exposure_scale /= static_cast<double>(problem.hazards.size());
  }
  t.waypoint_x.resize(t.waypoints);
  t.waypoint_y.resize(t.waypoints);
  if (form == CurveForm::lateral_offsets) {
    t.origin = problem.start;
    t.along = straight / t.straight_m;
    t.box.low.assign(t.waypoints, -0.5 * t.straight_m);
    t.box.high.assign(t.waypoints, 0.5 * t.straight_m);
  } else if (form == CurveForm::turns_and_legs) {
    t.box.high.assign(t.waypoints, kTurnDifferenceMax_rad);
    t.box.high.front() = kFirstTurnMax_rad;
    for (const double high : t.box.high) t.box.low.push_back(-high);
    t.box.low.insert(t.box.low.end(), t.waypoints + 1, kLegMin);
    t.box.high.insert(t.box.high.end(), t.waypoints + 1, kLegMax);
  } else {
    for (const int axis : {0, 1}) {
      t.box.low.insert(t.box.low.end(), t.waypoints, problem.world_low[axis]);
      t.box.high.insert(t.box.high.end(), t.waypoints, problem.world_high[axis]);
    }
  }
  for (std::size_t j = 1; j <= t.waypoints; ++j) {
    t.station_m.push_back(t.straight_m * static_cast<double>(j) /
                          static_cast<double>(t.waypoints + 1));
  }
  t.polygon.resize(t.waypoints + 2);
  t.polygon.front() = t.local(problem.start);
  t.polygon.back() = t.local(problem.site);
  t.add_samples(t.polygon.front(), t.polygon.back());
  for (const RouteHazard& hazard : problem.hazards) {
    SKEIN_ASSERT(hazard.radius_m > 0.0 && hazard.inner_radius_m < hazard.radius_m);
    t.add_hazard(hazard);
  }
}

CurveEvaluator::~CurveEvaluator() = default;
CurveEvaluator::CurveEvaluator(CurveEvaluator&&) noexcept = default;
CurveEvaluator& CurveEvaluator::operator=(CurveEvaluator&&) noexcept = default;

const Box& CurveEvaluator::box() const { return tables_->box; }

RouteCosts CurveEvaluator::costs(std::span<const double> point) {
  Tables& t = *tables_;
  const CurveSums sums = t.evaluate(point);
  const bool by_length = t.reading == CostReading::of_flights;
  RouteCosts costs{.exposure = sums.exposure * t.exposure_scale / (by_length ? sums.length : 1.0),
                   .length_ratio = sums.length / t.straight_m,
                   .turning = t.turning(),
                   .total = 0.0};
  costs.total = t.weights.exposure * costs.exposure + t.weights.length * costs.length_ratio +
                t.weights.turning * costs.turning;
  if (sums.entered > 0.0) costs.total += kBarredCost * (1.0 + sums.entered / t.straight_m);
  return costs;
}

void CurveEvaluator::keep_out_room(std::size_t parts, double far, std::vector<double>& room) const {
  Tables& t = *tables_;
  const CurveTable table = t.table();
  const CurveHazards hazards = t.hazards();
  const double far_m = far * t.straight_m;
  const std::size_t legs = t.samples - 1;
  room.clear();
  for (std::size_t i = 0; i < hazards.count; ++i) {
    if (hazards.kind[i] != 3) continue;
    for (std::size_t part = 0; part < parts; ++part) {
      const std::size_t end = legs * (part + 1) / parts;
      double inside = -far_m;
      for (std::size_t k = legs * part / parts; k < end; ++k) {
        const Vec2 out{t.x[k] - hazards.x[i], t.y[k] - hazards.y[i]};
        const Vec2 leg{t.x[k + 1] - t.x[k], t.y[k + 1] - t.y[k]};
        const double reach = hazards.radius[i] + far_m;
        // Twice the leg, for what it bulges.
        if (out.squaredNorm() > 2.0 * (reach * reach + 4.0 * leg.squaredNorm())) continue;
        inside = std::max(inside, CurveLanes<2>::inside(table, hazards, i, k));
      }
      room.push_back(-inside / t.straight_m);
    }
  }
}

std::vector<Vec2> CurveEvaluator::curve(std::span<const double> point) {
  Tables& t = *tables_;
  t.evaluate(point);
  std::vector<Vec2> points;
  points.reserve(t.samples);
  for (std::size_t k = 0; k < t.samples; ++k) points.push_back(t.mission(t.x[k], t.y[k]));
  return points;
}

std::vector<Vec2> CurveEvaluator::waypoints(std::span<const double> point) {
  Tables& t = *tables_;
  t.place(point);
  std::vector<Vec2> points;
  for (std::size_t j = 1; j <= t.waypoints; ++j) {
    points.push_back(t.mission(t.polygon[j].x(), t.polygon[j].y()));
  }
  return points;
}

std::vector<double> CurveEvaluator::point_of(std::span<const Vec2> free_waypoints) const {
  const Tables& t = *tables_;
  SKEIN_ASSERT(free_waypoints.size() == t.waypoints);
  std::vector<double> point(t.box.dimension());
  if (t.form == CurveForm::turns_and_legs) {
    std::vector<Vec2> polygon = t.polygon;
    for (std::size_t j = 0; j < t.waypoints; ++j) polygon[j + 1] = t.local(free_waypoints[j]);
    double before = 0.0;
    double length = 0.0;
    for (std::size_t j = 0; j <= t.waypoints; ++j) {
      point[t.waypoints + j] = (polygon[j + 1] - polygon[j]).norm();
      length += point[t.waypoints + j];
      if (j == t.waypoints) break;
      const double turn = turn_at(polygon[j], polygon[j + 1], polygon[j + 2]);
      point[j] = j == 0 ? turn : with_turn_step(turn - before);
      before = turn;
    }
    const double scale = static_cast<double>(t.waypoints + 1) / length;
    for (std::size_t j = 0; j <= t.waypoints; ++j) {
      point[t.waypoints + j] *= scale;
    }
    t.box.clamp(point);
    return point;
  }
  for (std::size_t j = 0; j < t.waypoints; ++j) {
    if (t.form == CurveForm::free_points) {
      point[j] = free_waypoints[j].x();
      point[t.waypoints + j] = free_waypoints[j].y();
    } else {
      point[j] = t.local(free_waypoints[j]).y();
    }
  }
  t.box.clamp(point);
  return point;
}

}  // namespace skein::routes
