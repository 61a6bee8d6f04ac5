// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "skein/base/random.hpp"

namespace skein::routes {

/// Chaotic maps (Wu 2022, table 1), in the order of the table.
enum class ChaoticMap : std::uint8_t {
  logistic,       ///< 4 x (1 - x)
  circle,         ///< x + 0.2 - 0.5 / (2 pi) sin(2 pi x) mod 1
  gauss,          ///< 1 / x mod 1 (mouse map)
  iterative,      ///< sin(0.85 pi / x), on [-1, 1]
  tent,           ///< x / 0.7 below 0.7, else 10/3 (1 - x); printed without the sign
  sinusoidal,     ///< 2.3 x^2 sin(pi x)
  singer,         ///< 1.07 (7.86 x - 23.31 x^2 + 28.75 x^3 - 13.302875 x^4)
  sine,           ///< sin(pi x)
  piecewise,      ///< four lines, bends at 0.3, 0.5 and 0.7
  chebyshev,      ///< cos(4 acos x), on [-1, 1]
  liebovitch,     ///< three lines, bends at 0.3 and 0.8
  intermittency,  ///< 0.1 + x + c x^2 below 0.5, else (x - 0.5) / 0.5
  count
};
[[nodiscard]] std::string_view to_string(ChaoticMap map);

/// A chaotic sequence in [0, 1]. Maps on [-1, 1] are scaled. Where rounding takes a map to a fixed
/// point (a tent or piecewise map loses a bit a step), the generator starts it again.
class ChaoticSequence {
 public:
  ChaoticSequence(ChaoticMap map, Random random);
  [[nodiscard]] double next();
  /// Goes on from x in [0, 1].
  void start_at(double x);

 private:
  void restart();
  ChaoticMap map_;
  Random random_;
  double x_ = 0.0;  ///< in the map's own range
};

}  // namespace skein::routes
