// SPDX-License-Identifier: Apache-2.0
#include "skein/checks/formation_changes.hpp"

#include <utility>

#include "skein/wording/wording.hpp"

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
    if (const auto* begun = std::get_if<mission::event::ChangeBegun>(&event.body)) {
      FormationChange change;
      change.number = begun->number;
      change.order = wording::text_of(*begun);
      change.begun = event.time;
      change.correction = begun->correction;
      if (!change.correction) {
        change.places = places_of(record, change.number);
      } else if (!all.empty()) {
        change.places = all.back().places;
      }
      if (!all.empty()) all.back().until = event.time;
      all.push_back(std::move(change));
    } else if (event.kind() == EventKind::formation_held && !all.empty() && !all.back().held) {
      all.back().held = event.time;
    }
  }
  return all;
}

}  // namespace skein::checks
