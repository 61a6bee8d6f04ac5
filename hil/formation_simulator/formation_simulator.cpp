// SPDX-License-Identifier: Apache-2.0
#include "skein/hil/formation_simulator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "airspace_judge.hpp"
#include "formation_radio.hpp"
#include "multirotor_body.hpp"
#include "skein/base/assert.hpp"
#include "skein/base/contains.hpp"
#include "skein/groundstation/formation_desk.hpp"
#include "skein/hil/fault_timeline.hpp"
#include "skein/mission/formation_agent.hpp"
#include "skein/wording/wording.hpp"

namespace skein::hil {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration kStep = milliseconds{20};  ///< of control
/// The team is at rest for so long: nothing comes any more. Longer than the ground station takes
/// to know that a vehicle is lost, and to give an order again.
constexpr Duration kIdle = seconds{30};
/// Without faults a script takes some minutes; then it is going round in circles.
constexpr Duration kLongest = std::chrono::minutes{20};
constexpr std::uint64_t kGustStream = 0x666f726d67757301;
/// Slower, a reference stands still.
constexpr double kStill_mps = 1e-3;

struct Flyer {
  FormationVehicle what;
  Duration clock{};
  MultirotorBody body;
  std::unique_ptr<mission::FormationAgent> agent;  ///< none while it is lost
  std::optional<MotionTrack> track;                ///< what its body follows
  Vec3 hover_m;                                    ///< without a track
  std::optional<Instant> restart_at;
  std::optional<Instant> sinks_at;
  std::optional<mission::MissionEvent> said;  ///< the agent's last warning in its change
  std::uint64_t lives = 0;
};

class FormationFlight {
 public:
  FormationFlight(const FormationMission& mission, const FormationObserver& observer)
      : mission_{mission},
        observer_{observer},
        radio_{mission},
        judge_{{mission.formation.separation, mission.formation.ceiling_m,
                mission.formation.tracking_m},
               ids(mission)},
        timeline_{mission.faults} {
    Random gusts{mission.seed ^ kGustStream};
    for (const FormationVehicle& vehicle : mission.vehicles) {
      flyers_.push_back({vehicle, clock_offset(mission.faults, vehicle.id),
                         MultirotorBody{vehicle.start, mission.gust_error_m, gusts.fork()}, nullptr,
                         std::nullopt, vehicle.start, std::nullopt, std::nullopt, std::nullopt, 0});
      start_agent(flyers_.back());
    }
    run_.seed = mission.seed;
  }

  Result<FormationRun> fly() {
    if (auto begun = start_desk(); !begun) return begun.error();
    while (!over()) {
      now_ += kStep;
      begin_faults();
      mend();
      deliver();
      step_desk();
      for (Flyer& flyer : flyers_) step_flyer(flyer);
      see();
    }
    finish();
    return std::move(run_);
  }

 private:
  static std::vector<VehicleId> ids(const FormationMission& mission) {
    std::vector<VehicleId> ids;
    for (const FormationVehicle& vehicle : mission.vehicles) ids.push_back(vehicle.id);
    return ids;
  }

  // --- nodes -------------------------------------------------------------------------------------

  void start_agent(Flyer& flyer) {
    mission::FormationAgentConfig config;
    config.vehicle = flyer.what.id;
    config.instance = {++flyer.lives << 32U | flyer.what.id.value};
    config.limits = mission_.formation.limits;
    config.avoidance = mission_.formation.avoidance;
    config.passage.tolerance_m = mission_.formation.tracking_m;
    flyer.agent = std::make_unique<mission::FormationAgent>(config, now_ + flyer.clock);
    flyer.said.reset();
  }

  Result<void> start_desk() {
    configuration::FormationConfig config = mission_.formation;
    // The operator goes on where the one before was.
    config.script.erase(config.script.begin(),
                        config.script.begin() + static_cast<std::ptrdiff_t>(script_done_));
    auto desk = groundstation::FormationDesk::open(config, ids(mission_), ground_now());
    if (!desk) return desk.error();
    desk_ = std::move(*desk);
    said_.reset();
    return {};
  }
  [[nodiscard]] Instant ground_now() const {
    return now_ + clock_offset(mission_.faults, kGroundStation);
  }

