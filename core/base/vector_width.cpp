// SPDX-License-Identifier: Apache-2.0
#include "skein/base/vector_width.hpp"

#include <array>
#include <cstddef>

namespace skein {

std::span<const VectorWidth> vector_widths() {
  static constexpr std::array kWidths = {VectorWidth::baseline, VectorWidth::avx2};
#if defined(__x86_64__)
  static const std::size_t count = __builtin_cpu_supports("avx2") ? 2 : 1;
#else
  static const std::size_t count = 1;
#endif
  return {kWidths.data(), count};
}

}  // namespace skein
