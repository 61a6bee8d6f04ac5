// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "skein/base/geometry.hpp"
#include "skein/base/time.hpp"
#include "skein/coalition/messages.hpp"
#include "skein/domain/autopilot_notice.hpp"
#include "skein/mission/messages.hpp"

/// Events as people read them. Nobody decides on what stands here: whoever needs to know reads the
/// event's fields.
namespace skein::wording {

/// "vehicle 7", or "ground station".
[[nodiscard]] std::string text_of(VehicleId vehicle);
/// "vehicle 3 refused: no path was found"; empty where there is no reason.
[[nodiscard]] std::string text_of(const coalition::Why& why);
/// "the autopilot has rebooted"
[[nodiscard]] std::string text_of(const AutopilotNotice& notice);
/// "form wedge, straight"; "correction of rally, layers"
[[nodiscard]] std::string text_of(const mission::event::ChangeBegun& change);

/// "refused: it leads into a hazard"
[[nodiscard]] std::string text_of(mission::RouteState state, mission::RouteObstacle why);

/// A direction as people read it, compass degrees in three digits: "045 deg".
[[nodiscard]] std::string bearing_text(double heading_rad);
/// The same for a line that is typed, without its unit and with what it has beyond whole degrees:
/// "045", "007.5".
[[nodiscard]] std::string bearing_digits(double heading_rad);
/// "told to 3; not to 4: ...", of lines that end alike.
[[nodiscard]] std::string one_line(std::string lines);
/// "1200 m east, -300 m north"
[[nodiscard]] std::string place_text(const Vec2& position);
/// A moment of the mission: "123.4 s (14:05:33 UTC)".
[[nodiscard]] std::string moment_text(Instant t, std::int64_t epoch_unix_ns);

/// A check before a flight: "FAIL  GNSS: no fix; wait under open sky"; without a remedy where that
/// is empty.
[[nodiscard]] std::string check_line(mission::CheckVerdict verdict, std::string_view what,
                                     std::string_view found, std::string_view remedy);

/// What an event says besides its kind, its vehicle and its task: "planned for 60.0 s". May be
/// empty.
[[nodiscard]] std::string news_of(const mission::MissionEvent& event);
/// The same without how long it is from then to its moment, for what is shown for longer: "aircraft
/// 4ca2d6: 120 m to the side, 40 m in height; gives way by its height".
[[nodiscard]] std::string lasting_news_of(const mission::MissionEvent& event);
/// The moment that an event foresees: when two come closest to each other; none of most.
[[nodiscard]] std::optional<Instant> closest_of(const mission::MissionEvent& event);
/// From now to that moment, or since: "closest in 42 s", "was closest 12 s ago".
[[nodiscard]] std::string closest_text(Instant closest, Instant now);
/// An event as one line: "vehicle 7: task done, site 1 deliver 3: planned for 60.0 s".
[[nodiscard]] std::string text_of(const mission::MissionEvent& event);

}  // namespace skein::wording
