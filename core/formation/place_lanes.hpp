// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "skein/base/vectors.hpp"

namespace skein::formation {

/// Vehicles or places, column by column and padded. The padding of places has x = +infinity, so
/// that their costs are infinite.
struct PlacePoints {
  const double* x;
  const double* y;
  const double* z;
};

/// Costs of `count` vehicles, row by row; each row has `stride` entries, a multiple of 8.
struct PlaceTable {
  std::size_t count;
  std::size_t stride;
  double* cost;
};

/// Lengths of legs, or their squares: the same bits with every width. Each width is instantiated in
/// one source only, which is compiled for processors that have it; hence no header with code is
/// included.
template <int Lanes>
struct PlaceLanes : VectorOps<Lanes> {
  using Real = typename Vectors<Lanes>::Real;

  using VectorOps<Lanes>::splat;
  using VectorOps<Lanes>::load;
  using VectorOps<Lanes>::root;

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
        const Real entry = squared ? sum : root(sum);
        __builtin_memcpy(entries + j, &entry, sizeof entry);
      }
    }
  }
};

#if defined(__x86_64__)
void place_fill_avx2(const PlaceTable& table, const PlacePoints& rows, const PlacePoints& columns,
                     bool squared);
#endif

}  // namespace skein::formation
