// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#if defined(__x86_64__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

#include "skein/base/vectors.hpp"

namespace skein::planning {

/// Poses as columns; `step` is 1, or 0 where one pose stands for all. cos and sin may be null.
struct DubinsColumns {
  const double* x_m;
  const double* y_m;
  const double* heading_rad;
  const double* cos;
  const double* sin;
  std::size_t step;
};

/// Shortest Dubins lengths of so many pose pairs at once.
/// Additions, multiplications, divisions and square roots only, in one order for every width and
/// without fused operations: the same bits on every processor. Each width is instantiated in one
/// source only, which is compiled for processors that have it; hence no header with code is
/// included.
///
/// In the frame of the start pose, the left-first words (LSL, LSR, LRL) only: the right-first words
/// are those to the mirrored goal. Centres c1 = (0, r) and c2 (Shkel and Lumelsky 2001, without
/// their rotation of both poses).
template <int Lanes>
struct DubinsLanes {
  static constexpr int kLanes = Lanes;
  using Real = typename Vectors<Lanes>::Real;
  using Bits = typename Vectors<Lanes>::Bits;

  static constexpr double kPi = 0x1.921fb54442d18p+1;
  static constexpr double kTwoPi = 2.0 * kPi;
  /// What the end may miss the goal by: so rounding of the input, by which a path of no length
  /// would have to be a full circle, costs none.
  static constexpr double slack_m(double radius_m) {
    constexpr double kOfRadius = 1e-9;
    constexpr double kLeast_m = 2e-10;
    return kOfRadius * radius_m > kLeast_m ? kOfRadius * radius_m : kLeast_m;
  }
  /// Below this the reduction of a heading is exact to the last bits.
  static constexpr double kHeadingMax_rad = 1e5;

  struct SinCos {
    Real sin;
    Real cos;
  };
  /// The goal's position in the frame of the start, and how much it turns, in [-pi, pi].
  struct Goal {
    Real x;
    Real y;
    Real sin;
    Real cos;
    Real versine;  ///< 1 - cos, without cancellation
    Real turn;
  };
  /// c2 - c1 of LSL and LRL.
  struct Centres {
    Real dx;
    Real dy;
    Real distance;
  };

  static Real splat(double value) { return Real{} + value; }
  static Real infinity() { return splat(__builtin_inf()); }
  static Real select(Bits mask, Real yes, Real no) { return mask ? yes : no; }
  static Real least(Real a, Real b) { return select(b < a, b, a); }
  static Real magnitude(Real a) { return Real(Bits(a) & INT64_MAX); }
  /// a with its sign changed where b is negative.
  static Real sign_by(Real a, Real b) { return Real(Bits(a) ^ (Bits(b) & INT64_MIN)); }

  static Real root(Real a) {
#if defined(__AVX512F__)
    if constexpr (kLanes == 8) return Real(_mm512_maskz_sqrt_pd(0xff, __m512d(a)));
#endif
#if defined(__AVX2__)
    if constexpr (kLanes == 4) return Real(_mm256_sqrt_pd(__m256d(a)));
#endif
#if defined(__x86_64__)
    if constexpr (kLanes == 2) return Real(_mm_sqrt_pd(__m128d(a)));
#elif defined(__aarch64__)
    if constexpr (kLanes == 2) return Real(vsqrtq_f64(float64x2_t(a)));
#endif
    for (int i = 0; i < kLanes; ++i) a[i] = __builtin_sqrt(a[i]);
    return a;
  }

  static bool any(Bits mask) {
#if defined(__AVX2__)
    if constexpr (kLanes == 4) return _mm256_movemask_pd(__m256d(mask)) != 0;
#endif
#if defined(__x86_64__)
    if constexpr (kLanes == 2) return _mm_movemask_pd(__m128d(mask)) != 0;
#endif
    std::int64_t all = 0;
    for (int i = 0; i < kLanes; ++i) all |= mask[i];
    return all != 0;
  }

