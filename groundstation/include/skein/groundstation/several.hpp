// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "skein/base/ids.hpp"
#include "skein/base/result.hpp"
#include "skein/groundstation/control_socket.hpp"
#include "skein/groundstation/orders.hpp"

namespace skein::groundstation {

/// One order to several vehicles, each by itself: one that cannot be told does not keep the others
/// from it. Done when all were told; the text names who was, and of each other why it was not.
[[nodiscard]] Answer tell_each(const OrderToSeveral& order,
                               const std::function<Result<void>(VehicleId)>& tell);

}  // namespace skein::groundstation
