// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/team_record.hpp"

#include <algorithm>

#include "skein/hil/excuses.hpp"

namespace skein::hil {

TeamRecorder::TeamRecorder(const TeamMission& mission, const TeamObserver& watcher)
    : watcher_{watcher}, healing_{healing_of(mission.faults)} {
  record_.sites = mission.sites;
  record_.hazards = mission.hazards;
  record_.fence = mission.fence;
  for (const auto& v : mission.vehicles) {
    record_.vehicles.push_back(v.spec);
    index_.emplace(v.spec.id, record_.recordings.size());
    record_.recordings.push_back({v.spec.id, {}, {}, {}, 0});
  }
}

recording::Recording& TeamRecorder::of(VehicleId vehicle) {
  return record_.recordings.at(index_.at(vehicle));
}

TeamObserver TeamRecorder::observer() {
  TeamObserver observer;
  observer.event = [this](const mission::MissionEvent& event) {
    auto& events =
        event.vehicle == kGroundStation ? record_.ground_events : of(event.vehicle).events;
    events.push_back(event);
    if (watcher_.event) watcher_.event(event);
  };
  observer.plan = [this](VehicleId vehicle, const mission::FlightPlan& plan, Instant since) {
    of(vehicle).plans.push_back({plan.number, since, plan.timed});
    if (watcher_.plan) watcher_.plan(vehicle, plan, since);
  };
  observer.track = [this](VehicleId vehicle, const VehicleState& state,
                          const mission::FlightPlan& plan) {
    of(vehicle).track.push_back({state, plan.number, 0.0, 0.0});
    if (watcher_.track) watcher_.track(vehicle, state, plan);
  };
  observer.heard = [this](VehicleId vehicle, const mission::Message& message, Instant now) {
    const auto* decision = std::get_if<mission::Authorisation>(&message);
    if (decision != nullptr && !decision->granted) {
      record_.refusals.push_back({vehicle, decision->site, decision->decided_by, now});
    }
    if (watcher_.heard) watcher_.heard(vehicle, message, now);
  };
  observer.fault = [this](const FaultEvent& event) {
    const bool is_second = event.vehicle == kSecondStation;
    if (event.kind == FaultEvent::Kind::gone && !is_second) record_.lost.push_back(event.vehicle);
    if (event.vehicle == kGroundStation || is_second) {
      if (watcher_.fault) watcher_.fault(event);
      return;
    }
    const bool piloted = event.kind == FaultEvent::Kind::piloted;
    if (piloted) {
      record_.left_alone.push_back({event.vehicle, event.time, event.time + event.lasts});
    }
    if (event.kind == FaultEvent::Kind::stands_still || piloted) {
      record_.stood_still.push_back({event.vehicle, event.time, event.time + event.lasts});
    }
    if (event.kind == FaultEvent::Kind::gone || event.kind == FaultEvent::Kind::ended) {
      record_.agent_ends.push_back({event.vehicle, event.time, {}});
      for (auto* times : {&record_.left_alone, &record_.stood_still}) {
        for (checks::LeftAlone& alone : *times) {
          if (alone.vehicle == event.vehicle) alone.until = std::min(alone.until, event.time);
        }
      }
    }
    if (event.kind == FaultEvent::Kind::restarted) {
      const auto end = std::find_if(record_.agent_ends.rbegin(), record_.agent_ends.rend(),
                                    [&](const auto& e) { return e.vehicle == event.vehicle; });
      end->restarted_at = event.time;
    }
    if (watcher_.fault) watcher_.fault(event);
  };
  return observer;
}

const checks::RunRecord& TeamRecorder::finish(const TeamResult& result) {
  // Only a team that is given the time to finish what is possible is excused the rest.
  if (healing_) record_.excused = excuses(record_, result.vehicles);
  return record_;
}

}  // namespace skein::hil
