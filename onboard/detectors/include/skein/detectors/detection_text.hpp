// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

#include "skein/base/frames.hpp"
#include "skein/base/result.hpp"
#include "skein/mission/messages.hpp"

namespace skein::detectors {

inline constexpr std::size_t kTextMax = 1024;  ///< of one detection, in bytes
inline constexpr double kPlaceMax_m = 1e5;     ///< from the mission's origin, to each side

/// What a detector has written: a JSON object (docs/detections.md). Any text is safe; fails with
/// what is wrong.
[[nodiscard]] Result<mission::Detection> read_detection(std::string_view text,
                                                        const MissionOrigin& origin);

}  // namespace skein::detectors
