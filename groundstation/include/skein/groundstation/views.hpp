// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/frames.hpp"
#include "skein/base/time.hpp"
#include "skein/console/picture.hpp"
#include "skein/mission/ground_agent.hpp"

/// What the operator reads. Directions are compass degrees, distances metres and kilometres, times
/// mission seconds.
namespace skein::groundstation {

/// "1234 m from the origin towards 045 deg, 31.530000 N 105.050000 E"
[[nodiscard]] std::string place_text(const Vec2& position, const MissionOrigin& origin);

/// One line a vehicle: number, activity, seconds since it was heard, range left, loads, health.
[[nodiscard]] std::string fleet_table(const std::map<VehicleId, mission::FleetEntry>& fleet,
                                      Instant now);

/// What, where, when, who, until when, and what to type.
[[nodiscard]] std::string request_text(const mission::PendingAuthorisation& pending,
                                       const MissionOrigin& origin, Instant now);

/// The requests that still can be decided, newest last.
[[nodiscard]] std::string pending_text(const std::vector<mission::PendingAuthorisation>& all,
                                       const MissionOrigin& origin, Instant now);

/// What was announced, bid and awarded, and what came of it; newest last.
[[nodiscard]] std::string coalitions_text(const console::Picture& picture);
[[nodiscard]] std::string hazards_text(const console::Picture& picture);

/// One line a site: who leads there, what was done, the latest news.
[[nodiscard]] std::string sites_text(const console::Picture& picture);

}  // namespace skein::groundstation
