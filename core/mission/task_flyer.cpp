// SPDX-License-Identifier: Apache-2.0
#include "task_flyer.hpp"

#include <algorithm>
#include <utility>

#include "skein/base/assert.hpp"
#include "skein/base/overloaded.hpp"
#include "skein/planning/avoidance.hpp"
#include "skein/planning/dubins.hpp"
#include "task_timing.hpp"

namespace skein::mission {
namespace {
/// The flight plan leads past the gate only from this long before it on, when the authorisation and
/// the lease have been looked at for the last time.
constexpr Duration kCommitLead = std::chrono::seconds{1};
/// Later than this before the gate control could no longer take the new plan over in time.
constexpr Duration kCommitLatest = std::chrono::milliseconds{150};
constexpr double kRunOut = 2.0;  ///< times the lead of turns, over the site and straight on
constexpr double kLateFrom_s = 0.1;
constexpr double kLateMost_s = 1.0;
constexpr double kBeyond_s = 0.5;    ///< beyond where it is by then
constexpr double kStraight_m = 1.0;  ///< more of a plan than that behind the site runs out
/// Before its end a run is looked at once more, whether it is late.
constexpr Duration kLooksAhead = std::chrono::seconds{1};
constexpr Duration kNewsMayTake = std::chrono::milliseconds{500};
/// Of a plan and the times that it was given.
constexpr Duration kTimesAgree = std::chrono::milliseconds{20};
constexpr Duration kTimePeriod = std::chrono::seconds{1};  ///< between two looks at a task's time
/// That it has not bid is told for so long.
constexpr Duration kDeclinedFor = std::chrono::seconds{60};
/// Nearer to its time a new path would gain little.
constexpr Duration kTimeLatest = std::chrono::seconds{5};
/// What a flood from the network can make us remember.
constexpr std::size_t kRefusalsMax = 256;

/// Over that much of the plan from then until then. In still air its own speed does that.
Flight::Pace pace_over(const TimedPath& plan, double length_m, Instant from, Instant until) {
  const double takes_s = to_seconds(until - from);
  const bool differs = plan.has_wind() && length_m > 0.0 && takes_s > 0.0;
  return {differs ? length_m / takes_s : plan.speed_mps, length_m, until};
}

/// By less, nothing is changed.
double late_by_s(const Ownship& ownship, double speed_mps) {
  const double late_s = -ownship.along_m() / speed_mps;
  return late_s > kLateFrom_s ? std::min(late_s, kLateMost_s) : 0.0;
}
}  // namespace

using coalition::Reason;
using event::TaskFailure;

TaskFlyer::TaskFlyer(Ownship& ownship, Outbox& outbox)
    : ownship_{ownship},
      outbox_{outbox},
      participant_{ownship.config().protocol, ownship.spec().id, ownship.config().instance} {}

void TaskFlyer::on_message(const coalition::Message& message, Instant now) {
  std::visit(
      Overloaded{[&](const coalition::Announcement& m) { participant_.on_announcement(m, now); },
                 [&](const coalition::Award& m) { participant_.on_award(m, now); },
                 [&](const coalition::Cancel& m) { participant_.on_cancel(m, now); },
                 [&](const coalition::LeaseRenewal& m) { participant_.on_lease_renewal(m, now); },
                 [&](const coalition::MemberStatus& m) { participant_.on_status(m); },
                 [&](const coalition::LeadershipClaim& m) { participant_.on_claim(m, now); },
                 [&](const coalition::Allegiance& m) { participant_.on_allegiance(m, now); },
                 [](const coalition::Bid&) {}, [](const coalition::Confirmation&) {}},
      message);
}

void TaskFlyer::on_timeout(bool may_lead, Instant now) {
  participant_.set_may_lead(may_lead);
  participant_.on_timeout(now);
}

std::optional<coalition::Message> TaskFlyer::poll_message() { return participant_.poll_message(); }
std::optional<coalition::Participant::Output> TaskFlyer::poll_output() {
  return participant_.poll_output();
}

void TaskFlyer::answer(const Participant::Output& output, Instant now) {
  if (const auto* award = std::get_if<Participant::AwardReceived>(&output)) {
    answer_award(*award, now);
  } else if (const auto* granted = std::get_if<Participant::LeaseGranted>(&output)) {
    outbox_.report(event::LeaseGranted{granted->until}, granted->round, granted->task, now);
  } else if (const auto* ended = std::get_if<Participant::LeaseEnded>(&output)) {
    outbox_.report(event::LeaseEnded{ended->why, ended->held}, ended->round, ended->task, now);
    if (task_ && task_->assignment.task == ended->task && !ended->held) drop(now);
  } else if (const auto* released = std::get_if<Participant::Released>(&output)) {
    outbox_.report(event::Released{released->why}, released->round, {}, now);
    if (task_ && task_->round == released->round) drop(now);  // held for a successor in vain
  }
}

void TaskFlyer::answer_call(const coalition::Announcement& announcement, Reason otherwise_engaged,
                            Instant now) {
  const TaskId about{announcement.site.id, {}, 0};
  std::variant<coalition::Bid, Reason> answer{otherwise_engaged};
  if (otherwise_engaged == Reason::none) answer = make_bid(announcement, now);
  if (const auto* bid = std::get_if<coalition::Bid>(&answer)) {
    outbox_.report(event::BidSent{bid->eta}, announcement.round, about, now);
    declined_.reset();
    participant_.bid(announcement, *bid, now);
  } else {
    const auto reason = std::get<Reason>(answer);
    outbox_.report(event::BidDeclined{{reason}}, announcement.round, about, now);
    declined_ = {{announcement.round, reason}, now};
    participant_.decline(announcement);
  }
}

void TaskFlyer::tell_declined(Telemetry& telemetry, Instant now) const {
  if (!declined_ || now > declined_->at + kDeclinedFor) return;
  telemetry.declined = declined_->call;
}

std::variant<coalition::Bid, Reason> TaskFlyer::make_bid(
    const coalition::Announcement& announcement, Instant now) const {
  if (task_ && task_->in(TaskFlight::State::begun)) return Reason::task_in_progress;

  const auto can = [this](const TaskId& task) { return ownship_.can(task); };
  if (std::ranges::none_of(announcement.tasks, can)) return Reason::incapable;
  const VehicleSpec& vehicle = ownship_.spec();
  const Flight& flight = ownship_.flight();
  const Pose2 pose = flight.pose_at(announcement.formed_at);
  const double reach_m = ownship_.config().protocol.radio_range_m;
  for (const Vec2& position : {flight.pose_at(now).position(), pose.position()}) {
    if ((position - announcement.leader_at_formation).norm() > reach_m) {
      return Reason::out_of_reach;
    }
  }
  const double way =
      planning::shortest_to_point(pose, announcement.site.position, ownship_.planning_radius_m())
          .length_m();
  auto self = ownship_.candidate(pose, announcement.formed_at);
  self.range_left_m = ownship_.range_for(announcement.site, announcement.formed_at);
  if (way > self.range_left_m) return Reason::out_of_range;
  if (!ownship_.in_fence(announcement.site.position)) return Reason::outside_fence;

  coalition::Bid bid;
  bid.instance = ownship_.config().instance;
  bid.pose_at_formation = pose;
  // Against the wind it takes longer; with it, it can wait.
  bid.speed_mps =
      std::min(self.speed_mps, ownship_.even_speed_mps(pose.position(), announcement.site.position,
                                                       way / vehicle.cruise_speed_mps));
  bid.planning_radius_m = self.planning_radius_m;
  bid.range_left_m = self.range_left_m;
  bid.final_approach_m = self.final_approach_m;
  bid.assess_radius_m = self.assess_radius_m;
  bid.capabilities = self.capabilities;
  bid.loads = self.loads;
  bid.approach = ownship_.approach_time();
  bid.eta = announcement.formed_at + from_seconds(way / bid.speed_mps);
  return bid;
}

void TaskFlyer::answer_award(const Participant::AwardReceived& award, Instant now) {
  const auto refuse = [&](const Why& why) {
    outbox_.report(event::Refused{why}, award.award.round, award.mine.front().task, now);
    participant_.refuse(why, now);
  };
  if (award.mine.size() != 1) return refuse({Reason::one_task_at_a_time});
  const auto& mine = award.mine.front();
  const bool goes_on = task_ && task_->assignment.task == mine.task &&
                       task_->assignment.time == mine.time &&
                       award.award.continues.leader.value > 0;
  if (goes_on) {  // a successor's award: the path is flown already
    task_->pass_on(award.award.round);
    outbox_.report(event::Confirmed{mine.time}, task_->round, mine.task, now);
    participant_.accept(now);
    return;
  }
  // From the pose that was bid, or from where it is by now when the award came late.
  const Instant start =
      now <= award.award.formed_at ? award.award.formed_at : now + ownship_.flight().handover();
  const TaskFlight awarded{award.award.round, award.award.site, mine};
  const double even_mps =
      ownship_.even_speed_mps(ownship_.flight().pose_at(start).position(), awarded.site.position,
                              to_seconds(mine.time - start));
  auto outcome = set_out(awarded, even_mps, start, now);
  if (std::holds_alternative<Why>(outcome)) {
    outcome = set_out(awarded, ownship_.spec().cruise_speed_mps, start, now);
  }
  if (const auto* why = std::get_if<Why>(&outcome)) return refuse(*why);
  task_ = std::get<TaskFlight>(outcome);
  outbox_.report(event::Confirmed{mine.time}, task_->round, mine.task, now);
  participant_.accept(now);
}

/// The flight to that task from where the vehicle will be at `start`, which is then its flight
/// plan.
std::variant<TaskFlight, coalition::Why> TaskFlyer::set_out(TaskFlight task, double speed_mps,
                                                            Instant start, Instant now) {
  SKEIN_ASSERT(!task.in_run());
  const auto& hazards = ownship_.hazards();
  Flight& flight = ownship_.flight();
  auto self = ownship_.candidate(flight.pose_at(start), start);
  self.speed_mps = speed_mps;
  auto plan = ownship_.plan_task(self, start, task.site, task.assignment);
  if (!plan) return Why{Reason::no_path, {}, plan.error().message};
  Path path = plan->timed.path;
  if (path.length_m() + flight.way_home_m(path.end(), hazards) > ownship_.range_to_spend(start)) {
    return Why{Reason::out_of_range};
  }
  task.plan = *plan;
  std::optional<double> tail;
  Flight::Pace pace{speed_mps, plan->gate_m, plan->timed.time_at(plan->gate_m)};
  if (task.is_delivery()) {  // as far as the gate, and hold there
    const auto to_gate = plan->timed.piece(0.0, plan->gate_m);
    if (!to_gate) return Why{Reason::path_too_long};
    path = *to_gate;
    pace = pace_over(plan->timed, plan->gate_m, start, plan->timed.time_at(plan->gate_m));
    tail = flight.hold_curvature(path.end(), hazards);
  } else {
    tail = flight.orbit_after(path, plan->timed.tail_curvature_per_m, hazards);
    if (!tail) return Why{Reason::path_barred};
  }
  const Path& whole = plan->timed.path;
  const double beyond = task.is_delivery() ? flight.hold_curvature(whole.end(), hazards) : 0.0;
  if (!ownship_.stays_in_fence(whole, beyond) || !ownship_.stays_in_fence(path, *tail)) {
    return Why{Reason::outside_fence};
  }
  if (!flight.continue_with(start, path, *tail, now, pace)) {
    return Why{Reason::path_too_long};
  }
  return task;
}

/// Was this very delivery put before the operator, and may it begin yet?
bool TaskFlyer::is_granted_by(const Authorisation& message, Instant now) const {
  if (!task_ || !task_->is_delivery() || !message.granted) return false;
  const auto refused = refused_at_.find(message.site);
  if (refused != refused_at_.end() && message.decided_at <= refused->second) return false;
  if (task_->round != message.round || task_->site.id != message.site) return false;
  if (message.deliveries.empty()) return true;  // of an older release
  const TaskAssignment& ours = task_->assignment;
  const double bearing_rad = task_->site.deliveries.at(ours.task.index).bearing_rad;
  const auto is_ours = [&](const Delivery& granted) {
    return granted.assignment.task == ours.task && granted.assignment.vehicle == ours.vehicle &&
           granted.assignment.time == ours.time && granted.bearing_rad == bearing_rad;
  };
  return now <= message.until && std::ranges::any_of(message.deliveries, is_ours);
}

void TaskFlyer::on_authorisation(const Authorisation& message, Instant now) {
  if (!message.granted) return take_back(message, now);
  if (is_granted_by(message, now) && task_->grant(message.decided_at)) {
    outbox_.report(event::Authorised{message.decided_by}, message.round, task_->assignment.task,
                   now);
  }
}

/// Of whatever round it is: the operator has decided against the site. Who has no grant holds at
/// its gate anyway, until its leader releases it.
void TaskFlyer::take_back(const Authorisation& message, Instant now) {
  Instant& refused_at = refused_at_[message.site];
  refused_at = std::max(refused_at, message.decided_at);
  if (refused_at_.size() > kRefusalsMax) {  // the oldest: its grants have run out first
    refused_at_.erase(std::ranges::min_element(
        refused_at_, [](const auto& a, const auto& b) { return a.second < b.second; }));
  }
  const bool concerned = task_ && task_->site.id == message.site && !participant_.free();
  if (!concerned || !task_->can_be_taken_back(message.decided_at)) return;
  if (!task_->in(TaskFlight::State::begun)) {
    outbox_.report(event::AuthorisationWithdrawn{message.decided_by}, message.round,
                   task_->assignment.task, now);
  }
  leave_site(message.site, Reason::grant_taken_back, now);
}

void TaskFlyer::leave_site(SiteId site, Reason why, Instant now) {
  if (!task_ || task_->site.id != site) return;
  if (task_->is_delivery() && task_->in(TaskFlight::State::begun)) {
    participant_.finish_alone();
  } else {
    participant_.withdraw(why, now);
  }
}

bool TaskFlyer::detour(HazardId hazard, Instant now) {
  if (!task_ || task_->in_run()) return false;
  const auto outcome =
      set_out(*task_, task_->plan.timed.speed_mps, now + ownship_.flight().handover(), now);
  const auto* task = std::get_if<TaskFlight>(&outcome);
  if (task == nullptr) return false;
  task_ = *task;
  outbox_.report(event::PlanDetoured{hazard}, task_->round, task_->assignment.task, now);
  return true;
}

void TaskFlyer::fly_begun(Instant now) {
  if (task_ && task_->in(TaskFlight::State::begun)) fly(now);
}

void TaskFlyer::fly(Instant now) {
  if (!task_) return;
  keep_time(now);
  if (task_->is_delivery()) commit_delivery(now);
  const bool due = !task_->in(TaskFlight::State::begun) && now >= task_->begin_time();
  if (due) begin(now);
  if (task_->in(TaskFlight::State::begun) && !task_->is_delivery()) {
    const double radius_m = ownship_.spec().assess_radius_m;
    task_->strayed = task_->strayed || !ownship_.on_arc(task_->site.position, radius_m);
  }
  if (!task_->in(TaskFlight::State::begun)) return;
  if (task_->is_delivery() && now >= task_->end_time() - kLooksAhead) run_on(now);
  if (now < task_->over_time()) return;
  task_->unlocated = !ownship_.was_located(task_->over_time());
  if (now >= task_->told_time()) end(now);
}

/// Where the wind takes more than the vehicle's speed has, another path keeps the time: at a speed
/// over the ground that the wind lets it have.
void TaskFlyer::keep_time(Instant now) {
  // A copter is flown by position: on time wherever it can be at all.
  if (ownship_.spec().is_copter()) return;
  const Instant time = task_->assignment.time;
  if (task_->in_run() || now < time_again_ || time - now < kTimeLatest) return;
  time_again_ = now + kTimePeriod;
  if (!is_untimely(ownship_, *task_, now)) return;
  const Instant start = now + ownship_.flight().handover();
  if (const auto speed_mps = timely_speed(ownship_, *task_, start)) {
    const auto outcome = set_out(*task_, *speed_mps, start, now);
    if (const auto* task = std::get_if<TaskFlight>(&outcome)) {
      task_ = *task;
      outbox_.report(event::PlanRetimed{*speed_mps}, task_->round, task_->assignment.task, now);
      return;
    }
  }
  if (std::exchange(task_->untimely, true)) return;
  outbox_.report(event::VehicleTrouble{event::Trouble::untimely}, task_->round,
                 task_->assignment.task, now);
}

bool TaskFlyer::run_is_open() const {
  if (!task_ || task_->in_run()) return true;
  const TimedPath& timed = task_->plan.timed;
  const auto run = timed.piece(task_->plan.gate_m, timed.path.length_m());
  return run && planning::is_clear(*run, ownship_.hazards()) && ownship_.config().fence.holds(*run);
}

void TaskFlyer::commit_delivery(Instant now) {
  const Instant gate = task_->begin_time();
  const bool in_time = now >= gate - kCommitLead && now <= gate - kCommitLatest;
  if (!in_time || !task_->accepts(TaskFlight::Event::committed)) return;
  if (!ownship_.was_located(now)) return;
  if (!participant_.holds(task_->assignment.task, now, task_->end_time())) return;
  if (!run_is_open()) return;
  SKEIN_ASSERT(task_->authorised());
  const Flight& flight = ownship_.flight();
  const auto& timed = task_->plan.timed;
  const Instant at = std::max(now, timed.start_time);
  double begin_m = timed.distance_at(at);
  // The wind has changed since, and the flight's own times count with the mean as far as the gate.
  if (const TimedPath& flown = flight.plan().timed; flown.has_wind()) {
    const double to_gate_m = flown.path.length_m() - flown.distance_at(at);
    begin_m = std::clamp(task_->plan.gate_m - to_gate_m, 0.0, task_->plan.gate_m);
  }
  auto rest = timed.piece(begin_m, timed.path.length_m());
  if (rest && fly_run(*std::move(rest), timed, at, now)) {
    task_->fire(TaskFlight::Event::committed);
  }
}

/// From `at` on what is left of `timed` as far as the site, over it on time, and beyond. False, and
/// nothing changed, where that has too many pieces.
bool TaskFlyer::fly_run(Path rest, const TimedPath& timed, Instant at, Instant now) {
  const Flight::Pace pace = pace_over(timed, rest.length_m(), at, task_->assignment.time);
  run_out(rest, timed.speed_mps);
  Flight& flight = ownship_.flight();
  const double tail = flight.hold_curvature(rest.end(), ownship_.hazards());
  return flight.continue_with(at, rest, tail, now, pace);
}

/// Straight on over the site: a turn away that begins on time is flown before it by who is late,
/// and over it by who begins turns early. Where there is no room for it, less, or none.
void TaskFlyer::run_out(Path& path, double speed_mps) const {
  const double early_s = kRunOut * ownship_.config().turn_lead_s;
  const double late_s = late_by_s(ownship_, speed_mps);
  const double longest_s = late_s > 0.0 ? early_s + late_s + kBeyond_s : early_s;
  for (const double run_s : {longest_s, early_s}) {
    if (run_s <= 0.0) return;
    const Segment straight{0.0, run_s * speed_mps};
    Path beyond{path.end(), {}};
    (void)beyond.append(straight);
    const double orbit = ownship_.flight().hold_curvature(beyond.end(), ownship_.hazards());
    if (!planning::is_clear(beyond, ownship_.hazards())) continue;
    if (!ownship_.stays_in_fence(beyond, orbit)) continue;
    (void)path.append(straight);  // without room for it the turn follows at once
    return;
  }
}

/// Whom the wind has made late since it committed.
void TaskFlyer::run_on(Instant now) {
  if (task_->late > Duration{}) return;
  const Flight& flight = ownship_.flight();
  const TimedPath& flown = flight.plan().timed;
  const double late_s = late_by_s(ownship_, flown.speed_mps);
  const Duration late = from_seconds(late_s);
  // What has begun is done under its lease, or at its time.
  if (late_s == 0.0 || !participant_.holds(task_->assignment.task, now, task_->end_time() + late))
    return;
  task_->late = late;
  const Instant at = now + flight.handover();
  const double begin_m = flown.distance_at(at);
  const bool runs_out = flown.path.length_m() > flown.on_time_m + kStraight_m;
  if (runs_out || begin_m >= flown.on_time_m) return;
  if (auto rest = flown.piece(begin_m, flown.path.length_m())) {
    fly_run(*std::move(rest), flown, at, now);
  }
}

void TaskFlyer::begin(Instant now) {
  if (task_->in(TaskFlight::State::late)) return;
  const TaskId id = task_->assignment.task;
  const bool may_begin = task_->is_delivery()
                             ? task_->in(TaskFlight::State::committed)
                             : participant_.holds(id, now, now) && deliveries_over();
  if (may_begin) {
    task_->fire(TaskFlight::Event::began);
    outbox_.report(event::TaskStarted{task_->begin_time()}, task_->round, id, task_->begin_time());
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
  outbox_.report(event::AuthorisationLate{why}, task_->round, id, now);
}

void TaskFlyer::end(Instant now) {
  const bool lost = task_->unlocated || task_->strayed;
  const bool flown = !lost && ownship_.on_track(task_->plan.timed);
  if (task_->is_delivery()) ownship_.use_load();
  task_->fire(TaskFlight::Event::finished);
  const TaskFlight task = *std::exchange(task_, std::nullopt);
  const TaskId id = task.assignment.task;
  const Instant planned = task.assignment.time;
  if (flown) {
    outbox_.report(event::TaskDone{planned}, task.round, id, task.end_time());
    participant_.task_done(id, task.end_time(), now);  // however late the wind made it
  } else {
    outbox_.report(ownship_.off_path(task.over_time(), planned), task.round, id, task.end_time());
    participant_.task_failed(id, now);
  }
}

/// An assessment waits until the leader or who flew them has said so of all deliveries. They may
/// have been flown later than its round had them.
bool TaskFlyer::deliveries_over() const {
  const Site& site = task_->site;
  for (std::size_t i = 0; i < site.deliveries.size(); ++i) {
    const TaskId delivery{site.id, TaskKind::deliver, static_cast<std::uint8_t>(i)};
    const auto over = participant_.over(delivery);
    if (!over) return false;
    const Duration room = over->told_by_owner ? kTimesAgree : kNewsMayTake;
    if (over->since > task_->begin_time() + room - site.assess_wait) return false;
  }
  return true;
}

/// The lease has gone: the plan must lead past no gate.
void TaskFlyer::drop(Instant now) {
  const bool leads_on = task_->in_run() || !task_->is_delivery();
  if (task_->in(TaskFlight::State::begun) && task_->is_delivery()) {
    ownship_.use_load();  // it counts as used
    outbox_.report(event::TaskFailed{TaskFailure::released_within, task_->assignment.time},
                   task_->round, task_->assignment.task, now);
  }
  task_->fire(TaskFlight::Event::dropped);
  task_.reset();
  if (leads_on) ownship_.hold(now);
}

Instant TaskFlyer::next_timeout() const {
  const Instant next = participant_.next_timeout();
  if (!task_ || task_->in(TaskFlight::State::late))
    return next;  // who is late waits for its leader
  const bool begun = task_->in(TaskFlight::State::begun);
  return std::min(next, begun ? task_->told_time() : task_->begin_time());
}

Instant TaskFlyer::quiet_until(bool may_lead, Instant now) const {
  Instant next = std::min(next_timeout(), participant_.quiet_until(may_lead));
  if (!task_) return next;
  const bool keeps_time = !ownship_.spec().is_copter() && !task_->in_run() &&
                          std::max(now, time_again_) <= task_->assignment.time - kTimeLatest;
  if (keeps_time) next = std::min(next, time_again_);
  if (task_->accepts(TaskFlight::Event::committed)) {
    next = std::min(next, task_->begin_time() - kCommitLead);
  }
  if (delivers() && task_->in(TaskFlight::State::begun)) {
    next = std::min(next, task_->end_time() - kLooksAhead);
  }
  return next;
}

}  // namespace skein::mission
