// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "skein/base/vectors.hpp"

namespace skein::planning {

/// Rows are padded to a multiple of this: the same table for every width.
inline constexpr std::size_t kAssignmentLine = 8;

/// Memory of one problem. All rows of doubles have `stride` entries, all arrays of int as many.
struct AssignmentTable {
  std::size_t rows;
  std::size_t columns;  ///< rows at least
  std::size_t stride;   ///< columns, rounded up to kAssignmentLine
  double* cost;         ///< row by row; +infinity where not allowed, and in the padding
  double* price;        ///< by column; the padding is 0
  double* distance;     ///< scratch, by column
  double* taken;        ///< by column: +infinity where it has a row, else 0
  int* column_of;       ///< by row
  int* row_of;          ///< by column; -1: none
  int* waiting;         ///< rows without a column
  int* seen_row;        ///< rows of the last search, in its order
  int* seen_column;     ///< the column that led to each
  double* reach;        ///< how far it is to each
  double* base;         ///< what its reduced costs are added to
  double* kept_price;   ///< of that column
};

/// No complete assignment has all entries below `threshold`: `rows` rows have only `columns`
/// columns below it, which are fewer. Which they are stands in arrays of the table's size.
struct AssignmentThreshold {
  double threshold;
  std::size_t rows;
  std::size_t columns;
  int* crowded;  ///< the rows
  int* near;     ///< the columns
};

/// Assignments of the least sum and of the least largest entry, of a dense table.
/// Minima, additions and subtractions in one order, ties by the lowest index, free columns first:
/// the same bits with every width. Each width is instantiated in one source only, which is compiled
/// for processors that have it; hence no header with code is included.
template <int Lanes>
struct AssignmentLanes : VectorOps<Lanes> {
  using Real = typename Vectors<Lanes>::Real;
  using Bits = typename Vectors<Lanes>::Bits;

  static constexpr double kInfinity = __builtin_inf();

  using VectorOps<Lanes>::splat;
  using VectorOps<Lanes>::load;
  using VectorOps<Lanes>::store;
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
  static double least_lane(Real a) {
    if constexpr (Lanes == 4) {
      a = least(a, __builtin_shufflevector(a, a, 2, 3, 0, 1));
      a = least(a, __builtin_shufflevector(a, a, 1, 0, 3, 2));
    } else {
      a = least(a, __builtin_shufflevector(a, a, 1, 0));
    }
    return a[0];
  }
  static bool has_any(Bits bits) {
#if defined(__AVX2__)
    if constexpr (Lanes == 4) return _mm256_movemask_pd(__m256d(bits)) != 0;
#endif
#if defined(__x86_64__)
    if constexpr (Lanes == 2) return _mm_movemask_pd(__m128d(bits)) != 0;
#endif
    for (int i = 0; i < Lanes; ++i) {
      if (bits[i] != 0) return true;
    }
    return false;
  }

  static void give(const AssignmentTable& t, std::size_t row, std::size_t column) {
    t.column_of[row] = static_cast<int>(column);
    t.row_of[column] = static_cast<int>(row);
    t.taken[column] = kInfinity;
  }

  static void start(const AssignmentTable& t) {
    for (std::size_t j = 0; j < t.stride; ++j) {
      t.price[j] = 0.0;
      t.taken[j] = 0.0;
      t.row_of[j] = -1;
    }
    for (std::size_t row = 0; row < t.rows; ++row) t.column_of[row] = -1;
  }

  /// Of a square table: prices = least entries of the columns, less what is guessed of the rows;
  /// rows take columns of which they have the least. False where a column has no entry.
  static bool reduce_columns(const AssignmentTable& t, const double* row_guess) {
    double* const least_row = t.distance;
    for (std::size_t j = 0; j < t.stride; ++j) {
      t.price[j] = kInfinity;
      least_row[j] = 0.0;
    }
    for (std::size_t row = 0; row < t.rows; ++row) {
      const double* const entries = t.cost + row * t.stride;
      const Real guess = splat(row_guess != nullptr ? row_guess[row] : 0.0);
      const Real index = splat(static_cast<double>(row));
      for (std::size_t j = 0; j < t.stride; j += Lanes) {
        const Real reduced = load(entries + j) - guess;
        const Real before = load(t.price + j);
        store(least_row + j, reduced < before ? index : load(least_row + j));
        store(t.price + j, least(before, reduced));
      }
    }
    for (std::size_t j = t.columns; j < t.stride; ++j) t.price[j] = 0.0;
    for (std::size_t j = t.columns; j-- > 0;) {
      if (t.price[j] == kInfinity) return false;
      const auto row = static_cast<std::size_t>(least_row[j]);
      if (t.column_of[row] < 0) give(t, row, j);
    }
    return true;
  }

