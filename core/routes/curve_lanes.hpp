// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

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
  const int* kind;      ///< 0 detection, 1 ramp, 2 keep-out
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
  double* dx;  ///< legs
  double* dy;
  double* turn;
};

struct CurveSums {
  double exposure;  ///< over samples and hazards
  double length;
  double turning;  ///< absolute differences of successive turns
};

template <int Lanes>
struct CurveVectors;
template <>
struct CurveVectors<2> {
  using Real = double __attribute__((vector_size(16)));
  using Bits = decltype(Real{} < Real{});
};
template <>
struct CurveVectors<4> {
  using Real = double __attribute__((vector_size(32)));
  using Bits = decltype(Real{} < Real{});
};

/// Length, turning and exposure of a sampled curve. Additions, multiplications, divisions and
/// square roots in one order, without fused operations: the same bits with every width. Each width
/// is instantiated in one source only, which is compiled for processors that have it; hence no
/// other header is included.
template <int Lanes>
struct CurveLanes {
  using Real = typename CurveVectors<Lanes>::Real;
  using Bits = typename CurveVectors<Lanes>::Bits;
  static constexpr std::size_t kParts = kCurveBlock / Lanes;

  static Real splat(double value) { return Real{} + value; }
  static Real load(const double* from) {
    Real result{};
    __builtin_memcpy(&result, from, sizeof result);
    return result;
  }
  static void store(double* to, Real value) { __builtin_memcpy(to, &value, sizeof value); }
  static Real select(Bits mask, Real yes, Real no) { return mask ? yes : no; }
  static Real magnitude(Real a) { return Real(Bits(a) & INT64_MAX); }
  static Real sign_by(Real a, Real b) { return Real(Bits(a) ^ (Bits(b) & INT64_MIN)); }
  static Real root(Real a) {
#if defined(__AVX2__)
    if constexpr (Lanes == 4) return Real(_mm256_sqrt_pd(__m256d(a)));
#endif
#if defined(__x86_64__)
    if constexpr (Lanes == 2) return Real(_mm_sqrt_pd(__m128d(a)));
#endif
    for (int i = 0; i < Lanes; ++i) a[i] = __builtin_sqrt(a[i]);
    return a;
  }
  static bool any(Bits mask) {
#if defined(__AVX2__)
    if constexpr (Lanes == 4) return _mm256_movemask_pd(__m256d(mask)) != 0;
#endif
#if defined(__x86_64__)
    if constexpr (Lanes == 2) return _mm_movemask_pd(__m128d(mask)) != 0;
#endif
    std::int64_t all = 0;
    for (int i = 0; i < Lanes; ++i) all |= mask[i];
    return all != 0;
  }

  /// kCurveBlock partial sums.
  struct Sum {
    Real part[kParts] = {};  // NOLINT(modernize-avoid-c-arrays): no header but intrinsics here

    [[nodiscard]] double total() const {
      double all[kCurveBlock];  // NOLINT(modernize-avoid-c-arrays,cppcoreguidelines-*)
      for (std::size_t p = 0; p < kParts; ++p) store(all + p * Lanes, part[p]);
      return ((all[0] + all[4]) + (all[2] + all[6])) + ((all[1] + all[5]) + (all[3] + all[7]));
    }
  };

  /// atan t for |t| <= tan(pi / 8): interpolation of atan(t) / t in t^2 at the Chebyshev nodes,
  /// within 4e-18.
  static Real small_angle(Real t) {
    constexpr double kC1 = -0.3333333333333312;
    constexpr double kC2 = 0.19999999999940893;
    constexpr double kC3 = -0.14285714279250245;
    constexpr double kC4 = 0.11111110744919658;
    constexpr double kC5 = -0.09090896809064027;
    constexpr double kC6 = 0.07692045330902225;
    constexpr double kC7 = -0.06662951813629191;
    constexpr double kC8 = 0.05846878297330872;
    constexpr double kC9 = -0.05035102456601552;
    constexpr double kC10 = 0.03796525745386593;
    constexpr double kC11 = -0.017805397205419446;
    const Real z = t * t;
    const Real zz = z * z;
    const Real even = ((((zz * kC10 + kC8) * zz + kC6) * zz + kC4) * zz + kC2) * zz;
    const Real odd = ((((zz * kC11 + kC9) * zz + kC7) * zz + kC5) * zz + kC3) * zz + kC1;
    return t + t * (even + odd * z);
  }

  /// atan2, 0 at the origin. Turns of a smooth curve are small: the rest is done only where a lane
  /// needs it, and gives the others the same bits.
  static Real angle(Real y, Real x) {
    constexpr double kPi = 0x1.921fb54442d18p+1;
    constexpr double kTanEighth = 0.41421356237309503;
    const Real ay = magnitude(y);
    if (!any(ay > kTanEighth * x)) {
      return small_angle(y / select(x == 0.0, splat(1.0), x));
    }
    const Real ax = magnitude(x);
    const Bits steep = ay > ax;
    const Real low = select(steep, ax, ay);
    const Real high = select(steep, ay, ax);
    const Bits wide = low > kTanEighth * high;
    const Real below = select(wide, low + high, high);
    Real turn =
        small_angle(select(wide, low - high, low) / select(below == 0.0, splat(1.0), below));
    turn = turn + select(wide, splat(kPi / 4.0), Real{});
    turn = select(steep, kPi / 2.0 - turn, turn);
    turn = select(x < 0.0, kPi - turn, turn);
    return sign_by(turn, y);
  }

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
        store(t.dx + k, dx);
        store(t.dy + k, dy);
        sum.part[p] = sum.part[p] + length;
        most = select(most < length, length, most);
      }
    }
    longest = 0.0;
    for (int i = 0; i < Lanes; ++i) longest = most[i] > longest ? most[i] : longest;
    return sum.total();
  }

  static double turning(const CurveTable& t) {
    for (std::size_t k = 0; k < t.stride; k += Lanes) {
      const Real ax = load(t.dx + k);
      const Real ay = load(t.dy + k);
      const Real bx = load(t.dx + k + 1);
      const Real by = load(t.dy + k + 1);
      store(t.turn + k, angle(ax * by - ay * bx, ax * bx + ay * by));
    }
    pad(t.turn, t.samples - 2, t.stride);
    Sum sum;
    for (std::size_t block = 0; block < t.stride; block += kCurveBlock) {
      for (std::size_t p = 0; p < kParts; ++p) {
        const double* const at = t.turn + block + p * Lanes;
        sum.part[p] = sum.part[p] + magnitude(load(at + 1) - load(at));
      }
    }
    return sum.total();
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
    for (std::size_t i = 0; i < h.count; ++i) {
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
          sum.part[p] = sum.part[p] + load(t.mask + k) * value(h, i, root(dx * dx + dy * dy));
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
    sums.turning = turning(t);
    sums.exposure = exposure(t, h, longest);
  }
};

#if defined(__x86_64__)
void curve_evaluate_avx2(const CurveTable& table, const CurveHazards& hazards, const double* x,
                         const double* y, CurveSums& sums);
#endif

}  // namespace skein::routes
