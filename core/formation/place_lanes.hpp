// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "skein/base/vectors.hpp"

namespace skein::formation {

/// Rows and columns are padded to a multiple of this: the same table for every width.
inline constexpr std::size_t kPlaceLine = 8;

/// Vehicles or places, column by column and padded. The padding of places has x = +infinity, so
/// that their costs are infinite.
struct PlacePoints {
  const double* x;
  const double* y;
  const double* z;
};

/// Memory of one problem. All rows of doubles have `stride` entries.
struct PlaceTable {
  std::size_t count;   ///< of vehicles (rows), and of places (columns)
  std::size_t stride;  ///< count, rounded up to kPlaceLine
  double* cost;        ///< row by row; +infinity where not allowed
  double* price;       ///< by column; the padding is 0
  double* distance;    ///< scratch, by column
  double* taken;       ///< by column: +infinity where it has a row, else 0
  int* column_of;      ///< by row
  int* row_of;         ///< by column; -1: none
  int* waiting;        ///< rows without a column, and scratch
  int* seen_row;       ///< rows of the last search, in its order
  int* seen_column;    ///< the column that led to each
  double* reach;       ///< how far it is to each
  double* base;        ///< what its reduced costs are added to
  double* kept_price;  ///< of that column
};

/// No complete assignment has all entries below `threshold`: `rows` rows have only `columns`
/// columns below it, which are fewer. Which they are stands in the caller's arrays of table size.
struct PlaceThreshold {
  double threshold;
  std::size_t rows;
  std::size_t columns;
  int* crowded;  ///< the rows
  int* near;     ///< the columns
};

/// Least-sum and least-largest assignments of a dense square table.
/// Minima, additions and subtractions in one order, ties by the lowest index: the same bits with
/// every width. Each width is instantiated in one source only, which is compiled for processors
/// that have it; hence no header with code is included.
template <int Lanes>
struct PlaceLanes {
  using Real = typename Vectors<Lanes>::Real;
  using Bits = typename Vectors<Lanes>::Bits;

  static constexpr double kInfinity = __builtin_inf();

  static Real splat(double value) { return Real{} + value; }
  static Real load(const double* from) {
    Real result{};
    __builtin_memcpy(&result, from, sizeof result);
    return result;
  }
  static void store(double* to, Real value) { __builtin_memcpy(to, &value, sizeof value); }
  static Real least(Real a, Real b) {
#if defined(__AVX2__)
    if constexpr (Lanes == 4) return Real(_mm256_min_pd(__m256d(b), __m256d(a)));
#endif
#if defined(__x86_64__)
    if constexpr (Lanes == 2) return Real(_mm_min_pd(__m128d(b), __m128d(a)));
#endif
    return b < a ? b : a;
  }
  static Real most(Real a, Real b) { return a < b ? b : a; }
  static Real root(Real a) {
#if defined(__AVX2__)
    if constexpr (Lanes == 4) return Real(_mm256_sqrt_pd(__m256d(a)));
#endif
#if defined(__x86_64__)
    if constexpr (Lanes == 2) return Real(_mm_sqrt_pd(__m128d(a)));
#endif
    for (int i = 0; i < Lanes; ++i) a[i] = __builtin_sqrt(a[i]);
    return a;
  }
  static double least_lane(Real a) {
    if constexpr (Lanes == 4) {
      a = least(a, __builtin_shufflevector(a, a, 2, 3, 0, 1));
      a = least(a, __builtin_shufflevector(a, a, 1, 0, 3, 2));
    } else {
      a = least(a, __builtin_shufflevector(a, a, 1, 0));
    }
    return a[0];
  }
  static Real lane_numbers() {
    Real result{};
    for (int i = 0; i < Lanes; ++i) result[i] = i;
    return result;
  }

  /// The least of what it was shown, and the lowest index that has it. Indices are doubles so that
  /// they are selected with the same masks.
  struct Least {
    Real value = splat(kInfinity);
    Real index = Real{};

    void look_at(Real candidate, Real at) {
      index = candidate < value ? at : index;
      value = least(value, candidate);
    }
    /// The index where no candidate was below infinity is of no meaning.
    std::size_t pick(double& smallest) const {
      smallest = least_lane(value);
      const Real at = value == splat(smallest) ? index : splat(kInfinity);
      return static_cast<std::size_t>(least_lane(at));
    }
  };

