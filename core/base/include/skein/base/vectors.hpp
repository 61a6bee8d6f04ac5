// SPDX-License-Identifier: Apache-2.0
#pragma once

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace skein {

/// Vectors of the compiler (GCC, Clang): numbers, and what their comparison gives.
template <int Lanes>
struct Vectors;
template <>
struct Vectors<2> {
  using Real = double __attribute__((vector_size(16)));
  using Bits = decltype(Real{} < Real{});
};
template <>
struct Vectors<4> {
  using Real = double __attribute__((vector_size(32)));
  using Bits = decltype(Real{} < Real{});
};
template <>
struct Vectors<8> {
  using Real = double __attribute__((vector_size(64)));
  using Bits = decltype(Real{} < Real{});
};

/// What is done lane by lane, the same bits with every width. A source that is compiled for some
/// processors must not hold code that others link to: all of this is inlined, whatever is asked of
/// the compiler.
template <int Lanes>
struct VectorOps {
  using Real = typename Vectors<Lanes>::Real;

  [[gnu::always_inline]] static Real splat(double value) { return Real{} + value; }
  [[gnu::always_inline]] static Real load(const double* from) {
    Real result{};
    __builtin_memcpy(&result, from, sizeof result);
    return result;
  }
  [[gnu::always_inline]] static void store(double* to, Real value) {
    __builtin_memcpy(to, &value, sizeof value);
  }
  [[gnu::always_inline]] static Real root(Real a) {
#if defined(__AVX2__)
    if constexpr (Lanes == 4) return Real(_mm256_sqrt_pd(__m256d(a)));
#endif
#if defined(__x86_64__)
    if constexpr (Lanes == 2) return Real(_mm_sqrt_pd(__m128d(a)));
#endif
    for (int i = 0; i < Lanes; ++i) a[i] = __builtin_sqrt(a[i]);
    return a;
  }
};

}  // namespace skein
