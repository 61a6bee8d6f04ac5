// SPDX-License-Identifier: Apache-2.0
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
using Baseline = PlaceLanes<2>;

void fill([[maybe_unused]] Width width, const PlaceTable& table, const PlacePoints& rows,
          const PlacePoints& columns, bool squared) {
#if defined(__x86_64__)
  if (width == Width::avx2) return place_fill_avx2(table, rows, columns, squared);
#endif
  Baseline::fill(table, rows, columns, squared);
}

void least_sum([[maybe_unused]] Width width, const PlaceTable& table) {
#if defined(__x86_64__)
  if (width == Width::avx2) return place_least_sum_avx2(table);
#endif
  Baseline::least_sum(table);
}

void least_largest([[maybe_unused]] Width width, const PlaceTable& table, PlaceThreshold& result) {
#if defined(__x86_64__)
  if (width == Width::avx2) return place_least_largest_avx2(table, result);
#endif
  Baseline::least_largest(table, result);
}

struct Columns {
  double* x;
  double* y;
  double* z;
};

Vec3 centre_of(std::span<const Vec3> points) {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

void spread(std::span<const Vec3> points, const Vec3& origin, std::size_t stride,
            const Columns& to) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    to.x[i] = points[i].x() - origin.x();
    to.y[i] = points[i].y() - origin.y();
    to.z[i] = points[i].z() - origin.z();
  }
  for (std::size_t i = points.size(); i < stride; ++i) {
    to.x[i] = std::numeric_limits<double>::infinity();
    to.y[i] = 0.0;
    to.z[i] = 0.0;
  }
}

/// Entries above the threshold are forbidden.
void forbid_above(const PlaceTable& table, double threshold) {
  const double most = threshold * (1.0 + kEqualLegs);
  for (std::size_t i = 0; i < table.count * table.stride; ++i) {
    if (table.cost[i] > most) table.cost[i] = std::numeric_limits<double>::infinity();
  }
}

}  // namespace

std::span<const Width> PlaceSolver::widths() {
  static constexpr std::array<Width, 2> kWidths = {Width::baseline, Width::avx2};
#if defined(__x86_64__)
  static const std::size_t count = __builtin_cpu_supports("avx2") ? 2 : 1;
#else
  static const std::size_t count = 1;
#endif
  return {kWidths.data(), count};
}

struct PlaceSolver::Layout {
  PlaceTable table;
  Columns vehicles;
  Columns places;
  int* crowded;
  int* near;
};

PlaceSolver::PlaceSolver(Width width) : width_{width} {
  SKEIN_ASSERT(static_cast<std::size_t>(width) < widths().size());
}

PlaceSolver::Layout PlaceSolver::lay_out(std::size_t count) {
  constexpr std::size_t kRowsOfDoubles = 12;
  constexpr std::size_t kRowsOfInts = 7;
  const std::size_t stride = (count + kPlaceLine - 1) / kPlaceLine * kPlaceLine;
  const std::size_t lines = (count + kRowsOfDoubles) * (stride / kPlaceLine);
  if (numbers_.size() < lines) numbers_.resize(lines);
  if (indices_.size() < kRowsOfInts * stride) indices_.resize(kRowsOfInts * stride);
  double* number = numbers_.data()->values.data();
  int* index = indices_.data();
  const auto doubles = [&](std::size_t rows = 1) {
    double* const row = number;
    number += rows * stride;
    return row;
  };
  const auto ints = [&] {
    int* const row = index;
    index += stride;
    return row;
  };
  Layout layout{};
  PlaceTable& table = layout.table;
  table.count = count;
  table.stride = stride;
  for (double** row : {&table.price, &table.distance, &table.taken, &table.reach, &table.base,
                       &table.kept_price, &layout.vehicles.x, &layout.vehicles.y,
                       &layout.vehicles.z, &layout.places.x, &layout.places.y, &layout.places.z}) {
    *row = doubles();
  }
  table.cost = doubles(count);
  for (int** row : {&table.column_of, &table.row_of, &table.waiting, &table.seen_row,
                    &table.seen_column, &layout.crowded, &layout.near}) {
    *row = ints();
  }
  return layout;
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

  const Layout layout = lay_out(count);
  const PlaceTable& table = layout.table;
  const bool squares = method == PlaceMethod::least_squares;
  // A shift of all places changes squares by what rows and columns add, so the least sum of squares
  // stays; without it one vehicle at the edge would be nearest to every place of a formation that
  // moves on.
  const Vec3 from = squares ? centre_of(vehicles) : Vec3::Zero();
  const Vec3 to = squares ? centre_of(places) : Vec3::Zero();
  spread(vehicles, from, table.stride, layout.vehicles);
  spread(places, to, table.stride, layout.places);
  fill(width_, table, {layout.vehicles.x, layout.vehicles.y, layout.vehicles.z},
       {layout.places.x, layout.places.y, layout.places.z}, method != PlaceMethod::least_sum);
  if (method == PlaceMethod::least_longest) {
    PlaceThreshold threshold{0.0, 0, 0, layout.crowded, layout.near};
    least_largest(width_, table, threshold);
    result.certificate.crowded_vehicles.assign(layout.crowded, layout.crowded + threshold.rows);
    result.certificate.near_places.assign(layout.near, layout.near + threshold.columns);
    forbid_above(table, threshold.threshold);
  }
  least_sum(width_, table);
  const Vec3 shift = 2.0 * (from - to);
  for (std::size_t i = 0; i < count; ++i) {
    result.place_of[i] = table.column_of[i];
    result.certificate.place_price[i] =
        table.price[i] - (shift.x() * layout.places.x[i] + shift.y() * layout.places.y[i] +
                          shift.z() * layout.places.z[i]);
  }
  return {};
}

}  // namespace skein::formation