  static void fill(const PlaceTable& t, const PlacePoints& rows, const PlacePoints& columns,
                   bool squared) {
    for (std::size_t row = 0; row < t.count; ++row) {
      const Real x = splat(rows.x[row]);
      const Real y = splat(rows.y[row]);
      const Real z = splat(rows.z[row]);
      double* const entries = t.cost + row * t.stride;
      for (std::size_t j = 0; j < t.stride; j += Lanes) {
        const Real dx = load(columns.x + j) - x;
        const Real dy = load(columns.y + j) - y;
        const Real dz = load(columns.z + j) - z;
        const Real sum = (dx * dx + dy * dy) + dz * dz;
        store(entries + j, squared ? sum : root(sum));
      }
    }
  }

  static void give(const PlaceTable& t, std::size_t row, std::size_t column) {
    t.column_of[row] = static_cast<int>(column);
    t.row_of[column] = static_cast<int>(row);
  }

  /// Prices = least entries of the columns; rows take columns of which they have the least entry.
  static void reduce_columns(const PlaceTable& t) {
    double* const least_row = t.distance;
    for (std::size_t j = 0; j < t.stride; j += Lanes) {
      Least column;
      for (std::size_t row = 0; row < t.count; ++row) {
        column.look_at(load(t.cost + row * t.stride + j), splat(static_cast<double>(row)));
      }
      store(t.price + j, column.value);
      store(least_row + j, column.index);
    }
    for (std::size_t j = t.count; j < t.stride; ++j) t.price[j] = 0.0;
    for (std::size_t row = 0; row < t.count; ++row) t.column_of[row] = -1;
    for (std::size_t j = t.count; j-- > 0;) {
      const auto row = static_cast<std::size_t>(least_row[j]);
      if (t.column_of[row] < 0) {
        give(t, row, j);
      } else {
        t.row_of[j] = -1;
      }
    }
  }

  template <bool Longest>
  static double onward(double base, double entry, double price) {
    if constexpr (Longest) return entry < base ? base : entry;
    return base + (entry - price);
  }

  /// Shortest alternating path from a row without a column to a column without a row, over reduced
  /// costs (or with the length of a path its largest entry). Columns that are done have the price
  /// -infinity meanwhile, which makes all ways to them infinite without a branch.
  template <bool Longest>
  static double search(const PlaceTable& t, std::size_t root, double start, std::size_t& seen,
                       std::size_t& sink) {
    seen = 0;
    for (std::size_t j = 0; j < t.stride; j += Lanes) store(t.distance + j, splat(kInfinity));
    std::size_t row = root;
    double base_here = start;
    std::size_t came_by = 0;
    double length = start;
    while (true) {
      t.seen_row[seen] = static_cast<int>(row);
      t.seen_column[seen] = static_cast<int>(came_by);
      t.reach[seen] = length;
      t.base[seen] = base_here;
      ++seen;
      const double* const entries = t.cost + row * t.stride;
      const Real base = splat(base_here);
      Least nearest;
      Least nearest_free;
      Real at = lane_numbers();
      for (std::size_t j = 0; j < t.stride; j += Lanes) {
        const Real reduced = load(entries + j) - load(t.price + j);
        const Real through = Longest ? most(base, reduced) : base + reduced;
        const Real distance = least(load(t.distance + j), through);
        store(t.distance + j, distance);
        nearest.look_at(distance, at);
        if constexpr (Longest) nearest_free.look_at(distance + load(t.taken + j), at);
        at += static_cast<double>(Lanes);
      }
      std::size_t column = nearest.pick(length);
      if constexpr (Longest) {
        double free_length = 0.0;
        const std::size_t free_column = nearest_free.pick(free_length);
        if (free_length <= length) column = free_column;
      }
      if (t.row_of[column] < 0) {
        sink = column;
        return length;
      }
      row = static_cast<std::size_t>(t.row_of[column]);
      base_here = Longest ? length : length - (t.cost[row * t.stride + column] - t.price[column]);
      came_by = column;
      t.kept_price[seen] = t.price[column];
      t.price[column] = -kInfinity;
      t.distance[column] = kInfinity;
    }
  }

  /// Swaps owners along the path that the search found. How it came to a column was not written
  /// down: the first row seen that leads to it at its very distance.
  template <bool Longest>
  static void take_path(const PlaceTable& t, std::size_t seen, std::size_t sink, double length) {
    for (std::size_t s = 1; s < seen; ++s) t.price[t.seen_column[s]] = t.kept_price[s];
    std::size_t column = sink;
    double distance = length;
    while (true) {
      const double price = t.price[column];
      std::size_t s = 0;
      std::size_t row = static_cast<std::size_t>(t.seen_row[0]);
      while (onward<Longest>(t.base[s], t.cost[row * t.stride + column], price) != distance &&
             s + 1 < seen) {
        row = static_cast<std::size_t>(t.seen_row[++s]);
      }
      give(t, row, column);
      if (s == 0) return;
      column = static_cast<std::size_t>(t.seen_column[s]);
      distance = t.reach[s];
    }
  }

