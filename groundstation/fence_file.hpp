// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "skein/base/frames.hpp"
#include "skein/base/geometry.hpp"
#include "skein/base/result.hpp"

namespace skein::groundstation {

/// The corners of the one polygon of a text of GeoJSON (RFC 7946: longitude before latitude) or of
/// a plan of QGroundControl (geoFence.polygons), in the mission frame. Any text is safe. Fails
/// where there is none or more than one, where it has holes, and where a corner is no place.
[[nodiscard]] Result<std::vector<Vec2>> fence_in(std::string_view text,
                                                 const MissionOrigin& origin);
[[nodiscard]] Result<std::vector<Vec2>> load_fence(const std::string& file,
                                                   const MissionOrigin& origin);

}  // namespace skein::groundstation