  /// Multiples of pi / 2 taken off in three parts whose products are exact (Cody and Waite 1980),
  /// then the Taylor series, whose next terms are below 5e-17 up to pi / 4.
  [[gnu::always_inline]] static SinCos sin_cos(Real rad) {
    constexpr double kToInteger = 0x1.8p+52;
    const Real shifted = rad * (2.0 / kPi) + kToInteger;
    const Bits quadrant = Bits(shifted);
    const Real n = shifted - kToInteger;
    const Real a = ((rad - n * 0x1.921fb544p+0) - n * 0x1.0b4611a6p-34) - n * 0x1.3198a2e037073p-69;
    const Real z = a * a;
    const Real zz = z * z;
    const Real s_even = ((zz * (1.0 / 6227020800.0) + 1.0 / 362880.0) * zz + 1.0 / 120.0) * zz;
    const Real s_odd =
        ((zz * (-1.0 / 1307674368000.0) - 1.0 / 39916800.0) * zz - 1.0 / 5040.0) * zz - 1.0 / 6.0;
    const Real s = a + a * (s_even + s_odd * z);
    const Real c_even =
        (((zz * (1.0 / 20922789888000.0) + 1.0 / 479001600.0) * zz + 1.0 / 40320.0) * zz +
         1.0 / 24.0) *
        zz;
    const Real c_odd =
        ((zz * (-1.0 / 87178291200.0) - 1.0 / 3628800.0) * zz - 1.0 / 720.0) * zz - 0.5;
    const Real c = 1.0 + (c_even + c_odd * z);
    const Bits odd = (quadrant & 1) != 0;
    const Bits minus_sin = (quadrant & 2) << 62;
    const Bits minus_cos = ((quadrant + 1) & 2) << 62;
    return {Real(Bits(select(odd, c, s)) ^ minus_sin), Real(Bits(select(odd, s, c)) ^ minus_cos)};
  }

  /// In [-pi, pi], within 4e-16; not for the origin. Reduced to |t| <= tan(pi / 8) with one
  /// division; atan(t) / t by interpolation in t^2 at the Chebyshev nodes, within 4e-18.
  [[gnu::always_inline]] static Real angle(Real y, Real x) {
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
    constexpr double kTanEighth = 0.41421356237309503;
    const Real ax = magnitude(x);
    const Real ay = magnitude(y);
    const Bits steep = ay > ax;
    const Real low = select(steep, ax, ay);
    const Real high = select(steep, ay, ax);
    const Bits wide = low > kTanEighth * high;
    const Real t = select(wide, low - high, low) / select(wide, low + high, high);
    const Real z = t * t;
    const Real zz = z * z;
    const Real even = ((((zz * kC10 + kC8) * zz + kC6) * zz + kC4) * zz + kC2) * zz;
    const Real odd = ((((zz * kC11 + kC9) * zz + kC7) * zz + kC5) * zz + kC3) * zz + kC1;
    Real turn = t + t * (even + odd * z);
    turn = turn + select(wide, splat(kPi / 4.0), Real{});
    turn = select(steep, kPi / 2.0 - turn, turn);
    turn = select(x < 0.0, kPi - turn, turn);
    return sign_by(turn, y);
  }

  /// From [-2 pi, 2 pi] to [0, 2 pi); a full circle less what moves the end by no more than the
  /// slack is none at all.
  static Real turn_of(Real rad, Real reach_m, double slack) {
    const Real turn = select(rad < 0.0, rad + kTwoPi, rad);
    return select((kTwoPi - turn) * reach_m < slack, Real{}, turn);
  }

  static Real wrap(Real rad) {
    constexpr double kToInteger = 0x1.8p+52;
    const Real n = (rad * (1.0 / kTwoPi) + kToInteger) - kToInteger;
    return ((rad - n * 0x1.921fb544p+2) - n * 0x1.0b4611a6p-32) - n * 0x1.3198a2e037073p-67;
  }

  [[gnu::always_inline]] static Goal goal_of(Real dx, Real dy, Real turn, const SinCos& from,
                                             const SinCos& to) {
    const Real s = to.sin * from.cos - to.cos * from.sin;
    const Real c = to.cos * from.cos + to.sin * from.sin;
    const Real versine = select(c > 0.0, s * s / (1.0 + c), 1.0 - c);
    return {
        from.cos * dx + from.sin * dy, from.cos * dy - from.sin * dx, s, c, versine, wrap(turn)};
  }
  static Goal mirrored(const Goal& g) { return {g.x, -g.y, -g.sin, g.cos, g.versine, -g.turn}; }

  static Bits is_here(const Goal& g, double r) {
    const double slack = slack_m(r);
    return ((g.x * g.x + g.y * g.y) < slack * slack) & (magnitude(g.turn) * r < slack);
  }

