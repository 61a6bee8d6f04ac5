// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "place_check.hpp"
#include "place_lanes.hpp"
#include "skein/base/assert.hpp"
#include "skein/formation/place_assignment.hpp"

namespace skein::formation {
namespace {

using Width = PlaceSolver::Width;

/// With fewer vehicles a guess costs more than it spares.
constexpr std::size_t kGuessedFrom = 64;

void fill([[maybe_unused]] Width width, const PlaceTable& table, const PlacePoints& rows,
          const PlacePoints& columns, bool squared) {
#if defined(__x86_64__)
  if (width == Width::avx2) return place_fill_avx2(table, rows, columns, squared);
#endif
  PlaceLanes<2>::fill(table, rows, columns, squared);
}

Vec3 centre_of(std::span<const Vec3> points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

/// Entries above the threshold are forbidden.
void forbid_above(const PlaceTable& table, double threshold) {
  const double most = threshold * (1.0 + kEqualLegs);
  for (std::size_t i = 0; i < table.count * table.stride; ++i) {
    if (table.cost[i] > most) table.cost[i] = std::numeric_limits<double>::infinity();
  }
}

/// v without its part along `way`; wholly only where the way is as long as `length_m`.
Vec3 across(const Vec3& v, const Vec3& way, double length_m) {
  return v - way * (v.dot(way) / (length_m * length_m));
}

/// Of the points about their centre, by axis.
Vec3 deviation(std::span<const Vec3> points, const Vec3& centre, const Vec3& way, double length_m) {
  Vec3 squares = Vec3::Zero();
  for (const Vec3& point : points) {
    squares += across(point - centre, way, length_m).cwiseAbs2();
  }
  return (squares / static_cast<double>(points.size())).cwiseSqrt();
}

}  // namespace

void PlaceSolver::spread(std::span<const Vec3> points, const Vec3& origin, std::size_t stride,
                         Columns& to) {
  to.x.assign(stride, std::numeric_limits<double>::infinity());
  to.y.assign(stride, 0.0);
  to.z.assign(stride, 0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    to.x[i] = points[i].x() - origin.x();
    to.y[i] = points[i].y() - origin.y();
    to.z[i] = points[i].z() - origin.z();
  }
}

/// As if all vehicles and all places were normally distributed, independently by axis: the least
/// squares then move centre to centre and stretch each axis by the ratio a of its deviations
/// (Dowson and Landau 1982), and the dual price of a vehicle at p from the centre of all, which is
/// D from that of the places, is p . (p - a p), and 2 p . D where the squares are of whole legs. A
/// length near L is its square / 2 L, but for what is along D: there it is linear.
std::span<const double> PlaceSolver::guess(PlaceMethod method, std::span<const Vec3> vehicles,
                                           std::span<const Vec3> places) {
  const std::size_t count = vehicles.size();
  if (count < kGuessedFrom) return {};
  const Vec3 from = centre_of(vehicles);
  const Vec3 to = centre_of(places);
  const bool lengths = method == PlaceMethod::least_sum;
  const Vec3 way = method == PlaceMethod::least_squares ? Vec3::Zero() : Vec3{from - to};
  constexpr double kWhole = std::numeric_limits<double>::infinity();
  const Vec3 before = deviation(vehicles, from, way, kWhole);
  const Vec3 after = deviation(places, to, way, kWhole);
  // Legs are no shorter than about what is between neighbours.
  const double neighbours_m2 =
      (before.squaredNorm() + after.squaredNorm()) / static_cast<double>(count);
  const double length_m =
      std::sqrt(way.squaredNorm() + (before - after).squaredNorm() + neighbours_m2);
  if (!(length_m > 0.0)) return {};
  const double bent_at_m = lengths ? length_m : kWhole;
  const Vec3 old_size = deviation(vehicles, from, way, bent_at_m);
  const Vec3 new_size = deviation(places, to, way, bent_at_m);
  Vec3 stretch = Vec3::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    if (old_size[axis] > 1e-6 * length_m) stretch[axis] = new_size[axis] / old_size[axis];
  }
  guess_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 p = vehicles[i] - from;
    const Vec3 aside = across(p, way, bent_at_m);
    guess_[i] = 2.0 * p.dot(way) + aside.dot(aside - stretch.cwiseProduct(aside));
    if (lengths) guess_[i] /= 2.0 * length_m;
  }
  return guess_;
}

Result<void> PlaceSolver::solve(PlaceMethod method, std::span<const Vec3> vehicles,
                                std::span<const Vec3> places, PlaceAssignment& result) {
  if (method >= PlaceMethod::colony) {
    return Error{"the method " + std::string{to_string(method)} + " is not an exact one"};
  }
  if (auto checked = check_places(vehicles, places); !checked) return checked;
  result.method = method;
  result.certificate.crowded_vehicles.clear();
  result.certificate.near_places.clear();
  const std::size_t count = vehicles.size();
  result.place_of.resize(count);
  result.certificate.place_price.resize(count);
  if (count == 0) return {};

  const auto table = solver_.table(count, count);
  const PlaceTable costs{count, table.stride, table.entries};
  const bool squares = method == PlaceMethod::least_squares;
  // A shift of all places changes squares by what rows and columns add, so the least sum of squares
  // stays; without it one vehicle at the edge would be nearest to every place of a formation that
  // moves on.
  const Vec3 from = squares ? centre_of(vehicles) : Vec3::Zero();
  const Vec3 to = squares ? centre_of(places) : Vec3::Zero();
  spread(vehicles, from, table.stride, vehicles_);
  spread(places, to, table.stride, places_);
  fill(width_, costs, {vehicles_.x.data(), vehicles_.y.data(), vehicles_.z.data()},
       {places_.x.data(), places_.y.data(), places_.z.data()}, method != PlaceMethod::least_sum);
  if (method == PlaceMethod::least_longest) {
    const auto longest = solver_.bottleneck(result.place_of);
    SKEIN_ASSERT(longest.has_value());
    const auto crowded = solver_.crowded_rows();
    const auto near = solver_.near_columns();
    result.certificate.crowded_vehicles.assign(crowded.begin(), crowded.end());
    result.certificate.near_places.assign(near.begin(), near.end());
    forbid_above(costs, *longest);
  }
  const bool assigned = solver_.least_sum(guess(method, vehicles, places), result.place_of);
  SKEIN_ASSERT(assigned);
  const std::span<const double> price = solver_.column_prices();
  const Vec3 shift = 2.0 * (from - to);
  for (std::size_t i = 0; i < count; ++i) {
    result.certificate.place_price[i] =
        price[i] - (shift.x() * places_.x[i] + shift.y() * places_.y[i] + shift.z() * places_.z[i]);
  }
  return {};
}

}  // namespace skein::formation
