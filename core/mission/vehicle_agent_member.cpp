// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <utility>

#include "skein/base/angles.hpp"
#include "skein/planning/avoidance.hpp"
#include "skein/planning/dubins.hpp"
#include "vehicle_agent_impl.hpp"

namespace skein::mission {
namespace {
/// The flight plan leads past the gate only from this long before it on, when the authorisation and
/// the lease have been looked at for the last time.
constexpr Duration kCommitLead = std::chrono::seconds{1};
/// Later than this before the gate control could no longer take the new plan over in time.
constexpr Duration kCommitLatest = std::chrono::milliseconds{150};
/// A plan that starts now, for an award that came after the agreed moment.
constexpr Duration kLateStart = std::chrono::milliseconds{200};
/// At least, between two looks at the range left. What is flown in it twice is less than an orbit.
constexpr Duration kRangePeriod = std::chrono::seconds{1};
constexpr std::size_t kGrantsMax = 64;
constexpr Duration kNewsMayTake = std::chrono::milliseconds{500};
}  // namespace

using coalition::Participant;
using coalition::Reason;
using event::TaskFailure;

void VehicleAgent::Impl::answer(const Participant::Output& output, Instant now) {
  if (const auto* wanted = std::get_if<Participant::BidWanted>(&output)) {
    answer_bid_wanted(wanted->announcement, now);
  } else if (const auto* award = std::get_if<Participant::AwardReceived>(&output)) {
    answer_award(*award, now);
  } else if (const auto* granted = std::get_if<Participant::LeaseGranted>(&output)) {
    report(event::LeaseGranted{granted->until}, granted->round, granted->task, now);
  } else if (const auto* ended = std::get_if<Participant::LeaseEnded>(&output)) {
    report(event::LeaseEnded{ended->why, ended->held}, ended->round, ended->task, now);
    if (task_ && task_->assignment.task == ended->task && !ended->held) drop_task(now);
  } else if (const auto* released = std::get_if<Participant::Released>(&output)) {
    report(event::Released{released->why}, released->round, {}, now);
    if (task_ && task_->round == released->round) drop_task(now);  // held for a successor in vain
  } else if (const auto* won = std::get_if<Participant::LeadershipWon>(&output)) {
    take_over(*won, now);
  }
}

void VehicleAgent::Impl::answer_bid_wanted(const coalition::Announcement& announcement,
                                           Instant now) {
  const TaskId about{announcement.site.id, {}, 0};
  const auto answer = make_bid(announcement, now);
  if (const auto* bid = std::get_if<coalition::Bid>(&answer)) {
    report(event::BidSent{bid->eta}, announcement.round, about, now);
    participant_.bid(announcement, *bid, now);
  } else {
    const auto reason = std::get<Reason>(answer);
    report(event::BidDeclined{{reason}}, announcement.round, about, now);
    participant_.decline(announcement);
  }
}

std::variant<coalition::Bid, Reason> VehicleAgent::Impl::make_bid(
    const coalition::Announcement& announcement, Instant now) const {
  const bool own = initiator_ && announcement.round.coalition == initiator_->round().coalition;
  if (!failsafe_.in(Failsafe::Action::none)) return failsafe_.reason();
  if (survey_) return Reason::surveying;
  if (initiator_ && !own) return Reason::leading;
  if (task_ && task_->in(TaskFlight::State::begun)) return Reason::task_in_progress;

  const auto& vehicle = config_.vehicle;
  const auto can = [&](const TaskId& t) {
    return vehicle.capabilities.has(t.kind) && (t.kind != TaskKind::deliver || loads_ > 0);
  };
  if (std::none_of(announcement.tasks.begin(), announcement.tasks.end(), can)) {
    return Reason::incapable;
  }
  const Pose2 pose = flight_.pose_at(announcement.formed_at);
  for (const Vec2& position : {flight_.pose_at(now).position(), pose.position()}) {
    if ((position - announcement.leader_at_formation).norm() > config_.protocol.radio_range_m) {
      return Reason::out_of_reach;
    }
  }
  const double way =
      planning::shortest_to_point(pose, announcement.site.position, vehicle.planning_radius_m())
          .length_m();
  auto self = candidate(pose, announcement.formed_at);
  self.range_left_m = range_for(announcement.site, announcement.formed_at);
  if (way > self.range_left_m) return Reason::out_of_range;

  coalition::Bid bid;
  bid.instance = config_.instance;
  bid.pose_at_formation = pose;
  bid.speed_mps = self.speed_mps;
  bid.planning_radius_m = self.planning_radius_m;
  bid.range_left_m = self.range_left_m;
  bid.final_approach_m = self.final_approach_m;
  bid.assess_radius_m = self.assess_radius_m;
  bid.capabilities = self.capabilities;
  bid.loads = self.loads;
  bid.eta = announcement.formed_at + from_seconds(way / vehicle.cruise_speed_mps);
  return bid;
}

/// What a task at that site may use up, so that it can come home from any end of it.
double VehicleAgent::Impl::range_for(const Site& site, Instant at) const {
  if (!comes_home()) return range_to_spend(at);
  const auto& vehicle = config_.vehicle;
  const Pose2 there{site.position.x(), site.position.y(), 0.0};
  const double turn_m = kTwoPi * vehicle.planning_radius_m();
  return range_to_spend(at) - flight_.way_home_m(there, hazards_) - vehicle.assess_radius_m -
         turn_m;
}

planning::Candidate VehicleAgent::Impl::candidate(const Pose2& pose, Instant at) const {
  const auto& vehicle = config_.vehicle;
  return {vehicle.id,
          pose,
          vehicle.cruise_speed_mps,
          vehicle.planning_radius_m(),
          range_left(at),
          vehicle.final_approach_m,
          vehicle.assess_radius_m,
          vehicle.capabilities,
          loads_};
}

void VehicleAgent::Impl::answer_award(const Participant::AwardReceived& award, Instant now) {
  const auto refuse = [&](const coalition::Why& why) {
    report(event::Refused{why}, award.award.round, award.mine.front().task, now);
    participant_.refuse(why, now);
  };
  if (award.mine.size() != 1) return refuse({Reason::one_task_at_a_time});
  const auto& mine = award.mine.front();
  const bool goes_on = task_ && task_->assignment.task == mine.task &&
                       task_->assignment.time == mine.time &&
                       award.award.continues.leader.value > 0;
  if (goes_on) {  // a successor's award: the path is flown already
    task_->pass_on(award.award.round);
    report(event::Confirmed{mine.time}, task_->round, mine.task, now);
    participant_.accept(now);
    return;
  }
  // From the pose that was bid, or from where it is by now when the award came late.
  const Instant start = now <= award.award.formed_at ? award.award.formed_at : now + kLateStart;
  const auto outcome = set_out({award.award.round, award.award.site, mine},
                               config_.vehicle.cruise_speed_mps, start, now);
  if (const auto* why = std::get_if<coalition::Why>(&outcome)) return refuse(*why);
  task_ = std::get<TaskFlight>(outcome);
  report(event::Confirmed{mine.time}, task_->round, mine.task, now);
  participant_.accept(now);
}

/// The flight to that task from where the vehicle will be at `start`, which is then its flight
/// plan.
std::variant<TaskFlight, coalition::Why> VehicleAgent::Impl::set_out(TaskFlight task,
                                                                     double speed_mps,
                                                                     Instant start, Instant now) {
  const Pose2 pose = flight_.pose_at(start);
  auto self = candidate(pose, start);
  self.speed_mps = speed_mps;
  auto plan =
      planning::plan_task(config_.planning, self, start, task.site, task.assignment, hazards_);
  if (!plan) return coalition::Why{Reason::no_path, {}, plan.error().message};
  Path path = plan->timed.path;
  if (path.length_m() + flight_.way_home_m(path.end(), hazards_) > range_to_spend(start)) {
    return coalition::Why{Reason::out_of_range};
  }
  task.plan = *plan;
  double tail = plan->timed.tail_curvature_per_m;
  if (task.is_delivery()) {  // as far as the gate, and hold there
    const auto to_gate = plan->timed.piece(0.0, plan->gate_m);
    if (!to_gate) return coalition::Why{Reason::path_too_long};
    path = *to_gate;
    tail = flight_.hold_curvature(path.end(), hazards_);
  }
  if (!flight_.continue_with(start, path, tail, now, speed_mps))
    return coalition::Why{Reason::path_too_long};
  return task;
}

void VehicleAgent::Impl::on_authorisation(const Authorisation& message, Instant now) {
  if (message.granted &&
      std::find(granted_.begin(), granted_.end(), message.round) == granted_.end()) {
    granted_.push_back(message.round);
    if (granted_.size() > kGrantsMax) granted_.erase(granted_.begin());
  }
  if (task_ && task_->is_delivery() && task_->round == message.round && message.granted &&
      task_->site.id == message.site && task_->grant()) {
    report(event::Authorised{message.decided_by}, message.round, task_->assignment.task, now);
  }
  if (!message.granted) sites_.close(message.site);
  // A grant counts for the rounds before this one too: a member may have heard it and begun.
  if (initiator_ && message.granted && message.round.coalition == initiator_->round().coalition) {
    initiator_->authorised(message.round);
  }
  if (!initiator_ || !request_ || message.round != request_->round) return;
  request_.reset();
  if (message.granted) return;
  report(event::AuthorisationRefused{message.decided_by}, message.round,
         {message.site, TaskKind::deliver, 0}, now);
  initiator_->close({Reason::refused_by_operator}, now);
  stop_leading(now);
}

void VehicleAgent::Impl::commit_delivery(Instant now) {
  const Instant gate = task_->begin_time();
  const bool in_time = now >= gate - kCommitLead && now <= gate - kCommitLatest;
  if (!in_time || !task_->accepts(TaskFlight::Event::committed)) return;
  if (!participant_.holds(task_->assignment.task, now, task_->end_time())) return;
  const auto& timed = task_->plan.timed;
  const Instant at = std::max(now, timed.start_time);
  const auto rest = timed.piece(timed.distance_at(at), timed.path.length_m());
  if (!rest) return;
  const double tail = flight_.hold_curvature(timed.path.end(), hazards_);
  if (flight_.continue_with(at, *rest, tail, now, timed.speed_mps)) {
    task_->fire(TaskFlight::Event::committed);
  }
}

void VehicleAgent::Impl::fly_task(Instant now) {
  keep_time(now);
  if (task_->is_delivery()) commit_delivery(now);
  const bool due = !task_->in(TaskFlight::State::begun) && now >= task_->begin_time();
  if (due) begin_task(now);
  if (task_->in(TaskFlight::State::begun) && now >= task_->end_time()) end_task(now);
}

void VehicleAgent::Impl::begin_task(Instant now) {
  if (task_->in(TaskFlight::State::late)) return;
  const TaskId id = task_->assignment.task;
  const bool may_begin = task_->is_delivery()
                             ? task_->in(TaskFlight::State::committed)
                             : participant_.holds(id, now, now) && deliveries_over(*task_);
  if (may_begin) {
    task_->fire(TaskFlight::Event::began);
    report(event::TaskStarted{task_->begin_time()}, task_->round, id, task_->begin_time());
    participant_.task_started(id, now);
    return;
  }
  // News of the last delivery may come a moment after the arc has begun.
  if (!task_->is_delivery() && now < task_->begin_time() + kNewsMayTake) return;
  using event::Lateness;
  const Lateness why = !task_->is_delivery() ? Lateness::not_certain
                       : task_->authorised() ? Lateness::lease_too_short
                                             : Lateness::not_authorised;
  task_->fire(TaskFlight::Event::missed);
  report(event::AuthorisationLate{why}, task_->round, id, now);
}

void VehicleAgent::Impl::end_task(Instant now) {
  const bool flown = on_track(task_->plan.timed);
  if (task_->is_delivery() && loads_ > 0) --loads_;
  task_->fire(TaskFlight::Event::finished);
  const TaskFlight task = *std::exchange(task_, std::nullopt);
  const TaskId id = task.assignment.task;
  const Instant planned = task.assignment.time;
  if (flown) {
    report(event::TaskDone{planned}, task.round, id, task.end_time());
    participant_.task_done(id, now);
  } else {
    report(event::TaskFailed{TaskFailure::off_path, planned}, task.round, id, task.end_time());
    participant_.task_failed(id, now);
  }
}

/// An assessment waits until the leader or who flew them has said so of all deliveries. They may
/// have been flown later than its round had them.
bool VehicleAgent::Impl::deliveries_over(const TaskFlight& assessment) const {
  const Site& site = assessment.site;
  for (std::size_t i = 0; i < site.deliveries.size(); ++i) {
    const TaskId delivery{site.id, TaskKind::deliver, static_cast<std::uint8_t>(i)};
    const auto since = participant_.over_since(delivery);
    if (!since || *since > assessment.begin_time() + kNewsMayTake - site.assess_wait) return false;
  }
  return true;
}

/// The lease has gone: the plan must lead past no gate.
void VehicleAgent::Impl::drop_task(Instant now) {
  const bool leads_on = task_->in_run() || !task_->is_delivery();
  if (task_->in(TaskFlight::State::begun) && task_->is_delivery()) {
    if (loads_ > 0) --loads_;  // it counts as used
    report(event::TaskFailed{TaskFailure::released_within, task_->assignment.time}, task_->round,
           task_->assignment.task, now);
  }
  task_->fire(TaskFlight::Event::dropped);
  task_.reset();
  if (leads_on) flight_.hold(hazards_, now);
}

void VehicleAgent::Impl::on_command(const Command& message, Instant now) {
  const bool mine = message.vehicle == config_.vehicle.id || message.vehicle == kGroundStation;
  if (!mine || message.number <= last_command_ || !flight_.started()) return;
  last_command_ = message.number;
  report(event::Commanded{message.kind}, {}, {}, now);
  if (message.kind == CommandKind::give_back) return;  // of the flight controller
  if (message.kind == CommandKind::resume) {
    note(&Failsafe::Facts::ordered, false);
    if (!task_ && !survey_) search(now);
    return;
  }
  note(&Failsafe::Facts::ordered, true);
  const bool home = message.kind == CommandKind::return_home;
  participant_.withdraw(home ? Reason::sent_home : Reason::held_by_operator, now);
  if (initiator_) {
    surveyed_.push_back(initiator_->site());
    initiator_->close({Reason::held_by_operator}, now);
    stop_leading(now);
  }
  if (survey_ && !survey_->relief) found_.push_back({survey_->site});
  survey_.reset();
  pump(now);
  if (home) {
    flight_.fly_home(hazards_, now);
  } else {
    flight_.hold(hazards_, now);
  }
}

void VehicleAgent::Impl::on_hazard(const Hazard& hazard, Instant now) {
  const auto same = [&](const Hazard& h) { return h.id == hazard.id; };
  if (std::any_of(hazards_.begin(), hazards_.end(), same)) return;
  hazards_.push_back(hazard);
  range_again_ = now;  // the way home may be longer by it
  report(event::HazardKnown{hazard.id, hazard.radius_m}, {}, {}, now);
  if (!flight_.started()) return;
  if (flight_.keeps_clear(hazards_, now)) return;
  if (flight_.searching() || flight_.homing()) {
    flight_.homing() ? flight_.fly_home(hazards_, now) : search(now);
    return;
  }
  // Its way is barred. Another way to the same time disturbs nobody; without one the task goes back
  // to the leader, who times the coalition anew.
  const bool under_way = task_ && !task_->in_run();
  std::variant<TaskFlight, coalition::Why> detour;
  if (under_way) {
    detour = set_out(*task_, task_->plan.timed.speed_mps, now + kLateStart, now);
  }
  if (under_way && std::holds_alternative<TaskFlight>(detour)) {
    task_ = std::get<TaskFlight>(detour);
    report(event::PlanDetoured{hazard.id}, task_->round, task_->assignment.task, now);
  } else {
    // A task, a survey or a route is flown on where the hazard is near but does not bar the way.
    const auto& timed = flight_.plan().timed;
    const double ahead = timed.distance_at(now);
    const auto rest = timed.piece(ahead, std::max(ahead, timed.path.length_m()));
    const bool bound = task_ || survey_ || flight_.en_route(now);
    if (bound && rest && planning::is_clear(*rest, hazards_)) return;
    participant_.withdraw(Reason::path_barred, now);
    pump(now);
    flight_.hold(hazards_, now);
  }
}

void VehicleAgent::Impl::note(bool Failsafe::Facts::*fact, bool holds) {
  facts_.*fact = holds;
  failsafe_.update(facts_);
}

/// Nothing to do: search on, or take up a site that waits.
void VehicleAgent::Impl::idle(Instant now) {
  if (failsafe_.in(Failsafe::Action::obey) || task_ || survey_ || !participant_.free()) return;
  if (flight_.en_route(now)) return;
  if (failsafe_.in(Failsafe::Action::come_home)) {
    if (comes_home() && !flight_.homing()) flight_.fly_home(hazards_, now);
    return;
  }
  if (initiator_) return;  // it keeps circling its site
  take_up_site(now);
  if (!survey_ && !initiator_) take_up_lost_site(now);
  if (!survey_ && !initiator_ && !flight_.searching()) search(now);
}

void VehicleAgent::Impl::search(Instant now) {
  if (!facts_.range_spent) {
    flight_.search(hazards_, range_to_spend(now), now);
  } else if (!comes_home()) {
    flight_.hold(hazards_, now);
  } else if (!flight_.homing()) {
    flight_.fly_home(hazards_, now);
  }
}

bool VehicleAgent::Impl::comes_home() const { return config_.vehicle.recovery == Recovery::home; }

/// While it still can it turns for home (or holds, to be recovered), whatever it was about. Only a
/// run that has begun is flown to its end: that was planned with the way home.
void VehicleAgent::Impl::watch_range(Instant now) {
  if (facts_.range_spent) hand_on_lead(now);
  if (facts_.range_spent || now < range_again_ || (task_ && task_->in_run())) return;
  // A metre of flight brings it at most a metre further from home.
  const double spare_s = spare_range(now) / (2.0 * config_.vehicle.cruise_speed_mps);
  range_again_ = now + std::max(kRangePeriod, from_seconds(spare_s));
  if (spare_s > 0.0) return;
  note(&Failsafe::Facts::range_spent, true);
  report(event::RangeSpent{range_left(now), comes_home()}, {}, {}, now);
  participant_.withdraw(Reason::out_of_range, now);
  if (survey_ && !survey_->relief) found_.push_back({survey_->site});
  survey_.reset();
  pump(now);
  hand_on_lead(now);
  search(now);
}

/// Who is on the way home leads as long as others fly what it awarded. Then its silence tells the
/// others to take the site up.
void VehicleAgent::Impl::hand_on_lead(Instant now) {
  if (!initiator_ || !initiator_->owned().empty()) return;
  const coalition::Why why{Reason::out_of_range};
  report(event::Cancelled{why}, initiator_->round(), {initiator_->site().id, {}, 0}, now);
  initiator_->close(why, now);
  stop_leading(now);
}

}  // namespace skein::mission
