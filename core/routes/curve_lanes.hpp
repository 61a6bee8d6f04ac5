// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "skein/base/vectors.hpp"

namespace skein::routes {

/// Samples are padded to a multiple of this, and so many partial sums are kept: one order of
/// additions for every width.
inline constexpr std::size_t kCurveBlock = 8;

/// Hazards of one kind each, column by column.
struct CurveHazards {
  std::size_t count;
  const double* x;
  const double* y;
  const double* radius;
  const double* inner;
  const double* peak;
  const double* slope;  ///< of a ramp: peak / (radius - inner)
  const int* kind;      ///< 0 detection, 1 ramp, 2 keep-out that costs, 3 keep-out that bars
};

/// A curve and the memory to evaluate it. Columns have `stride` + kCurveBlock entries.
struct CurveTable {
  std::size_t samples;
  std::size_t stride;     ///< samples, rounded up to kCurveBlock
  std::size_t waypoints;  ///< free ones
  const double* basis;    ///< a column for each free waypoint: its share of every sample
  const double* base_x;   ///< what the ends add
  const double* base_y;
  const double* mask;  ///< 1, and 0 in the padding
  double* x;
  double* y;
  /// From each sample to the next, with kCurveBlock zeros before them; null: of no concern.
  double* leg;
  double* weight;  ///< of each sample, by the legs beside it; null: the mask is
};

struct CurveSums {
  double exposure;  ///< over samples and hazards, weighted
  double length;
  double entered;  ///< metres, over the legs and the keep-outs that bar: how deep they are in them
};

/// Length and exposure of a sampled curve. Additions, multiplications, divisions and
/// square roots in one order, without fused operations: the same bits with every width. Each width
/// is instantiated in one source only, which is compiled for processors that have it; hence no
/// header with code is included.
template <int Lanes>
struct CurveLanes : VectorOps<Lanes> {
  using Real = typename Vectors<Lanes>::Real;
  using Bits = typename Vectors<Lanes>::Bits;
  static constexpr std::size_t kParts = kCurveBlock / Lanes;

  using VectorOps<Lanes>::splat;
  using VectorOps<Lanes>::load;
  using VectorOps<Lanes>::store;
  using VectorOps<Lanes>::root;
  static Real select(Bits mask, Real yes, Real no) { return mask ? yes : no; }
  /// kCurveBlock partial sums.
  struct Sum {
    Real part[kParts] = {};  // NOLINT(modernize-avoid-c-arrays): no header but intrinsics here

    [[nodiscard]] double total() const {
      double all[kCurveBlock];  // NOLINT(modernize-avoid-c-arrays,cppcoreguidelines-*)
      for (std::size_t p = 0; p < kParts; ++p) store(all + p * Lanes, part[p]);
      return ((all[0] + all[4]) + (all[2] + all[6])) + ((all[1] + all[5]) + (all[3] + all[7]));
    }
  };

  static void place(const CurveTable& t, const double* base, const double* weights, double* to) {
    for (std::size_t k = 0; k < t.stride; k += Lanes) {
      Real sum = load(base + k);
      const double* column = t.basis + k;
      for (std::size_t j = 0; j < t.waypoints; ++j) {
        sum = sum + weights[j] * load(column);
        column += t.stride + kCurveBlock;
      }
      store(to + k, sum);
    }
    pad(to, t.samples, t.stride);
  }

  /// What lies behind the last entry is as the last.
  static void pad(double* column, std::size_t count, std::size_t stride) {
    for (std::size_t k = count; k < stride + kCurveBlock; ++k) column[k] = column[count - 1];
  }

  static double legs(const CurveTable& t, double& longest) {
    Sum sum;
    Real most = Real{};
    for (std::size_t block = 0; block < t.stride; block += kCurveBlock) {
      for (std::size_t p = 0; p < kParts; ++p) {
        const std::size_t k = block + p * Lanes;
        const Real dx = load(t.x + k + 1) - load(t.x + k);
        const Real dy = load(t.y + k + 1) - load(t.y + k);
        const Real length = root(dx * dx + dy * dy);
        sum.part[p] = sum.part[p] + length;
        if (t.leg != nullptr) store(t.leg + kCurveBlock + k, length);
        most = select(most < length, length, most);
      }
    }
    longest = 0.0;
    for (int i = 0; i < Lanes; ++i) longest = most[i] > longest ? most[i] : longest;
    return sum.total();
  }

  /// Half of the legs on both sides of each sample.
  static void weigh(const CurveTable& t) {
    for (std::size_t k = 0; k < t.stride; k += Lanes) {
      const double* const leg = t.leg + kCurveBlock + k;
      store(t.weight + k, 0.5 * (load(leg - 1) + load(leg)));
    }
  }

  static double least(double a, double b) { return b < a ? b : a; }
  static double most(double a, double b) { return a < b ? b : a; }

