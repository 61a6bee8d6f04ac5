// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "skein/base/time.hpp"
#include "skein/groundstation/control_socket.hpp"
#include "skein/groundstation/orders.hpp"
#include "skein/mission/ground_agent.hpp"

/// What becomes of an operator's decision on deliveries, in words for whoever has decided.
namespace skein::groundstation {

/// The answer says what was passed over.
[[nodiscard]] Answer decision_answer(const Decision& decision, mission::GroundAgent& agent,
                                     const std::string& by, Instant now);
/// The answer says which deliveries are flown on, and who may not hear of it.
[[nodiscard]] Answer decision_answer(const TakeBack& back, mission::GroundAgent& agent,
                                     const std::string& by, Instant now);

}  // namespace skein::groundstation
