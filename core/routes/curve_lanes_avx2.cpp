// SPDX-License-Identifier: Apache-2.0
#include "curve_lanes.hpp"

namespace skein::routes {

void curve_evaluate_avx2(const CurveTable& table, const CurveHazards& hazards, const double* x,
                         const double* y, CurveSums& sums) {
  CurveLanes<4>::evaluate(table, hazards, x, y, sums);
}

}  // namespace skein::routes