  /// The turns of LSL sum to the goal's turn, and a full circle more where the line's direction is
  /// not passed on the way: signs of products tell, no angle is needed.
  static Real lsl(const Goal& g, double r, Centres& centres) {
    const Real dx = g.x - r * g.sin;
    const Real dy = g.y - r * g.versine;
    const Real line = root(dx * dx + dy * dy);
    const Real from_last = dx * g.sin - dy * g.cos;
    const Real along_last = dx * g.cos + dy * g.sin;
    const Real reach = r + line;
    const double slack = slack_m(r);
    const Real none = slack * line;
    const Bits no_first = (magnitude(dy) * reach <= none) & (dx > 0.0);
    const Bits no_last = (magnitude(from_last) * reach <= none) & (along_last > 0.0);
    const Bits ahead = (dx + along_last) > -line;  // not on the other side of both
    const Bits left = g.turn >= 0.0;
    const Bits between = (dy >= 0.0) & (from_last >= 0.0) & ahead;
    const Bits beyond = (dy < 0.0) & (from_last < 0.0) & ahead;
    const Bits passed = (left & between) | ~(left | beyond) | no_first | no_last | (line <= slack);
    Real turns = select(left, g.turn, g.turn + kTwoPi);
    turns = select(passed, turns, turns + kTwoPi);
    turns = select(no_first & no_last, Real{}, turns);
    centres = {dx, dy, line};
    return line + r * turns;
  }

  /// Infinite where it does not exist.
  static Real lsr(const Goal& g, double r) {
    const Real dx = g.x + r * g.sin;
    const Real dy = (g.y - 2.0 * r) + r * g.versine;
    // |c2 - c1|^2 - 4 r^2, arranged so that near poses do not cancel.
    const Real line_sq = (g.x * g.x + g.y * g.y) +
                         2.0 * r * ((g.x * g.sin - g.y * (2.0 - g.versine)) - r * g.versine);
    const Real line = root(select(line_sq > 0.0, line_sq, Real{}));
    const Real heading = angle(dy * line + 2.0 * r * dx, dx * line - 2.0 * r * dy);
    const double slack = slack_m(r);
    const Real first = turn_of(heading, r + line, slack);
    const Real last = turn_of(heading - g.turn, splat(r), slack);
    const Real length = line + r * (first + last);
    return select(line_sq >= -4.0 * r * slack, length, infinity());
  }

  /// Where a CCC word with the middle arc above a half turn could be shorter than `best`. Its
  /// middle is 2 pi - 2 asin(distance / 4 r), and q <= asin(q) <= q pi / 2; its first and last turn
  /// sum to the goal's turn and the middle, but for full circles.
  static Bits ccc_may_win(Real goal_turn, Real distance, double r, Real best) {
    const Real low = kTwoPi * r - (kPi / 4.0) * distance;
    const Real high = kTwoPi * r - 0.5 * distance;
    const Real turn = r * goal_turn;
    const Real least_sum = turn + low;
    const Real beyond = least_sum - kTwoPi * r;
    // Next to a full circle the slack may take it for none.
    constexpr double kNearFull_rad = 1e-3;
    Real ends = select(turn + high < (kTwoPi - kNearFull_rad) * r, least_sum, beyond);
    ends = select(ends > 0.0, ends, Real{});
    return (distance <= 4.0 * r + slack_m(r)) & (low + ends < best);
  }

  /// LRL. Halfway round the middle arc the heading is that of c2 - c1.
  static Real ccc(Real goal_turn, const Centres& c, double r) {
    const double slack = slack_m(r);
    const Bits apart = c.distance > slack;
    const Real dx = select(apart, c.dx, splat(1.0));
    const Real dy = select(apart, c.dy, Real{});
    const Real rest_sq = 16.0 * r * r - c.distance * c.distance;
    const Real rest = root(select(rest_sq > 0.0, rest_sq, Real{}));
    const Real middle = kTwoPi - 2.0 * angle(c.distance, rest);
    const Real leave = angle(dx * c.distance - dy * rest, -(dx * rest) - dy * c.distance);
    const Real first = turn_of(leave, splat(4.0 * r), slack);
    const Real turned = (goal_turn - leave) + middle;  // from -pi to 4 pi
    const Real last = turn_of(select(turned >= kTwoPi, turned - kTwoPi, turned), splat(r), slack);
    return r * (first + middle + last);
  }

  static Real get(const double* lanes) {
    Real result{};
    __builtin_memcpy(&result, lanes, sizeof result);
    return result;
  }
  static void put(double* lanes, Real value) { __builtin_memcpy(lanes, &value, sizeof value); }
  static Real gather(const double* column, const std::uint32_t* rows) {
    Real result = splat(column[rows[0]]);
    for (int k = 1; k < kLanes; ++k) result[k] = column[rows[k]];
    return result;
  }

