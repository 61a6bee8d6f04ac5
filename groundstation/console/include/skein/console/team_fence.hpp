// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "skein/base/ids.hpp"
#include "skein/console/picture.hpp"
#include "skein/domain/fence.hpp"
#include "skein/mission/fleet.hpp"

/// The fence of the team, and who keeps it by his own word (Health::fence).
namespace skein::console {

enum class Keeps : std::uint8_t { this_one, another, none, not_known, count };
[[nodiscard]] std::string_view to_string(Keeps keeps);
/// "keeps another one"
[[nodiscard]] std::string_view words_of(Keeps keeps);

/// Of all that are expected or heard; not known of who is silent.
[[nodiscard]] std::map<VehicleId, Keeps> fence_keepers(const Fence& fence,
                                                       const mission::Fleet& fleet);

/// What vehicles do at its edge.
inline constexpr std::string_view kFenceAction =
    "a vehicle that leaves it, or would within 8 s, flies home; its autopilot has it too";

/// "4 corners, 0.63 km2, up to 100 m"
[[nodiscard]] std::string fence_size(const Fence& fence);
/// Its corners, and who keeps it.
[[nodiscard]] std::string fence_text(const Picture& picture, const mission::Fleet& fleet);
/// The section `fence` as JSON; null where there is none.
[[nodiscard]] std::string fence_json(const Picture& picture, const mission::Fleet& fleet);

}  // namespace skein::console
