// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "skein/base/ids.hpp"
#include "skein/base/time.hpp"
#include "skein/console/picture.hpp"
#include "skein/groundstation/control_socket.hpp"
#include "skein/mission/fleet.hpp"

namespace skein::groundstation {

/// All that is known of one vehicle, for the prompt, and the section `vehicles` as data. `video`:
/// where its pictures are, by configuration; empty: nowhere.
[[nodiscard]] Answer vehicle_answer(VehicleId vehicle, const console::Picture& picture,
                                    const mission::Fleet& fleet, const std::string& video,
                                    Instant now);

}  // namespace skein::groundstation
