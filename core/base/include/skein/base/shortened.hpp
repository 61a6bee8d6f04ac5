// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

namespace skein {

/// The vector itself where it is no longer than that, else one of that length in its direction.
template <int N>
[[nodiscard]] Eigen::Matrix<double, N, 1> shortened(const Eigen::Matrix<double, N, 1>& v,
                                                    double length_max) {
  const double length = v.norm();
  if (length > length_max) return v * (length_max / length);
  return v;
}

}  // namespace skein
