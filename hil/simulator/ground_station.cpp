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
    for (const auto& v : mission.vehicles) planes.push_back(v.spec);
    node.tracks = groundstation::track_ground(*mission.formation, planes,
                                              hazards_known_at(mission.hazards, Instant{}));
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
  return ends != nullptr && fault.lasts &&
         (contains(ends->who, kGroundStation) || contains(ends->who, kSecondStation));
}

}  // namespace

Result<void> check_script(const TeamMission& mission) {
  if (!mission.formation) return {};
  mission::GroundNode node{node_config(mission), Instant{}};
  const auto desk = open_desk(mission, 0, node);
  if (!desk) return desk.error();
  return {};
}

GroundStation::GroundStation(const TeamMission& mission, const TeamObserver& observer,
                             std::uint16_t number)
    : mission_{mission},
      observer_{observer},
      formation_{formation_of(mission)},
      clock_{clock_offset(mission.faults, kGroundStation)},
      number_{number},
      starts_anew_{std::ranges::any_of(mission.faults, &ends_ground_for_a_time)} {}

void GroundStation::start(Instant now) {
  node_.emplace(node_config(mission_), now + clock_);
  for (const Recorded& record : recorded_) node_->recall(record.message, record.sender, record.at);
  start_ = next_start();
  command_.emplace(configuration::CommandConfig{number_, "", number_ > 1}, start_, now + clock_);
  if (!command_->is_commanding()) node_->watch(now + clock_);
  if (!mission_.formation) return;
  auto desk = open_desk(mission_, script_done_, *node_);
  SKEIN_ASSERT(desk.ok());
  desk_ = std::move(*desk);
}

/// Newer than all that it has been, and has heard of; of no other station.
InstanceId GroundStation::next_start() const {
  constexpr std::uint64_t kStations = 100;
  const auto heard = command_ ? command_->newest() : std::nullopt;
  const std::uint64_t newest = std::max(start_.value, heard.value_or(InstanceId{}).value);
  return {(newest / kStations + 1) * kStations + number_};
}

bool GroundStation::take_command(Instant now) {
  if (!node_ || command_->why_not_take(now + clock_)) return false;
  take(now + clock_);
  return true;
}

void GroundStation::take(Instant at) {
  constexpr std::uint64_t kFar = 100'000;
  start_ = next_start();
  // Whom vehicles heed was not heard here.
  if (!command_->unheeding(at).empty()) start_.value += kFar;
  node_->take_command(start_, at);
  node_->say(command_->take(start_, "", "", at));
}

/// Whoever may have it takes it where nobody has, and again where vehicles do not heed it.
void GroundStation::keep_command(Instant at) {
  if (number_ == 0) return;
  const bool is_nobodys = command_->takes_by_itself(at) || command_->nobody_commands(at);
  if (is_nobodys || !command_->unheeding(at).empty()) take(at);
}

void GroundStation::end() {
  if (command_) start_ = std::max(start_, command_->newest().value_or(start_));  // on its disk
  command_.reset();
  if (desk_) script_done_ += desk_->script_line();
  desk_.reset();
  node_.reset();
}

bool GroundStation::withdraw(const std::optional<SiteId>& site, Instant now) {
  if (!commands()) return false;
  std::optional<SiteId> which = site;
  for (const auto& [id, entry] : node_->sites().sites()) {
    if (!site && entry.of_operator && entry.state < mission::SiteState::over) which = id;
  }
  if (!which || !node_->sites().sites().contains(*which)) return false;
  (void)node_->withdraw_site(*which, "scenario", now + clock_);  // fails where it is over
  return true;
}

bool GroundStation::take_back(const GrantTakenBack& what, Instant now) {
  if (!commands()) return false;
  const auto is_due = [&](const mission::PendingAuthorisation& known) {
    return known.request.site == what.site && known.decision && known.decision->granted &&
           now + clock_ >= known.decision->decided_at + what.after;
  };
  return std::ranges::any_of(node_->agent().authorisations(), is_due) &&
         node_->agent().take_back(what.site, "scenario", now + clock_).ok();
}

bool GroundStation::give(const RoutesOrdered& order, Instant now) {
  if (!commands()) return false;
  mission::GroundRoutes::Routes routes = order.routes;
  for (auto& [id, timed] : routes) timed.start_time = now + clock_ + order.begin_in;
  return node_->give_routes(routes, now + clock_).ok();
}

void GroundStation::on_message(const mission::Message& message, VehicleId sender, InstanceId start,
                               Instant now) {
  using Heard = groundstation::CommandDesk::Heard;
  if (!node_) return;
  const Heard heard = command_->on_message(message, sender, start, now + clock_);
  if (heard == Heard::own || heard == Heard::word) return;
  if (heard == Heard::superseded) node_->watch(now + clock_);
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
  if (!node_) return;
  keep_command(now + clock_);
  node_->on_timeout(now + clock_);
  if (desk_) desk_->on_timeout(now + clock_);
}

void GroundStation::on_aircraft(mission::Aircraft aircraft, Instant now) {
  if (!node_) return;
  aircraft.time += clock_;
  node_->on_aircraft({.aircraft = aircraft}, now + clock_);
}

std::optional<mission::Message> GroundStation::poll_message(Instant now) {
  if (!node_) return std::nullopt;
  std::optional<mission::Message> message;
  do {
    message = node_->poll_message();
  } while (message && number_ == 0 &&
           std::holds_alternative<mission::MissionEvent>(*message));  // read on the ground
  if (!message) {
    if (auto word = command_->poll_word(now + clock_)) message = *std::move(word);
  }
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