  static Real tame(Real heading) {
    if (any(magnitude(heading) > kHeadingMax_rad)) {
      for (int k = 0; k < kLanes; ++k) heading[k] = __builtin_remainder(heading[k], kTwoPi);
    }
    return heading;
  }

  /// The lanes as bits of a number, the first the lowest.
  static unsigned set_of(Bits mask) {
#if defined(__AVX512DQ__)
    if constexpr (kLanes == 8) return _mm512_movepi64_mask(__m512i(mask));
#endif
#if defined(__AVX2__)
    if constexpr (kLanes == 4) return static_cast<unsigned>(_mm256_movemask_pd(__m256d(mask)));
#endif
#if defined(__x86_64__)
    if constexpr (kLanes == 2) return static_cast<unsigned>(_mm_movemask_pd(__m128d(mask)));
#endif
    unsigned set = 0;
    for (int k = 0; k < kLanes; ++k) set |= (mask[k] != 0 ? 1U : 0U) << static_cast<unsigned>(k);
    return set;
  }

  /// Pairs that go through one stage after the other, see below. Sides: to the goal and to the
  /// mirrored one.
  static constexpr std::size_t kBlock = 64;
  // NOLINTBEGIN(modernize-avoid-c-arrays): std::array would be another header.
  using Column = double[kBlock];
  using BothSides = double[2 * kBlock];
  using Candidates = std::uint32_t[2 * kBlock + kLanes];
  // NOLINTEND(modernize-avoid-c-arrays)
  struct alignas(64) Block {
    Column x;
    Column y;
    Column sin;
    Column cos;
    Column versine;
    Column turn;
    Column best;
    BothSides dx;  ///< of the centres, side after side
    BothSides dy;
    BothSides distance;
    Candidates candidates;  ///< pairs, with kBlock added for the mirrored side

    [[nodiscard]] Goal goal(std::size_t i) const {
      return {get(x + i), get(y + i), get(sin + i), get(cos + i), get(versine + i), get(turn + i)};
    }
    void set_goal(std::size_t i, const Goal& goal) {
      put(x + i, goal.x);
      put(y + i, goal.y);
      put(sin + i, goal.sin);
      put(cos + i, goal.cos);
      put(versine + i, goal.versine);
      put(turn + i, goal.turn);
    }
  };

  static Real load(const double* column, std::size_t step, std::size_t i) {
    return step == 0 ? splat(*column) : get(column + i);
  }

  static SinCos trigonometry(const DubinsColumns& poses, Real heading, std::size_t i) {
    if (poses.cos == nullptr) return sin_cos(heading);
    return {load(poses.sin, poses.step, i), load(poses.cos, poses.step, i)};
  }

  /// Of the pairs k, k + 1 ...
  [[gnu::always_inline]] static Goal load_goal(const DubinsColumns& from, const DubinsColumns& to,
                                               std::size_t k) {
    const Real a = tame(load(from.heading_rad, from.step, k));
    const Real b = tame(load(to.heading_rad, to.step, k));
    return goal_of(load(to.x_m, to.step, k) - load(from.x_m, from.step, k),
                   load(to.y_m, to.step, k) - load(from.y_m, from.step, k), b - a,
                   trigonometry(from, a, k), trigonometry(to, b, k));
  }

  /// The last poses, fewer than the lanes; the first of them stands in the lanes that are left.
  struct LastPoses {
    Column x;
    Column y;
    Column heading;
    Column cos;
    Column sin;

    DubinsColumns take(const DubinsColumns& poses, std::size_t k, std::size_t count) {
      if (poses.step == 0) return poses;
      const bool cached = poses.cos != nullptr;
      for (std::size_t i = 0; i < kLanes; ++i) {
        const std::size_t at = i < count ? k + i : k;
        x[i] = poses.x_m[at];
        y[i] = poses.y_m[at];
        heading[i] = poses.heading_rad[at];
        cos[i] = cached ? poses.cos[at] : 0.0;
        sin[i] = cached ? poses.sin[at] : 0.0;
      }
      return {x, y, heading, cached ? cos : nullptr, cached ? sin : nullptr, 1};
    }
  };

