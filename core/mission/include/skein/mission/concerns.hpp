// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/base/ids.hpp"
#include "skein/mission/messages.hpp"

namespace skein::mission {

/// Whether that vehicle decides on anything by it. What members tell their leader is heard by all,
/// and is most of what is signed: to verify what is for others costs a vehicle of a large team
/// more than all that it flies by. What it never acts on (skein/coalition, skein/mission) is false,
/// though another leader could take from it that its sender is alive; where in doubt, true.
[[nodiscard]] bool concerns(const Message& message, VehicleId vehicle);

}  // namespace skein::mission