  /// How deep the leg after a sample comes into the hazard, with twice what the curve may bulge
  /// beyond it: an eighth of its second difference.
  static double depth(const CurveTable& t, const CurveHazards& h, std::size_t i, std::size_t k) {
    return most(inside(t, h, i, k), 0.0);
  }
  /// The same; less than 0 where it passes outside.
  static double inside(const CurveTable& t, const CurveHazards& h, std::size_t i, std::size_t k) {
    const double dx = t.x[k + 1] - t.x[k];
    const double dy = t.y[k + 1] - t.y[k];
    const double cx = h.x[i] - t.x[k];
    const double cy = h.y[i] - t.y[k];
    const double length_sq = dx * dx + dy * dy;
    const double along = length_sq > 0.0 ? (cx * dx + cy * dy) / length_sq : 0.0;
    const double share = least(most(along, 0.0), 1.0);
    const double ox = cx - share * dx;
    const double oy = cy - share * dy;
    const bool first = k == 0;
    const bool last = k + 2 >= t.samples;
    const double bx = (last ? dx : t.x[k + 2] - t.x[k + 1]) - (first ? dx : t.x[k] - t.x[k - 1]);
    const double by = (last ? dy : t.y[k + 2] - t.y[k + 1]) - (first ? dy : t.y[k] - t.y[k - 1]);
    const double bulge = 0.125 * __builtin_sqrt(bx * bx + by * by);
    return h.radius[i] + bulge - __builtin_sqrt(ox * ox + oy * oy);
  }

  static double entered(const CurveTable& t, const CurveHazards& h, double longest) {
    constexpr std::size_t kMiddle = kCurveBlock / 2;
    double sum = 0.0;
    for (std::size_t i = 0; i < h.count; ++i) {
      if (h.kind[i] != 3) continue;
      const double near = h.radius[i] + longest * static_cast<double>(kMiddle + 2);
      for (std::size_t block = 0; block + 1 < t.samples; block += kCurveBlock) {
        const double mx = t.x[block + kMiddle] - h.x[i];
        const double my = t.y[block + kMiddle] - h.y[i];
        if (mx * mx + my * my > near * near) continue;
        const std::size_t end =
            block + kCurveBlock < t.samples ? block + kCurveBlock : t.samples - 1;
        for (std::size_t k = block; k < end; ++k) sum += depth(t, h, i, k);
      }
    }
    return sum;
  }

  static Real value(const CurveHazards& h, std::size_t i, Real distance) {
    const Bits inside = distance < h.radius[i];
    const Bits within = distance <= h.inner[i];
    switch (h.kind[i]) {
      case 0:
        return select(within, splat(1.0), select(inside, h.inner[i] / distance, Real{}));
      case 1:
        return select(within, splat(h.peak[i]),
                      select(inside, h.slope[i] * (h.radius[i] - distance), Real{}));
      default:
        return select(inside, splat(h.peak[i]), Real{});
    }
  }

  /// Blocks of samples are passed over whose middle is too far away for any of them to be in the
  /// hazard.
  static double exposure(const CurveTable& t, const CurveHazards& h, double longest) {
    constexpr std::size_t kMiddle = kCurveBlock / 2;
    const double reach = longest * static_cast<double>(kMiddle);
    Sum sum;
    const double* const weight = t.weight != nullptr ? t.weight : t.mask;
    for (std::size_t i = 0; i < h.count; ++i) {
      if (h.kind[i] == 3) continue;
      const double x = h.x[i];
      const double y = h.y[i];
      const double near = h.radius[i] + reach;
      const double near_sq = near * near;
      for (std::size_t block = 0; block < t.stride; block += kCurveBlock) {
        const double mx = t.x[block + kMiddle] - x;
        const double my = t.y[block + kMiddle] - y;
        if (mx * mx + my * my > near_sq) continue;
        for (std::size_t p = 0; p < kParts; ++p) {
          const std::size_t k = block + p * Lanes;
          const Real dx = load(t.x + k) - x;
          const Real dy = load(t.y + k) - y;
          sum.part[p] = sum.part[p] + load(weight + k) * value(h, i, root(dx * dx + dy * dy));
        }
      }
    }
    return sum.total();
  }

  /// `x`: null where the curve's x are the base's (lateral offsets).
  static void evaluate(const CurveTable& t, const CurveHazards& h, const double* x, const double* y,
                       CurveSums& sums) {
    if (x != nullptr) place(t, t.base_x, x, t.x);
    place(t, t.base_y, y, t.y);
    double longest = 0.0;
    sums.length = legs(t, longest);
    if (t.weight != nullptr) weigh(t);
    sums.exposure = exposure(t, h, longest);
    sums.entered = entered(t, h, longest);
  }
};

#if defined(__x86_64__)
void curve_evaluate_avx2(const CurveTable& table, const CurveHazards& hazards, const double* x,
                         const double* y, CurveSums& sums);
#endif

}  // namespace skein::routes