  static std::size_t list_waiting(const PlaceTable& t) {
    std::size_t waiting = 0;
    for (std::size_t row = 0; row < t.count; ++row) {
      if (t.column_of[row] < 0) t.waiting[waiting++] = static_cast<int>(row);
    }
    return waiting;
  }

  /// Jonker and Volgenant 1987: column reduction, then shortest augmenting paths. Their reduction
  /// transfer and augmenting row reduction are left out: with costs of distances the first does not
  /// pay, and in the second rows bid each other down in ever smaller steps. At least one complete
  /// assignment must be allowed.
  static void least_sum(const PlaceTable& t) {
    reduce_columns(t);
    const std::size_t waiting = list_waiting(t);
    for (std::size_t w = 0; w < waiting; ++w) {
      std::size_t seen = 0;
      std::size_t sink = 0;
      const double length =
          search<false>(t, static_cast<std::size_t>(t.waiting[w]), 0.0, seen, sink);
      take_path<false>(t, seen, sink, length);
      for (std::size_t s = 1; s < seen; ++s) t.price[t.seen_column[s]] += t.reach[s] - length;
    }
  }

  /// No threshold below the least entry of any row or column can do.
  static void lower_threshold(const PlaceTable& t, PlaceThreshold& result) {
    result.threshold = -kInfinity;
    for (std::size_t row = 0; row < t.count; ++row) {
      const double* const entries = t.cost + row * t.stride;
      Real least_entries = splat(kInfinity);
      for (std::size_t j = 0; j < t.stride; j += Lanes) {
        least_entries = least(least_entries, load(entries + j));
      }
      const double least_entry = least_lane(least_entries);
      if (least_entry <= result.threshold) continue;
      result.threshold = least_entry;
      result.rows = 1;
      result.columns = 0;
      result.crowded[0] = static_cast<int>(row);
    }
    std::size_t lonely = t.count;
    for (std::size_t j = 0; j < t.stride; j += Lanes) {
      Real least_entries = splat(kInfinity);
      for (std::size_t row = 0; row < t.count; ++row) {
        least_entries = least(least_entries, load(t.cost + row * t.stride + j));
      }
      for (std::size_t k = j; k < j + Lanes && k < t.count; ++k) {
        if (least_entries[k - j] <= result.threshold) continue;
        result.threshold = least_entries[k - j];
        lonely = k;
      }
    }
    if (lonely == t.count) return;
    result.rows = 0;
    result.columns = 0;
    for (std::size_t i = 0; i < t.count; ++i) {
      result.crowded[result.rows++] = static_cast<int>(i);
      if (i != lonely) result.near[result.columns++] = static_cast<int>(i);
    }
  }

  /// Augmenting paths of least largest entry; by Berge's theorem one more row fits within the least
  /// threshold at which such a path exists. Where a path raises the threshold, the rows that the
  /// search had seen below it have no other columns below it than those it came by.
  static void least_largest(const PlaceTable& t, PlaceThreshold& result) {
    for (std::size_t j = 0; j < t.stride; ++j) {
      t.price[j] = 0.0;
      t.taken[j] = 0.0;
    }
    for (std::size_t i = 0; i < t.count; ++i) t.column_of[i] = t.row_of[i] = -1;
    lower_threshold(t, result);
    for (std::size_t row = 0; row < t.count; ++row) {
      for (std::size_t j = 0; j < t.count; ++j) {
        if (t.row_of[j] >= 0 || t.cost[row * t.stride + j] > result.threshold) continue;
        give(t, row, j);
        t.taken[j] = kInfinity;
        break;
      }
    }
    const std::size_t waiting = list_waiting(t);
    for (std::size_t w = 0; w < waiting; ++w) {
      std::size_t seen = 0;
      std::size_t sink = 0;
      const double largest =
          search<true>(t, static_cast<std::size_t>(t.waiting[w]), result.threshold, seen, sink);
      if (largest > result.threshold) {
        result.threshold = largest;
        result.rows = 0;
        result.columns = 0;
        for (std::size_t s = 0; s < seen && t.reach[s] < largest; ++s) {
          result.crowded[result.rows++] = t.seen_row[s];
          if (s > 0) result.near[result.columns++] = t.seen_column[s];
        }
      }
      take_path<true>(t, seen, sink, largest);
      t.taken[sink] = kInfinity;
    }
  }
};

#if defined(__x86_64__)
void place_fill_avx2(const PlaceTable& table, const PlacePoints& rows, const PlacePoints& columns,
                     bool squared);
void place_least_sum_avx2(const PlaceTable& table);
void place_least_largest_avx2(const PlaceTable& table, PlaceThreshold& result);
#endif

}  // namespace skein::formation
