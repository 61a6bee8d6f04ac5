// SPDX-License-Identifier: Apache-2.0
#include "place_lanes.hpp"

namespace skein::formation {

void place_fill_avx2(const PlaceTable& table, const PlacePoints& rows, const PlacePoints& columns,
                     bool squared) {
  PlaceLanes<4>::fill(table, rows, columns, squared);
}

}  // namespace skein::formation
