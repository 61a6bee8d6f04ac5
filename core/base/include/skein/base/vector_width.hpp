// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace skein {

/// Code for vectors (vectors.hpp), of which a processor takes what it can.
enum class VectorWidth : std::uint8_t { baseline, avx2 };
/// What this processor can do, narrowest first.
[[nodiscard]] std::span<const VectorWidth> vector_widths();

}  // namespace skein
