// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace skein {

/// Vectors of the compiler (GCC, Clang): numbers, and what their comparison gives. Types only: a
/// source that is compiled for some processors must not hold code that others link to.
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

}  // namespace skein
