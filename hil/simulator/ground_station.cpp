// SPDX-License-Identifier: Apache-2.0
#include "ground_station.hpp"

#include <algorithm>
#include <utility>

#include "skein/base/assert.hpp"

namespace skein::hil {
namespace {

/// In the order of their numbers.
std::vector<VehicleId> some_of(const TeamMission& mission, bool formation) {
  std::vector<VehicleId> ids;
  for (const auto& v : mission.vehicles) {
    if (v.flies_formation == formation) ids.push_back(v.spec.id);
  }
  if (formation) std::sort(ids.begin(), ids.end());
  return ids;
}

Result<groundstation::FormationDesk> open_desk(const TeamMission& mission, std::size_t lines_done,
                                               Instant now) {
  configuration::FormationConfig config = *mission.formation;
  config.script.erase(config.script.begin(),
                      config.script.begin() + static_cast<std::ptrdiff_t>(lines_done));
  return groundstation::FormationDesk::open(config, some_of(mission, true), now);
}

}  // namespace

Result<void> check_script(const TeamMission& mission) {
  if (!mission.formation) return {};
  const auto desk = open_desk(mission, 0, Instant{});
  if (!desk) return desk.error();
  return {};
}

GroundStation::GroundStation(const TeamMission& mission)
    : mission_{mission}, clock_{clock_offset(mission.faults, kGroundStation)} {}

void GroundStation::start(Instant now) {
  mission::GroundAgentConfig config;
  config.expected = some_of(mission_, false);
  config.decisions = mission_.decisions;
  if (!config.expected.empty()) agent_.emplace(config, now + clock_);
  if (!mission_.formation) return;
  auto desk = open_desk(mission_, script_done_, now + clock_);
  SKEIN_ASSERT(desk.ok());
  desk_ = std::move(*desk);
}

void GroundStation::end() {
  if (desk_) script_done_ += desk_->script_line();
  agent_.reset();
  desk_.reset();
}

void GroundStation::on_message(const mission::Message& message, VehicleId sender, Instant now) {
  if (agent_) agent_->on_message(message, sender, now + clock_);
  if (desk_) desk_->on_message(message, sender, now + clock_);
}

void GroundStation::on_timeout(Instant now) {
  if (agent_) agent_->on_timeout(now + clock_);
  if (desk_) desk_->on_timeout(now + clock_);
}

std::optional<mission::Message> GroundStation::poll_message() {
  if (agent_) {
    if (auto message = agent_->poll_message()) return message;
  }
  return desk_ ? desk_->poll_message() : std::nullopt;
}

std::optional<mission::MissionEvent> GroundStation::poll_event() {
  std::optional<mission::MissionEvent> event;
  // Of the vehicles' own, which the agent passes on, nobody has to be told again.
  do {
    event = agent_ ? agent_->poll_event() : std::nullopt;
  } while (event && event->vehicle != kGroundStation);
  if (!event && desk_) event = desk_->poll_event();
  if (event) event->time -= clock_;
  return event;
}

}  // namespace skein::hil
