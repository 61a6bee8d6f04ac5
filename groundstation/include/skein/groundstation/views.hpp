// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "skein/base/frames.hpp"
#include "skein/base/time.hpp"
#include "skein/console/authorisation_card.hpp"
#include "skein/console/picture.hpp"
#include "skein/mission/ground_agent.hpp"

/// What the operator reads. Directions are compass degrees of three digits, distances metres and
/// kilometres, moments mission seconds with UTC beside them.
namespace skein::groundstation {

/// "1234 m from the origin towards 045 deg, 31.530000 N 105.050000 E"
[[nodiscard]] std::string place_text(const Vec2& position, const MissionOrigin& origin);

/// One line a vehicle: number, state, task, seconds since it was heard, range left, loads, health.
[[nodiscard]] std::string fleet_table(const std::map<VehicleId, mission::FleetEntry>& fleet,
                                      Instant now);

/// What, where, when, who, what speaks against it, until when, and what to type.
[[nodiscard]] std::string request_text(const mission::PendingAuthorisation& pending,
                                       const console::AuthorisationCard& card,
                                       const MissionOrigin& origin, std::int64_t epoch_unix_ns,
                                       Instant now);

/// The requests that still can be decided, newest last.
[[nodiscard]] std::string pending_text(const std::vector<mission::PendingAuthorisation>& all,
                                       const console::Picture& picture, const mission::Fleet& fleet,
                                       const MissionOrigin& origin, std::int64_t epoch_unix_ns,
                                       Instant now);

/// What was announced, bid and awarded, and what came of it; newest last.
[[nodiscard]] std::string coalitions_text(const console::Picture& picture);
/// "radius 50 m around 600 m east, 0 m north of the origin"
[[nodiscard]] std::string circle_text(const Hazard& hazard);
[[nodiscard]] std::string hazards_text(const console::Picture& picture);

/// What the mission has come to, where the ground station ends: sites, tasks, and where vehicles
/// were left.
[[nodiscard]] std::string summary_text(const console::Picture& picture,
                                       const mission::Fleet& fleet);

/// How far it has come: "led by vehicle 3, surveyed, 1 delivered, 0 assessed".
[[nodiscard]] std::string site_state_text(const console::SitePicture& site);

/// One line a site: who leads there, what was done, the latest news.
[[nodiscard]] std::string sites_text(const console::Picture& picture);

}  // namespace skein::groundstation
