// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/base/ids.hpp"
#include "skein/mission/messages.hpp"

namespace skein::mission {

/// The number of a node that stands for sensors: it tells of sites and hazards, and of nothing
/// else.
inline constexpr VehicleId kSensors{255};

/// Whether the message is its sender's to say: a vehicle speaks for itself, a leader for its
/// rounds, the ground station for the operator. It also passes on what leaders announce and renew,
/// for those who do not hear them. What is not the sender's to say is to be dropped where it is
/// decided on.
[[nodiscard]] bool may_say(const Message& message, VehicleId sender);

/// Whether it is a decision, by which others fly: where a team has keys its sender signs it, and
/// who is not shown that is not followed (network::SignConfig).
[[nodiscard]] bool is_signed(const Message& message);

}  // namespace skein::mission