  Flyer& flyer_of(VehicleId id) {
    const auto found = std::find_if(flyers_.begin(), flyers_.end(),
                                    [id](const Flyer& flyer) { return flyer.what.id == id; });
    SKEIN_ASSERT(found != flyers_.end());
    return *found;
  }

  // --- faults ------------------------------------------------------------------------------------

  void begin_faults() {
    timeline_.play(
        now_, [](Role) { return std::vector<VehicleId>{}; },
        [this](const Fault& fault, const std::vector<VehicleId>& who) {
          tell(describe(fault));
          if (std::holds_alternative<ProgramsEnd>(fault.what)) end_programs(fault, who);
          return true;
        });
    if (timeline_.radio_changed()) radio_.interfere(timeline_.interference());
  }

  void end_programs(const Fault& fault, const std::vector<VehicleId>& who) {
    for (const VehicleId id : who) {
      if (id == kGroundStation) {
        lose_desk(fault);
      } else {
        lose(flyer_of(id), fault);
      }
    }
  }

  void lose_desk(const Fault& fault) {
    if (!desk_) return;
    script_done_ += desk_->script_line();
    desk_.reset();
    if (fault.lasts) desk_back_at_ = now_ + *fault.lasts;
  }

  void lose(Flyer& flyer, const Fault& fault) {
    if (!flyer.agent) return;
    flyer.agent.reset();
    flyer.restart_at.reset();
    if (fault.lasts) {
      flyer.restart_at = now_ + *fault.lasts;
      return;
    }
    ++run_.lost;
    const auto& sinks_after = std::get<ProgramsEnd>(fault.what).sinks_after;
    if (sinks_after) flyer.sinks_at = now_ + *sinks_after;
  }

  void mend() {
    for (Flyer& flyer : flyers_) {
      if (!flyer.restart_at || now_ < *flyer.restart_at) continue;
      flyer.restart_at.reset();
      tell(fmt::format("U{} is back", flyer.what.id.value));
      start_agent(flyer);
    }
    if (!desk_back_at_ || now_ < *desk_back_at_) return;
    desk_back_at_.reset();
    tell("a new ground station");
    const auto begun = start_desk();
    SKEIN_ASSERT(begun.ok());  // the same script was read before
  }

  void tell(const std::string& text) const {
    if (observer_.fault) observer_.fault(now_, text);
  }

  // --- a step ------------------------------------------------------------------------------------

  void deliver() {
    while (const auto delivery = radio_.pop_due(now_)) {
      if (delivery->to == kGroundStation) {
        if (desk_) desk_->on_message(*delivery->message, delivery->from, ground_now());
        continue;
      }
      Flyer& flyer = flyer_of(delivery->to);
      if (!flyer.agent) continue;
      flyer.agent->on_message(*delivery->message, delivery->from, now_ + flyer.clock);
      drain(flyer);
    }
  }

  void step_desk() {
    if (!desk_) return;
    desk_->on_timeout(ground_now());
    while (const auto message = desk_->poll_message()) {
      radio_.broadcast(kGroundStation, *message, now_);
    }
    while (const auto event = desk_->poll_event()) {
      if (observer_.event) observer_.event(*event);
      moved_at_ = now_;
      if (event->kind() == mission::EventKind::change_begun) {
        ++run_.changes;
        timeline_.on_change_begun(now_);
        said_.reset();
      }
      if (mission::is_warning(event->kind())) said_ = *event;
      run_.script_done = run_.script_done || event->kind() == mission::EventKind::script_done;
    }
  }

  void step_flyer(Flyer& flyer) {
    const Instant local = now_ + flyer.clock;
    if (flyer.agent) {
      VehicleState state;
      state.time = local;
      const Vec3& p = flyer.body.position_m();
      const Vec3& v = flyer.body.velocity_mps();
      state.x_m = p.x();
      state.y_m = p.y();
      state.z_m = p.z();
      state.groundspeed_mps = std::hypot(v.x(), v.y());
      state.course_rad = std::atan2(v.y(), v.x());
      state.climb_mps = v.z();
      flyer.agent->on_state(state, local);
      drain(flyer);
    }
    if (flyer.sinks_at && now_ >= *flyer.sinks_at) {
      flyer.body.sink(kStep);
      return;
    }
    const auto reference = reference_of(flyer);
    if (reference.velocity_mps.norm() > kStill_mps) moved_at_ = now_;
    flyer.body.step(reference, kStep);
  }

