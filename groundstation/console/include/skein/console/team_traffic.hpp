// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "skein/console/picture.hpp"
#include "skein/mission/fleet.hpp"

namespace skein::console {

/// The section `traffic` of docs/console-socket.md: aircraft that are not of the team, where they
/// are now, the nearest first.
[[nodiscard]] std::string traffic_json(const Picture& picture, const mission::Fleet& fleet,
                                       Instant now);
/// The same for people, a line each.
[[nodiscard]] std::string traffic_text(const Picture& picture, const mission::Fleet& fleet,
                                       Instant now);

}  // namespace skein::console
