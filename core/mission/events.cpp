// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/events.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <variant>

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

template <class Event>
concept Warns = requires {
  requires Event::kWarning;
};

constexpr auto kWarnings = []<class... Event>(const std::variant<Event...>* /*list*/) {
  return std::array{Warns<Event>...};
}(static_cast<const EventBody::variant*>(nullptr));
}  // namespace

bool is_warning(EventKind kind) { return kWarnings.at(static_cast<std::size_t>(kind)); }

EventBody body_of(EventKind kind) {
  SKEIN_ASSERT(kind < EventKind::count);
  return body_at(static_cast<std::size_t>(kind));
}

std::optional<bool> tells_piloted(AutopilotNews news) {
  switch (news) {
    case AutopilotNews::mode_changed:
    case AutopilotNews::armed_by_others:
    case AutopilotNews::not_obeying:
    case AutopilotNews::not_climbed:
    case AutopilotNews::still_piloted:
      return true;
    case AutopilotNews::flying:
      return false;
    default:
      return std::nullopt;
  }
}

event::FormationWarning formation_warning(event::FormationNews news,
                                          std::vector<VehicleId> vehicles) {
  const std::size_t named = std::min(vehicles.size(), event::kNamedMax);
  const auto more = static_cast<std::uint16_t>(vehicles.size() - named);
  vehicles.resize(named);
  return {news, std::move(vehicles), more};
}

}  // namespace skein::mission
