// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/events.hpp"

#include <utility>

#include "skein/base/assert.hpp"

namespace skein::mission {
namespace {
template <std::size_t Index = 0>
EventBody body_at(std::size_t kind) {
  if constexpr (Index + 1 < std::variant_size_v<EventBody::variant>) {
    if (kind != Index) return body_at<Index + 1>(kind);
  }
  return EventBody{std::in_place_index<Index>};
}
}  // namespace

EventBody body_of(EventKind kind) {
  SKEIN_ASSERT(kind < EventKind::count);
  return body_at(static_cast<std::size_t>(kind));
}

}  // namespace skein::mission
