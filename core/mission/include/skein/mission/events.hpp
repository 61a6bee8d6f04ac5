// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "skein/idl/events.hpp"

namespace skein::mission {

static_assert(std::variant_size_v<EventBody::variant> ==
              static_cast<std::size_t>(EventKind::count));

/// To be looked at by a person: @warning in the IDL.
[[nodiscard]] bool is_warning(EventKind kind);

/// That alternative, with its defaults.
[[nodiscard]] EventBody body_of(EventKind kind);

/// Does it say that others fly the vehicle, or that its program does again? Nothing of both:
/// nothing.
[[nodiscard]] std::optional<bool> tells_piloted(AutopilotNews news);

/// Names as many of them as it can.
[[nodiscard]] event::FormationWarning formation_warning(event::FormationNews news,
                                                        std::vector<VehicleId> vehicles);

}  // namespace skein::mission
