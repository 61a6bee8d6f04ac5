// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

namespace skein {

/// True airspeed per equivalent airspeed in the standard atmosphere: the root of the density at the
/// sea over that at the height (ISO 2533, troposphere; T0 288.15 K, 6.5 K/km, exponent of density
/// g / (R L) - 1 = 4.2559). Heights in m above the sea, limited to where that law holds.
/// A pitot tube, and autopilots with it, know the equivalent one; paths are flown by the true one.
[[nodiscard]] inline double true_per_equivalent_airspeed(double above_sea_m) {
  constexpr double kLapse_per_m = 0.0065 / 288.15;
  constexpr double kDensityExponent = 4.2559;
  const double height = std::clamp(above_sea_m, -1000.0, 11000.0);
  return std::pow(1.0 - kLapse_per_m * height, -0.5 * kDensityExponent);
}

}  // namespace skein
