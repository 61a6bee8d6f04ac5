// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "skein/base/geometry.hpp"

namespace skein::planning {

/// Poses as columns (structure of arrays), of equal size. `cos` and `sin` of the headings are empty
/// where they have not been computed before.
struct PoseColumns {
  std::span<const double> x_m;
  std::span<const double> y_m;
  std::span<const double> heading_rad;
  std::span<const double> cos;
  std::span<const double> sin;
};

/// Poses that are asked about more than once: keeps the trigonometry of their headings.
class PoseBatch {
 public:
  void push_back(const Pose2& pose);
  void clear();
  void reserve(std::size_t poses);
  [[nodiscard]] std::size_t size() const { return x_m_.size(); }
  [[nodiscard]] PoseColumns columns() const { return {x_m_, y_m_, heading_rad_, cos_, sin_}; }

 private:
  std::vector<double> x_m_;
  std::vector<double> y_m_;
  std::vector<double> heading_rad_;
  std::vector<double> cos_;
  std::vector<double> sin_;
};

/// The instruction sets that the lengths are computed with; `baseline` is what every processor of
/// the architecture has.
enum class SimdLevel : std::uint8_t { baseline, avx2, avx512 };
/// Those of this processor, the fastest last.
[[nodiscard]] std::span<const SimdLevel> simd_levels();

/// lengths_m[i] = shortest_dubins_length(from[i], to[i], radius_m), to the last bit, at every level
/// and for any number of pairs. A side of one pose stands for all pairs. Radius > 0.
/// Preconditions: each side has one pose or lengths_m.size() poses; this processor has `level`.
void shortest_dubins_lengths(const PoseColumns& from, const PoseColumns& to, double radius_m,
                             std::span<double> lengths_m);
void shortest_dubins_lengths(const PoseColumns& from, const PoseColumns& to, double radius_m,
                             std::span<double> lengths_m, SimdLevel level);

}  // namespace skein::planning
