// SPDX-License-Identifier: Apache-2.0
#include "dubins_lanes.hpp"

namespace skein::planning {

void dubins_lengths_avx512(const DubinsColumns& from, const DubinsColumns& to, std::size_t count,
                           double radius_m, double* lengths_m) {
  DubinsLanes<8>::lengths(from, to, count, radius_m, lengths_m);
}

}  // namespace skein::planning