  template <bool Longest>
  static double onward(double base, double entry, double price) {
    if constexpr (Longest) return entry < base ? base : entry;
    return base + (entry - price);
  }

  /// The first column at that distance, which one is; of those without a row only where `free`.
  static std::size_t first_at(const AssignmentTable& t, double length, bool free) {
    const Real wanted = splat(length);
    for (std::size_t line = 0;; line += kAssignmentLine) {
      Bits any{};
      for (std::size_t j = 0; j < kAssignmentLine; j += Lanes) {
        any |= load(t.distance + line + j) == wanted;
      }
      if (!has_any(any)) continue;
      for (std::size_t j = line; j < line + kAssignmentLine; ++j) {
        if (t.distance[j] == length && (!free || t.row_of[j] < 0)) return j;
      }
    }
  }

  struct Found {
    std::size_t sink;  ///< the column
    std::size_t seen;  ///< rows that were looked at
    double length;     ///< infinite: none
  };

  /// Shortest alternating path from a row without a column to a column without a row, over reduced
  /// costs (or with the length of a path its largest entry). Columns that are done have the price
  /// -infinity meanwhile, which makes all ways to them infinite without a branch.
  template <bool Longest>
  static Found search(const AssignmentTable& t, std::size_t root, double from) {
    for (std::size_t j = 0; j < t.stride; j += Lanes) store(t.distance + j, splat(kInfinity));
    std::size_t row = root;
    double base_here = from;
    std::size_t came_by = 0;
    double length = from;
    for (std::size_t seen = 0;;) {
      t.seen_row[seen] = static_cast<int>(row);
      t.seen_column[seen] = static_cast<int>(came_by);
      t.reach[seen] = length;
      t.base[seen] = base_here;
      ++seen;
      const double* const entries = t.cost + row * t.stride;
      const Real base = splat(base_here);
      Real nearest = splat(kInfinity);
      Real nearest_free = splat(kInfinity);
      for (std::size_t j = 0; j < t.stride; j += Lanes) {
        const Real reduced = load(entries + j) - load(t.price + j);
        const Real through = Longest ? most(base, reduced) : base + reduced;
        const Real distance = least(load(t.distance + j), through);
        store(t.distance + j, distance);
        nearest = least(nearest, distance);
        nearest_free = least(nearest_free, distance + load(t.taken + j));
      }
      length = least_lane(nearest);
      if (length == kInfinity) return {0, seen, length};
      const bool free = least_lane(nearest_free) == length;
      const std::size_t column = first_at(t, length, free);
      if (free) return {column, seen, length};
      row = static_cast<std::size_t>(t.row_of[column]);
      base_here = Longest ? length : length - (t.cost[row * t.stride + column] - t.price[column]);
      came_by = column;
      t.kept_price[seen] = t.price[column];
      t.price[column] = -kInfinity;
      t.distance[column] = kInfinity;
    }
  }

  /// Swaps owners along the path that was found. How it came to a column was not written down: the
  /// first row seen that leads to it at its very distance.
  template <bool Longest>
  static void take_path(const AssignmentTable& t, const Found& found) {
    for (std::size_t s = 1; s < found.seen; ++s) t.price[t.seen_column[s]] = t.kept_price[s];
    std::size_t column = found.sink;
    double distance = found.length;
    while (true) {
      const double price = t.price[column];
      std::size_t s = 0;
      std::size_t row = static_cast<std::size_t>(t.seen_row[0]);
      while (onward<Longest>(t.base[s], t.cost[row * t.stride + column], price) != distance &&
             s + 1 < found.seen) {
        row = static_cast<std::size_t>(t.seen_row[++s]);
      }
      give(t, row, column);
      if (s == 0) return;
      column = static_cast<std::size_t>(t.seen_column[s]);
      distance = t.reach[s];
    }
  }

