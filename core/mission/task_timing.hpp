// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "ownship.hpp"
#include "task_flight.hpp"

namespace skein::mission {

/// Control keeps a task's time by speed. Does the wind take more than that has? False where the
/// vehicle's state is too old to say.
[[nodiscard]] bool is_untimely(const Ownship& ownship, const TaskFlight& task, Instant now);

/// The speed over the ground nearest to cruise speed at which a path from where the vehicle is at
/// `start` is on time, as long or short as that makes it; without one, the best, where that gains
/// enough.
[[nodiscard]] std::optional<double> timely_speed(const Ownship& ownship, const TaskFlight& task,
                                                 Instant start);

}  // namespace skein::mission
