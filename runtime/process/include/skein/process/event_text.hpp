// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "skein/mission/messages.hpp"

namespace skein::process {

/// An event as one line for people: "vehicle 7: task done, site 1 deliver 3 (0.4): text". The
/// number, where the kind has one, means what docs/protocol.md says of the kind.
[[nodiscard]] std::string text_of(const mission::MissionEvent& event);

/// "vehicle 7", or "ground station".
[[nodiscard]] std::string text_of(VehicleId vehicle);

}  // namespace skein::process