  static std::size_t list_waiting(const AssignmentTable& t) {
    std::size_t waiting = 0;
    for (std::size_t row = 0; row < t.rows; ++row) {
      if (t.column_of[row] < 0) t.waiting[waiting++] = static_cast<int>(row);
    }
    return waiting;
  }

  /// Jonker and Volgenant 1987: column reduction, then shortest augmenting paths. Their reduction
  /// transfer and augmenting row reduction are left out: with costs of distances the first does not
  /// pay, and in the second rows bid each other down in ever smaller steps. A table with more
  /// columns than rows begins without prices, as columns that stay free must have none. False where
  /// no complete assignment is allowed.
  static bool least_sum(const AssignmentTable& t, const double* row_guess) {
    start(t);
    if (t.rows == t.columns && !reduce_columns(t, row_guess)) return false;
    const std::size_t waiting = list_waiting(t);
    for (std::size_t w = 0; w < waiting; ++w) {
      const Found found = search<false>(t, static_cast<std::size_t>(t.waiting[w]), 0.0);
      if (found.length == kInfinity) return false;
      take_path<false>(t, found);
      for (std::size_t s = 1; s < found.seen; ++s) {
        t.price[t.seen_column[s]] += t.reach[s] - found.length;
      }
    }
    return true;
  }

  /// No threshold below the least entry of any row can do.
  static void lower_by_rows(const AssignmentTable& t, AssignmentThreshold& result) {
    result.threshold = -kInfinity;
    for (std::size_t row = 0; row < t.rows; ++row) {
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
  }

  /// Nor, where every column needs a row, below that of any column.
  static void lower_by_columns(const AssignmentTable& t, AssignmentThreshold& result) {
    double* const least_entry = t.distance;
    for (std::size_t j = 0; j < t.stride; ++j) least_entry[j] = kInfinity;
    for (std::size_t row = 0; row < t.rows; ++row) {
      for (std::size_t j = 0; j < t.stride; j += Lanes) {
        store(least_entry + j, least(load(least_entry + j), load(t.cost + row * t.stride + j)));
      }
    }
    std::size_t lonely = t.columns;
    for (std::size_t j = 0; j < t.columns; ++j) {
      if (least_entry[j] <= result.threshold) continue;
      result.threshold = least_entry[j];
      lonely = j;
    }
    if (lonely == t.columns) return;
    result.rows = 0;
    result.columns = 0;
    for (std::size_t i = 0; i < t.columns; ++i) {
      result.crowded[result.rows++] = static_cast<int>(i);
      if (i != lonely) result.near[result.columns++] = static_cast<int>(i);
    }
  }

  /// Augmenting paths of least largest entry; by Berge's theorem one more row fits within the least
  /// threshold at which such a path exists. Where a path raises the threshold, the rows that the
  /// search had seen below it have no other columns below it than those it came by. The threshold
  /// is infinite where no complete assignment is allowed.
  static void least_largest(const AssignmentTable& t, AssignmentThreshold& result) {
    start(t);
    lower_by_rows(t, result);
    if (t.rows == t.columns) lower_by_columns(t, result);
    if (result.threshold == kInfinity) return;
    for (std::size_t row = 0; row < t.rows; ++row) {
      for (std::size_t j = 0; j < t.columns; ++j) {
        if (t.row_of[j] >= 0 || t.cost[row * t.stride + j] > result.threshold) continue;
        give(t, row, j);
        break;
      }
    }
    const std::size_t waiting = list_waiting(t);
    for (std::size_t w = 0; w < waiting; ++w) {
      const Found found = search<true>(t, static_cast<std::size_t>(t.waiting[w]), result.threshold);
      if (found.length > result.threshold) {
        result.threshold = found.length;
        if (found.length == kInfinity) return;
        result.rows = 0;
        result.columns = 0;
        for (std::size_t s = 0; s < found.seen && t.reach[s] < found.length; ++s) {
          result.crowded[result.rows++] = t.seen_row[s];
          if (s > 0) result.near[result.columns++] = t.seen_column[s];
        }
      }
      take_path<true>(t, found);
    }
  }
};

#if defined(__x86_64__)
bool least_sum_avx2(const AssignmentTable& table, const double* row_guess);
void least_largest_avx2(const AssignmentTable& table, AssignmentThreshold& result);
#endif

}  // namespace skein::planning