  [[nodiscard]] MotionTrack::Moment reference_of(const Flyer& flyer) const {
    if (!flyer.track) return {.position_m = flyer.hover_m};
    return flyer.track->at(now_ + flyer.clock);
  }

  void drain(Flyer& flyer) {
    while (const auto message = flyer.agent->poll_message()) {
      radio_.broadcast(flyer.what.id, *message, now_);
    }
    if (auto guidance = flyer.agent->poll_guidance()) {
      flyer.track = std::get<MotionTrack>(*guidance);
    }
    while (const auto event = flyer.agent->poll_event()) {
      if (observer_.event) observer_.event(*event);
      if (event->kind() == mission::EventKind::change_taken_up) flyer.said.reset();
      if (mission::is_warning(event->kind())) flyer.said = *event;
    }
  }

  void see() {
    std::vector<AirspaceJudge::Body> bodies;
    for (const Flyer& flyer : flyers_) {
      const bool sinking = flyer.sinks_at && now_ >= *flyer.sinks_at;
      const Vec3& position = flyer.body.position_m();
      const double off = (position - reference_of(flyer).position_m).norm();
      bodies.push_back({position, flyer.body.airborne(), sinking ? 0.0 : off});
      radio_.move(flyer.what.id, position);
      if (observer_.body) observer_.body(now_, flyer.what.id, position);
    }
    judge_.step(bodies, now_);
  }

  // --- the end -----------------------------------------------------------------------------------

  [[nodiscard]] bool over() const {
    if (now_ - Instant{} > kLongest) return true;
    const Instant since =
        std::max(moved_at_, run_.script_done ? Instant{} : timeline_.quiet_from());
    return now_ - since > (run_.script_done ? seconds{2} : kIdle);
  }

  void finish() {
    run_.violations = judge_.take();
    run_.least_m = judge_.least_m();
    run_.farthest_m = judge_.farthest_m();
    run_.messages = radio_.messages();
    run_.ended_at = now_;
    const auto stuck = [this](const std::string& sentence) {
      run_.violations.push_back({now_, "liveness", sentence});
    };
    if (run_.script_done) return;
    if (now_ - Instant{} > kLongest) {
      stuck("the team never comes to rest");
      return;
    }
    if (desk_) {
      if (said_) run_.reason = wording::news_of(*said_);
      if (!said_) stuck("the script stops, and the ground station does not say why");
      return;
    }
    // Without a ground station everybody comes to its place, or says what it waits for.
    run_.reason = "the ground station is lost";
    for (const Flyer& flyer : flyers_) {
      if (!flyer.agent || flyer.agent->execution() == nullptr) continue;
      if (flyer.agent->execution()->finished()) continue;
      if (!flyer.said) {
        stuck(fmt::format("U{} neither comes to its place nor says why", flyer.what.id.value));
      } else {
        run_.reason += fmt::format("; U{}: {}", flyer.what.id.value, wording::news_of(*flyer.said));
      }
    }
  }

  const FormationMission& mission_;
  const FormationObserver& observer_;
  FormationRadio radio_;
  AirspaceJudge judge_;
  FaultTimeline timeline_;
  std::vector<Flyer> flyers_;
  std::optional<groundstation::FormationDesk> desk_;
  std::optional<Instant> desk_back_at_;
  std::size_t script_done_ = 0;                ///< lines that are done, of desks before this one
  std::optional<mission::MissionEvent> said_;  ///< its last warning in the newest change
  Instant now_{};
  Instant moved_at_{};  ///< or an order was given
  FormationRun run_;
};

}  // namespace

Result<FormationRun> fly_formation(const FormationMission& mission,
                                   const FormationObserver& observer) {
  return FormationFlight{mission, observer}.fly();
}

}  // namespace skein::hil
