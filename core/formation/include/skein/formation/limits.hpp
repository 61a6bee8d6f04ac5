// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/idl/formation.hpp"

namespace skein::formation {

/// By which heights count for more than what is horizontal.
[[nodiscard]] constexpr double height_factor(const Separation& separation) {
  return separation.horizontal_m / separation.vertical_m;
}

}  // namespace skein::formation
