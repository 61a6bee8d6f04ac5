// SPDX-License-Identifier: Apache-2.0
#include "skein/checks/formation_changes.hpp"

#include <utility>

namespace skein::checks {
namespace {

using mission::EventKind;

std::map<VehicleId, Vec3> places_of(const RunRecord& record, std::uint32_t change) {
  std::map<VehicleId, Vec3> places;
  for (const auto& place : record.places) {
    if (place.change == change) places[place.vehicle] = place.place_m;
  }
  return places;
}

}  // namespace

std::vector<FormationChange> formation_changes(const RunRecord& record) {
  std::vector<FormationChange> all;
  for (const auto& event : record.ground_events) {
    if (event.vehicle != kGroundStation) continue;
    if (event.kind == EventKind::change_begun) {
      FormationChange change;
      change.number = static_cast<std::uint32_t>(event.value);
      change.order = event.text.substr(0, event.text.find(':'));
      change.begun = event.time;
      change.correction = event.text.starts_with("correction");
      if (!change.correction) {
        change.places = places_of(record, change.number);
      } else if (!all.empty()) {
        change.places = all.back().places;
      }
      if (!all.empty()) all.back().until = event.time;
      all.push_back(std::move(change));
    } else if (event.kind == EventKind::formation_held && !all.empty() && !all.back().held) {
      all.back().held = event.time;
    }
  }
  return all;
}

}  // namespace skein::checks