  static void make_goals(const DubinsColumns& from, const DubinsColumns& to, std::size_t begin,
                         std::size_t end, Block& block) {
    std::size_t i = 0;
    for (; i + kLanes <= end; i += kLanes) block.set_goal(i, load_goal(from, to, begin + i));
    if (i == end) return;
    // NOLINTBEGIN(cppcoreguidelines-pro-type-member-init): filled as far as they are read.
    LastPoses a;
    LastPoses b;
    // NOLINTEND(cppcoreguidelines-pro-type-member-init)
    block.set_goal(i,
                   load_goal(a.take(from, begin + i, end - i), b.take(to, begin + i, end - i), 0));
  }

  static void try_same(double r, std::size_t end, Block& block) {
    for (std::size_t i = 0; i < end; i += kLanes) {
      const Goal goal = block.goal(i);
      Real best = infinity();
      for (std::size_t side = 0; side < 2; ++side) {
        Centres centres{};
        best = least(best, lsl(side == 0 ? goal : mirrored(goal), r, centres));
        put(block.dx + side * kBlock + i, centres.dx);
        put(block.dy + side * kBlock + i, centres.dy);
        put(block.distance + side * kBlock + i, centres.distance);
      }
      put(block.best + i, best);
    }
  }

  static void try_other(double r, std::size_t end, Block& block) {
    for (std::size_t i = 0; i < end; i += kLanes) {
      const Goal goal = block.goal(i);
      const Real best = least(lsr(goal, r), lsr(mirrored(goal), r));
      put(block.best + i, least(get(block.best + i), best));
    }
  }

  /// Few can: they are collected, so that no lane is idle.
  static std::size_t collect_ccc(double r, std::size_t end, Block& block) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < end; i += kLanes) {
      const Real best = get(block.best + i);
      const Real turn = get(block.turn + i);
      for (std::size_t side = 0; side < 2; ++side) {
        const std::size_t first = side * kBlock + i;
        const unsigned set =
            set_of(ccc_may_win(side == 0 ? turn : -turn, get(block.distance + first), r, best));
        for (unsigned k = 0; k < kLanes; ++k) {
          block.candidates[count] = static_cast<std::uint32_t>(first) + k;
          count += (set >> k) & 1U;
        }
      }
    }
    return count;
  }

  static void try_ccc(double r, std::size_t count, Block& block) {
    for (unsigned k = 0; k < kLanes; ++k) block.candidates[count + k] = block.candidates[0];
    for (std::size_t c = 0; c < count; c += kLanes) {
      const std::uint32_t* first = block.candidates + c;
      const Centres centres{gather(block.dx, first), gather(block.dy, first),
                            gather(block.distance, first)};
      const auto turn_of_side = [&](int k) {
        const double turn = block.turn[first[k] % kBlock];
        return first[k] < kBlock ? turn : -turn;
      };
      Real turn = splat(turn_of_side(0));
      for (int k = 1; k < kLanes; ++k) turn[k] = turn_of_side(k);
      const Real length = ccc(turn, centres, r);
      for (int k = 0; k < kLanes; ++k) {
        double& best = block.best[first[k] % kBlock];
        best = length[k] < best ? length[k] : best;
      }
    }
  }

  /// Block by block, and each stage for a whole block: short loops, in which the processor works at
  /// several rounds at once, as it cannot at the long chain of roots, quotients and angles of one.
  static void lengths(const DubinsColumns& from, const DubinsColumns& to, std::size_t count,
                      double radius_m, double* lengths_m) {
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): filled as far as it is read.
    Block block;
    for (std::size_t begin = 0; begin < count; begin += kBlock) {
      const std::size_t end = count - begin < kBlock ? count - begin : kBlock;
      make_goals(from, to, begin, end, block);
      try_same(radius_m, end, block);
      try_other(radius_m, end, block);
      const std::size_t candidates = collect_ccc(radius_m, end, block);
      if (candidates > 0) try_ccc(radius_m, candidates, block);
      for (std::size_t i = 0; i < end; i += kLanes) {
        const Real length = select(is_here(block.goal(i), radius_m), Real{}, get(block.best + i));
        put(block.best + i, length);
      }
      __builtin_memcpy(lengths_m + begin, block.best, sizeof(double) * end);
    }
  }
};

#if defined(__x86_64__)
void dubins_lengths_avx2(const DubinsColumns& from, const DubinsColumns& to, std::size_t count,
                         double radius_m, double* lengths_m);
void dubins_lengths_avx512(const DubinsColumns& from, const DubinsColumns& to, std::size_t count,
                           double radius_m, double* lengths_m);
#endif

}  // namespace skein::planning
