// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "skein/base/attitude.hpp"
#include "skein/base/result.hpp"

namespace skein::formation {

/// As many places as vehicles, and coordinates within kPlaceCoordinateMax_m.
[[nodiscard]] Result<void> check_places(std::span<const Vec3> vehicles,
                                        std::span<const Vec3> places);

}  // namespace skein::formation
