// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/fleet.hpp"

#include <algorithm>

#include "names.hpp"

namespace skein::mission {

using event::FleetNews;

Fleet::Fleet(const FleetParams& params) : params_{params} {
  for (const VehicleId vehicle : params.expected) vehicles_[vehicle].expected = true;
}

void Fleet::on_message(const Message& message, Instant now) {
  if (const auto* telemetry = std::get_if<Telemetry>(&message)) on_telemetry(*telemetry, now);
  if (const auto* health = std::get_if<Health>(&message)) {
    const auto known = vehicles_.find(health->vehicle);
    if (known == vehicles_.end()) return;
    known->second.health = *health;
    known->second.health_at = now;
  }
  if (const auto* preflight = std::get_if<Preflight>(&message)) {
    const auto known = vehicles_.find(preflight->vehicle);
    if (known == vehicles_.end()) return;
    known->second.preflight = *preflight;
    known->second.preflight_at = now;
  }
  if (const auto* event = std::get_if<MissionEvent>(&message)) on_event(*event);
}

void Fleet::on_event(const MissionEvent& event) {
  const auto known = vehicles_.find(event.vehicle);
  if (known == vehicles_.end()) return;
  FleetEntry& entry = known->second;
  if (const auto* commanded = std::get_if<event::Commanded>(&event.body)) {
    entry.obeys = commanded->command;
  } else if (const auto* warning = std::get_if<event::TrafficWarning>(&event.body)) {
    const bool fits = entry.aircraft.size() < kAircraftKnownMax;
    if (fits || entry.aircraft.contains(warning->address)) {
      entry.aircraft[warning->address] = warning->gives_way;
    }
  } else if (const auto* clear = std::get_if<event::TrafficClear>(&event.body)) {
    entry.aircraft.erase(clear->address);
  }
}

void Fleet::on_telemetry(const Telemetry& telemetry, Instant now) {
  const VehicleId vehicle = telemetry.vehicle;
  if (!vehicles_.contains(vehicle)) {
    if (vehicles_.size() >= params_.expected.size() + kStrangersMax) return;
    warn(FleetNews::stranger, vehicle);
  }
  FleetEntry& entry = vehicles_[vehicle];

  // A restarted vehicle has a new instance and its old one never speaks again. Two vehicles with
  // one id take turns: the one that we took for replaced is heard once more.
  forget_instances(entry, now);
  auto& instances = entry.instances;
  const bool known = instances.contains(telemetry.instance);
  const bool changed = entry.telemetry && entry.telemetry->instance != telemetry.instance;
  if (known || instances.size() < kInstancesMax) instances[telemetry.instance] = now;
  if (changed && known && !entry.duplicate) {
    entry.duplicate = true;
    warn(FleetNews::duplicate, vehicle);
  } else if (changed && !known && !entry.duplicate) {
    warn(FleetNews::restarted, vehicle);
    entry.obeys.reset();
    entry.aircraft.clear();
  }

  if (!entry.telemetry || entry.silent || changed) due_ = Instant::min();
  if (!is_late(telemetry)) entry.telemetry = telemetry;
  if (entry.silent) {
    entry.silent = false;
    warn(FleetNews::heard_again, vehicle, now - entry.heard_at);
  }
  entry.heard_at = now;
}

void Fleet::on_timeout(Instant now) {
  if (now < due_) return;
  for (auto& [vehicle, entry] : vehicles_) {
    if (entry.telemetry && !entry.silent && now >= entry.heard_at + params_.silence) {
      entry.silent = true;
      warn(FleetNews::silent, vehicle);
    }
  }
  for (auto& [vehicle, entry] : vehicles_) {
    if (!entry.duplicate) continue;
    forget_instances(entry, now);
    if (entry.instances.size() > 1) continue;
    entry.duplicate = false;
    warn(FleetNews::unique, vehicle);
  }
  due_ = next_timeout();
}

Instant Fleet::next_timeout() const {
  Instant next = Instant::max();
  for (const auto& [vehicle, entry] : vehicles_) {
    if (entry.telemetry && !entry.silent) next = std::min(next, entry.heard_at + params_.silence);
    if (!entry.duplicate) continue;
    for (const auto& [instance, at] : entry.instances) next = std::min(next, at + params_.silence);
  }
  return next;
}

bool Fleet::expects(VehicleId vehicle) const {
  const auto found = vehicles_.find(vehicle);
  return found != vehicles_.end() && found->second.expected;
}

bool Fleet::is_late(const Telemetry& telemetry) const {
  const auto known = vehicles_.find(telemetry.vehicle);
  if (known == vehicles_.end() || !known->second.telemetry) return false;
  const Telemetry& newest = *known->second.telemetry;
  return newest.instance == telemetry.instance && telemetry.state.time < newest.state.time;
}

bool Fleet::duplicate(VehicleId vehicle) const {
  const auto found = vehicles_.find(vehicle);
  return found != vehicles_.end() && found->second.duplicate;
}

void Fleet::set_revoked(const std::set<VehicleId>& revoked) {
  for (auto& [vehicle, entry] : vehicles_) entry.revoked = revoked.contains(vehicle);
}

void Fleet::set_difference(VehicleId vehicle, const SetupDifference* difference) {
  const auto found = vehicles_.find(vehicle);
  if (found == vehicles_.end()) return;
  found->second.differs =
      difference == nullptr ? std::nullopt : std::optional<SetupDifference>{*difference};
}

std::optional<std::string> Fleet::why_not_with(VehicleId vehicle) const {
  const auto found = vehicles_.find(vehicle);
  if (found == vehicles_.end()) return std::nullopt;
  if (found->second.revoked) {
    return name_of(vehicle) + " was put out of the mission; enrol it with new keys";
  }
  if (found->second.duplicate) {
    return "two vehicles answer to the id of " + name_of(vehicle) +
           "; stop or renumber one of them first";
  }
  if (found->second.differs) {
    return name_of(vehicle) + " has " + text_of(*found->second.differs) +
           "; give it what the ground station runs with, and start it anew";
  }
  return std::nullopt;
}

void Fleet::forget_instances(FleetEntry& entry, Instant now) const {
  std::erase_if(entry.instances, [&](const auto& i) { return i.second + params_.silence <= now; });
}

void Fleet::warn(FleetNews news, VehicleId vehicle, Duration silence) {
  news_.push({news, vehicle, silence});
}

}  // namespace skein::mission
