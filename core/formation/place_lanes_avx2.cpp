// SPDX-License-Identifier: Apache-2.0
#include "place_lanes.hpp"

namespace skein::formation {

void place_fill_avx2(const PlaceTable& table, const PlacePoints& rows, const PlacePoints& columns,
                     bool squared) {
  PlaceLanes<4>::fill(table, rows, columns, squared);
}

void place_least_sum_avx2(const PlaceTable& table) { PlaceLanes<4>::least_sum(table); }

void place_least_largest_avx2(const PlaceTable& table, PlaceThreshold& result) {
  PlaceLanes<4>::least_largest(table, result);
}

}  // namespace skein::formation
