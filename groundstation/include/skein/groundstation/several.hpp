// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "skein/base/ids.hpp"
#include "skein/base/result.hpp"
#include "skein/groundstation/control_socket.hpp"
#include "skein/groundstation/orders.hpp"
#include "skein/mission/fleet.hpp"

namespace skein::groundstation {

/// One order to several vehicles, each by itself: one that cannot be told does not keep the others
/// from it. Done when all were told; the text names who was, and of each other why it was not.
[[nodiscard]] Answer tell_each(const OrderToSeveral& order,
                               const std::function<Result<void>(VehicleId)>& tell);

/// What came of one order to all: who is not told, and why, where `why_not` says so; and who of the
/// mission is not heard now, and may not have heard it.
[[nodiscard]] Answer told_all(const Result<void>& outcome, const mission::Fleet& fleet,
                              const std::function<std::optional<std::string>(VehicleId)>& why_not);

}  // namespace skein::groundstation
