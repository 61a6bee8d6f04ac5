// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "skein/base/frames.hpp"
#include "skein/console/picture.hpp"
#include "skein/mission/fleet.hpp"

/// Picture and fleet as JSON, by the sections of docs/console-socket.md.
namespace skein::console {

enum class Section : std::uint8_t {
  vehicles,
  plans,
  sites,
  coalitions,
  authorisations,
  hazards,
  formation,
  timeline,
  audit,
  replay,
  proposals,
  preflight,
  fence,
  links,
  wind,
  areas,
  alarms,
  traffic,
  command,
  team,
  count
};
inline constexpr std::size_t kSectionCount = static_cast<std::size_t>(Section::count);
[[nodiscard]] std::string_view to_string(Section section);

/// One JSON value a section; empty where there is none.
using Sections = std::array<std::string, kSectionCount>;

/// All but `audit`, `replay`, `areas`, `alarms` and `command`, which are not of the picture.
/// `version` is what vehicles should run, so that others are named.
[[nodiscard]] Sections sections_of(const Picture& picture, const mission::Fleet& fleet,
                                   const MissionOrigin& origin, const std::string& version,
                                   Instant now);
[[nodiscard]] std::string section_of(Section section, const Picture& picture,
                                     const mission::Fleet& fleet, const MissionOrigin& origin,
                                     const std::string& version, Instant now);

/// A way as the section `plans` has it, without a number: a JSON object.
[[nodiscard]] std::string path_json(VehicleId vehicle, const TimedPath& timed);

/// The `series` of a history message: a JSON array.
[[nodiscard]] std::string series_of(const Picture& picture);

/// One of an `events` message: a JSON object, with the event's own fields and its line for people.
[[nodiscard]] std::string event_json(const mission::MissionEvent& event, std::uint64_t seq);

/// The coalition of that key; none where it is no key.
[[nodiscard]] std::optional<coalition::CoalitionId> coalition_of(std::string_view key);
/// A coalition's own word.
[[nodiscard]] std::string key_of(const coalition::CoalitionId& id);

}  // namespace skein::console
