// SPDX-License-Identifier: Apache-2.0
#include "mission_watch.hpp"

#include <algorithm>
#include <array>

#include "skein/configuration/deployment.hpp"

namespace skein::hil {

bool is_news(mission::EventKind kind) {
  using mission::EventKind;
  static constexpr std::array kNews{EventKind::site_detected,
                                    EventKind::survey_done,
                                    EventKind::coalition_formed,
                                    EventKind::monitoring,
                                    EventKind::authorisation_requested,
                                    EventKind::authorisation_late,
                                    EventKind::site_done,
                                    EventKind::change_begun,
                                    EventKind::formation_held,
                                    EventKind::script_done,
                                    EventKind::task_failed};
  if (kind == EventKind::command_handed) return false;  // said again and again while it is so
  return std::ranges::find(kNews, kind) != kNews.end() || mission::is_warning(kind);
}

MissionWatch::MissionWatch(const configuration::Scenario& scenario) : scenario_{scenario} {
  for (const auto& end : configuration::route_ends(scenario)) {
    routes_end_ = std::max(routes_end_, end.planned);
  }
}

bool MissionWatch::on_event(const mission::MissionEvent& event) {
  using mission::EventKind;
  if (event.kind() == EventKind::site_done) return sites_done_.insert(event.task.site).second;
  script_done_ = script_done_ || event.kind() == EventKind::script_done;
  if (event.vehicle == kGroundStation) return event.kind() == EventKind::script_done;
  if (event.kind() == EventKind::change_taken_up) {
    changes_begun_ = true;
    moving_.insert(event.vehicle);
  }
  if (event.kind() == EventKind::place_reached) moving_.erase(event.vehicle);
  return false;
}

void MissionWatch::on_telemetry(const mission::Telemetry& telemetry) {
  const bool rests = telemetry.state.phase != FlightPhase::landed;  // armed still
  if (telemetry.activity == mission::Activity::landed && rests) {
    landed_.insert(telemetry.vehicle);
  } else {
    landed_.erase(telemetry.vehicle);
  }
}

bool MissionWatch::work_done(Instant now) const {
  if (!scenario_.flies_formation()) {
    // Whatever sites the operator has told besides.
    const bool all_done = std::ranges::all_of(
        scenario_.sites, [this](const Site& site) { return sites_done_.contains(site.id); });
    return all_done && now > routes_end_;
  }
  // Without a ground station the change that it has sent is flown to its end, and held.
  const bool left_alone =
      killed_.contains(kGroundStation) && changes_begun_ && std::ranges::includes(killed_, moving_);
  return script_done_ || left_alone;
}

bool MissionWatch::all_landed() const {
  return std::ranges::all_of(scenario_.vehicles, [this](const auto& vehicle) {
    return landed_.contains(vehicle.spec.id) || killed_.contains(vehicle.spec.id);
  });
}

bool MissionWatch::over(Instant now) const {
  const bool nobody_flies =
      !scenario_.flies_formation() && landed_.size() == scenario_.vehicles.size();
  const bool in_the_air = scenario_.ends == configuration::Ending::in_the_air;
  return nobody_flies || (work_done(now) && (in_the_air || all_landed()));
}

}  // namespace skein::hil
