// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "skein/idl/events.hpp"

namespace skein::mission {

static_assert(std::variant_size_v<EventBody::variant> ==
              static_cast<std::size_t>(EventKind::count));

/// To be looked at by a person.
[[nodiscard]] constexpr bool is_warning(EventKind kind) { return kind >= EventKind::task_lost; }

/// That alternative, with its defaults.
[[nodiscard]] EventBody body_of(EventKind kind);

}  // namespace skein::mission
