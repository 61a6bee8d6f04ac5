// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/formation_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "airspace_judge.hpp"
#include "skein/hil/judged_runs.hpp"
#include "skein/hil/run_parallel.hpp"
#include "skein/wording/wording.hpp"

namespace skein::hil {
namespace {

/// What a judge of the flight sees, and what is told about it.
class FormationWatch {
 public:
  FormationWatch(const TeamMission& mission, const TeamObserver& watcher)
      : watcher_{watcher},
        longest_{mission.duration_max},
        place_rms_m_{mission.faults.empty() ? mission.place_rms_m : 0.0},
        judge_{{mission.formation->separation, mission.formation->ceiling_m,
                mission.formation->tracking_m}} {
    run_.seed = mission.seed;
  }
  ~FormationWatch() = default;
  FormationWatch(const FormationWatch&) = delete;
  FormationWatch& operator=(const FormationWatch&) = delete;

  /// Refers to this object.
  TeamObserver observer() {
    TeamObserver observer = watcher_;
    observer.event = [this](const mission::MissionEvent& event) {
      on_event(event);
      if (watcher_.event) watcher_.event(event);
    };
    observer.fault = [this](const FaultEvent& event) {
      const bool lost = event.kind == FaultEvent::Kind::gone && event.vehicle != kGroundStation;
      run_.lost += lost ? 1 : 0;
      if (event.kind == FaultEvent::Kind::restarted) said_.erase(event.vehicle);
      if (watcher_.fault) watcher_.fault(event);
    };
    observer.bodies = [this](Instant now, const std::vector<SeenBody>& bodies) {
      judge_.step(bodies, now);
      if (holds_ && place_rms_m_ > 0.0) judge_places(bodies, now);
      if (watcher_.bodies) watcher_.bodies(now, bodies);
    };
    return observer;
  }

  FormationRun finish(const TeamResult& result) {
    run_.violations = judge_.take();
    tell_of_places();
    run_.least_m = judge_.least_m();
    run_.farthest_m = judge_.farthest_m();
    run_.messages = result.messages;
    run_.ended_at = result.ended_at;
    if (!run_.script_done) explain(result);
    return std::move(run_);
  }

 private:
  struct Offs {
    double squares_m2 = 0.0;
    std::size_t count = 0;
    [[nodiscard]] double rms_m() const {
      return count == 0 ? 0.0 : std::sqrt(squares_m2 / static_cast<double>(count));
    }
  };

  void judge_places(const std::vector<SeenBody>& bodies, Instant now) {
    for (const SeenBody& body : bodies) {
      Offs& offs = offs_[body.vehicle];
      offs.squares_m2 += body.off_m * body.off_m;
      ++offs.count;
    }
    judged_at_ = now;
  }

  void tell_of_places() {
    for (const auto& [vehicle, offs] : offs_) {
      run_.worst_rms_m = std::max(run_.worst_rms_m, offs.rms_m());
      if (offs.rms_m() <= place_rms_m_) continue;
      run_.violations.push_back(
          {judged_at_, "place",
           fmt::format("U{} was {:.2f} m rms from its place while the formation held; {:g} m are "
                       "allowed",
                       vehicle.value, offs.rms_m(), place_rms_m_)});
    }
  }

  void on_event(const mission::MissionEvent& event) {
    using mission::EventKind;
    if (event.kind() == EventKind::change_begun) {
      ++run_.changes;
      holds_ = false;
    }
    holds_ = holds_ || event.kind() == EventKind::formation_held;
    if (event.kind() == EventKind::change_taken_up) said_.erase(event.vehicle);
    if (mission::is_warning(event.kind())) said_.insert_or_assign(event.vehicle, event);
    run_.script_done = run_.script_done || event.kind() == EventKind::script_done;
  }

  /// Who does not come to the end has to say why.
  void explain(const TeamResult& result) {
    const auto stuck = [&](const std::string& sentence) {
      run_.violations.push_back({result.ended_at, "liveness", sentence});
    };
    if (result.ended_at - Instant{} >= longest_) {
      stuck("the team never comes to rest");
      return;
    }
    if (!result.ground_gone) {
      if (result.ground_warning) {
        run_.reason = wording::news_of(*result.ground_warning);
      } else {
        stuck("the script stops, and the ground station does not say why");
      }
      return;
    }
    // Without a ground station everybody comes to its place, or says what it waits for.
    run_.reason = "the ground station is lost";
    for (const VehicleEnd& end : result.vehicles) {
      if (end.in_place) continue;
      const auto said = said_.find(end.vehicle);
      if (said == said_.end()) {
        stuck(fmt::format("U{} neither comes to its place nor says why", end.vehicle.value));
      } else {
        run_.reason += fmt::format("; U{}: {}", end.vehicle.value, wording::news_of(said->second));
      }
    }
  }

  const TeamObserver& watcher_;
  Duration longest_;
  double place_rms_m_;
  bool holds_ = false;
  Instant judged_at_{};
  std::map<VehicleId, Offs> offs_;
  AirspaceJudge judge_;
  std::map<VehicleId, mission::MissionEvent> said_;  ///< its last warning in its newest change
  FormationRun run_;
};

}  // namespace

Result<FormationRun> fly_formation(const TeamMission& mission, const TeamObserver& watcher) {
  if (const auto script = check_script(mission); !script) return script.error();
  FormationWatch watch{mission, watcher};
  return watch.finish(simulate_team(mission, watch.observer()));
}

Result<std::vector<FormationRun>> fly_formations(
    const configuration::Scenario& scenario, const FormationSeries& series,
    const std::function<void(const FormationRun&)>& on_done) {
  const auto fly = [&](std::size_t i) -> Result<FormationRun> {
    const auto mission = seeded_mission(scenario, series.first_seed + i, series.faults);
    if (!mission) return mission.error();
    return fly_formation(*mission);
  };
  return run_parallel<FormationRun>(series.runs, series.jobs, fly, on_done);
}

}  // namespace skein::hil
