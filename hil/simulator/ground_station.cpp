// SPDX-License-Identifier: Apache-2.0
#include "ground_station.hpp"

#include <algorithm>
#include <utility>

#include "skein/base/assert.hpp"
#include "skein/base/contains.hpp"

namespace skein::hil {
namespace {

std::vector<VehicleId> formation_of(const TeamMission& mission) {
  std::vector<VehicleId> ids;
  for (const auto& v : mission.vehicles) {
    if (v.flies_formation) ids.push_back(v.spec.id);
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

/// What detectors see is looked at.
mission::GroundDetectionsConfig taken_at_once() {
  mission::GroundDetectionsConfig config;
  config.take = true;
  config.otherwise.survey.dwell = std::chrono::seconds{5};
  return config;
}

mission::GroundNodeConfig node_config(const TeamMission& mission) {
  mission::GroundNodeConfig node;
  node.setup.clock_guard = mission.protocol.clock_guard;
  for (const auto& v : mission.vehicles) {
    if (!v.flies_as) node.agent.expected.push_back(v.spec.id);
  }
  node.agent.decisions = mission.decisions;
  node.detections = taken_at_once();
  if (mission.formation && mission.formation->planes) {
    std::vector<VehicleSpec> planes;
    std::vector<Hazard> hazards;
    for (const auto& v : mission.vehicles) planes.push_back(v.spec);
    for (const auto& h : mission.hazards) {
      if (h.known_from <= Instant{}) hazards.push_back(h.hazard);
    }
    node.tracks = groundstation::track_ground(*mission.formation, planes, hazards);
  } else if (mission.formation) {
    node.formation = groundstation::formation_ground(*mission.formation, formation_of(mission));
  }
  node.fence = node.formation.fence = node.tracks.fence = mission.fence;
  return node;
}

Result<groundstation::FormationDesk> open_desk(const TeamMission& mission, std::size_t lines_done,
                                               mission::GroundNode& node) {
  configuration::FormationConfig config = *mission.formation;
  config.script.erase(config.script.begin(),
                      config.script.begin() + static_cast<std::ptrdiff_t>(lines_done));
  return groundstation::FormationDesk::open(config, formation_of(mission), node);
}

bool ends_ground_for_a_time(const Fault& fault) {
  const auto* ends = std::get_if<ProgramsEnd>(&fault.what);
  return ends != nullptr && fault.lasts && contains(ends->who, kGroundStation);
}

}  // namespace

Result<void> check_script(const TeamMission& mission) {
  if (!mission.formation) return {};
  mission::GroundNode node{node_config(mission), Instant{}};
  const auto desk = open_desk(mission, 0, node);
  if (!desk) return desk.error();
  return {};
}

GroundStation::GroundStation(const TeamMission& mission, const TeamObserver& observer)
    : mission_{mission},
      observer_{observer},
      formation_{formation_of(mission)},
      clock_{clock_offset(mission.faults, kGroundStation)},
      starts_anew_{std::ranges::any_of(mission.faults, &ends_ground_for_a_time)} {}

void GroundStation::start(Instant now) {
  node_.emplace(node_config(mission_), now + clock_);
  for (const Recorded& record : recorded_) node_->recall(record.message, record.sender, record.at);
  if (!mission_.formation) return;
  auto desk = open_desk(mission_, script_done_, *node_);
  SKEIN_ASSERT(desk.ok());
  desk_ = std::move(*desk);
}

void GroundStation::end() {
  if (desk_) script_done_ += desk_->script_line();
  desk_.reset();
  node_.reset();
}

bool GroundStation::withdraw(const std::optional<SiteId>& site, Instant now) {
  if (!node_) return false;
  std::optional<SiteId> which = site;
  for (const auto& [id, entry] : node_->sites().sites()) {
    if (!site && entry.of_operator && entry.state < mission::SiteState::over) which = id;
  }
  if (!which || !node_->sites().sites().contains(*which)) return false;
  (void)node_->withdraw_site(*which, "scenario", now + clock_);  // fails where it is over
  return true;
}

bool GroundStation::take_back(const GrantTakenBack& what, Instant now) {
  if (!node_) return false;
  const auto is_due = [&](const mission::PendingAuthorisation& known) {
    return known.request.site == what.site && known.decision && known.decision->granted &&
           now + clock_ >= known.decision->decided_at + what.after;
  };
  return std::ranges::any_of(node_->agent().authorisations(), is_due) &&
         node_->agent().take_back(what.site, "scenario", now + clock_).ok();
}

bool GroundStation::give(const RoutesOrdered& order, Instant now) {
  if (!node_) return false;
  mission::GroundRoutes::Routes routes = order.routes;
  for (auto& [id, timed] : routes) timed.start_time = now + clock_ + order.begin_in;
  return node_->give_routes(routes, now + clock_).ok();
}

void GroundStation::on_message(const mission::Message& message, VehicleId sender, Instant now) {
  if (!node_) return;
  record(message, sender, now + clock_);
  const bool taken = node_->on_message(message, sender, now + clock_);
  if (taken && observer_.ground_message) observer_.ground_message(message, sender, now + clock_);
}

void GroundStation::record(const mission::Message& message, VehicleId sender, Instant at) {
  const bool recalled = !std::holds_alternative<mission::Telemetry>(message) &&
                        !std::holds_alternative<mission::Health>(message);
  if (starts_anew_ && recalled) recorded_.push_back({message, sender, at});
}

void GroundStation::on_timeout(Instant now) {
  if (node_) node_->on_timeout(now + clock_);
  if (desk_) desk_->on_timeout(now + clock_);
}

void GroundStation::on_aircraft(mission::Aircraft aircraft, Instant now) {
  if (!node_) return;
  aircraft.time += clock_;
  node_->on_aircraft({.aircraft = aircraft}, now + clock_);
}

std::optional<mission::Message> GroundStation::poll_message(Instant now) {
  std::optional<mission::Message> message;
  do {
    message = node_ ? node_->poll_message() : std::nullopt;
  } while (message &&
           std::holds_alternative<mission::MissionEvent>(*message));  // read on the ground
  if (!message) return message;
  record(*message, kGroundStation, now + clock_);
  if (observer_.ground_message) observer_.ground_message(*message, kGroundStation, now + clock_);
  return message;
}

std::optional<mission::MissionEvent> GroundStation::poll_event() {
  std::optional<mission::MissionEvent> event;
  do {
    event = node_ ? node_->poll_event() : std::nullopt;
    if (event && observer_.ground_event) observer_.ground_event(*event);
  } while (event && is_told_elsewhere(*event));
  if (event) event->time -= clock_;
  return event;
}

/// Of the vehicles' own events, which the node passes on, nobody has to be told again; who of the
/// formation is silent, or back, its desk says.
bool GroundStation::is_told_elsewhere(const mission::MissionEvent& event) const {
  const auto* fleet = std::get_if<mission::event::FleetWarning>(&event.body);
  return event.vehicle != kGroundStation ||
         (fleet != nullptr && contains(formation_, fleet->vehicle));
}

}  // namespace skein::hil
