// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

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

/// A check before a flight: "FAIL  GNSS: no fix; wait under open sky"; without a remedy where that
/// is empty.
[[nodiscard]] std::string check_line(mission::CheckVerdict verdict, std::string_view what,
                                     std::string_view found, std::string_view remedy);

/// What an event says besides its kind, its vehicle and its task: "planned for 60.0 s". May be
/// empty.
[[nodiscard]] std::string news_of(const mission::MissionEvent& event);
/// An event as one line: "vehicle 7: task done, site 1 deliver 3: planned for 60.0 s".
[[nodiscard]] std::string text_of(const mission::MissionEvent& event);

}  // namespace skein::wording
