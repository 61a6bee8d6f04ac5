// SPDX-License-Identifier: Apache-2.0
#include "skein/coalition/participant.hpp"

#include <algorithm>
#include <utility>

#include "skein/base/assert.hpp"
#include "skein/base/contains.hpp"

namespace skein::coalition {
namespace {
/// How long a finished task is reported to a leader that does not say that it knows.
constexpr Duration kReportFinishedFor = std::chrono::seconds{300};
/// What was done here is remembered, for leaders that do not know; the oldest goes first.
constexpr std::size_t kFinishedMax = 64;
constexpr std::size_t kOverMax = 256;

bool is_by_operator(Reason reason) {
  return reason == Reason::site_withdrawn || reason == Reason::grant_taken_back ||
         reason == Reason::refused_by_operator;
}
}  // namespace

Participant::Participant(const ProtocolParams& params, VehicleId self, InstanceId instance)
    : params_{params}, self_{self}, instance_{instance}, elector_{params, self, instance} {}

void Participant::on_announcement(const Announcement& message, Instant now) {
  if (!makes_sense(message, now)) {
    ++bad_messages_;
    return;
  }
  // A leader that announces what is done here has not heard of it: it is told again, and gets no
  // bid until it knows. A bid would say that the task was given back (Initiator::take_back).
  bool done_here = false;
  for (auto& f : finished_) {
    if (f.entry.state != TaskState::done || !contains(message.tasks, f.entry.task)) continue;
    done_here = true;
    f.report_until = now + kReportFinishedFor;
  }
  if (done_here) {
    send_status(now);
    return;
  }
  if (message.round == round_ && bid_ &&
      (machine_.in(State::bidding) || machine_.in(State::rebidding))) {
    messages_.push(*bid_);
    return;
  }
  // By the leader's clock it may still be time.
  if (now >= message.bids_until + params_.clock_guard) return;
  const bool newer_of_mine =
      message.round.coalition == round_.coalition && message.round.number > round_.number;
  if (machine_.in(State::free)) {
    outputs_.push(BidWanted{message});
  } else if (machine_.in(State::member)) {
    if (newer_of_mine && !task_in_progress()) outputs_.push(BidWanted{message});
  } else if (machine_.in(State::orphaned)) {  // whoever leads the site now plans it anew
    const bool copy = message.round.coalition == round_.coalition && !newer_of_mine;
    if (!copy && message.site.id == award_->site.id && !task_in_progress()) {
      outputs_.push(BidWanted{message});
    }
  } else if (newer_of_mine) {  // bidding: the round that was bid in has come to nothing
    leave(Event::new_round, {Reason::new_round});
    outputs_.push(BidWanted{message});
  }
}

void Participant::bid(const Announcement& announcement, Bid bid, Instant now) {
  if (!machine_.fire(Event::bid)) return;
  // Bidding anew gives the old tasks back: the leader may award them to somebody else from now on.
  if (announcement.round.coalition != round_.coalition) {  // its leader does not hear this bid
    for (const auto& lease : leases_) give_up(lease, now);
  }
  end_leases({Reason::bid_again}, true);
  round_ = announcement.round;
  bid.round = round_;
  bid.bidder = self_;
  bid_ = bid;
  award_.reset();
  confirmation_.reset();
  // Its leader may have learned that the air is slower than is known here.
  const Instant formed_at = announcement.formed_at;
  const Duration takes =
      formed_at - std::clamp(announcement.announced_at, formed_at - params_.lease, formed_at);
  bidding_until_ = std::max(formed_at, now) + std::max(takes, params_.formation_time());
  messages_.push(bid);
}

void Participant::decline(const Announcement& announcement) {
  // Nothing is sent: a leader counts the bids that it gets, and silence is the cheaper refusal.
  SKEIN_ASSERT(announcement.round != round_ || !bid_);
}

void Participant::on_award(const Award& message, Instant now) {
  const bool goes_on = machine_.in(State::orphaned) && elector_.succeeds(message);
  if (message.round != round_ && !goes_on) return;
  if (!goes_on && confirmation_ && !machine_.in(State::bidding) && !machine_.in(State::rebidding)) {
    messages_.push(*confirmation_);  // the leader has not heard it
    return;
  }
  if (!machine_.in(State::bidding) && !machine_.in(State::rebidding) && !goes_on) return;
  std::vector<TaskAssignment> mine = awarded_in(message);
  if (mine.empty() || now >= message.lease_until) {
    const Reason reason = mine.empty() ? Reason::not_needed : Reason::award_too_late;
    if (!goes_on) leave(Event::not_awarded, {reason});
    return;
  }
  if (!machine_.fire(Event::award_received)) return;
  round_ = message.round;
  award_ = message;
  outputs_.push(AwardReceived{message, std::move(mine)});
}

/// To this program, and no other under its number.
std::vector<TaskAssignment> Participant::awarded_in(const Award& award) const {
  std::vector<TaskAssignment> mine;
  for (std::size_t i = 0; i < award.assignments.size(); ++i) {
    if (award.assignments[i].vehicle != self_) continue;
    const InstanceId program = i < award.programs.size() ? award.programs[i] : InstanceId{};
    if (program == InstanceId{} || program == instance_) mine.push_back(award.assignments[i]);
  }
  return mine;
}

void Participant::accept(Instant now) {
  SKEIN_ASSERT(award_.has_value());
  if (!machine_.fire(Event::accepted)) return;
  for (const auto& a : awarded_in(*award_)) {
    std::erase_if(finished_, [&](const Finished& f) { return f.entry.task == a.task; });
    // Of a plan that was held for a successor, what has begun goes on.
    const auto held = std::find_if(leases_.begin(), leases_.end(),
                                   [&](const Lease& l) { return l.task == a.task; });
    const TaskState state = held == leases_.end() ? TaskState::planned : held->state;
    if (held != leases_.end()) leases_.erase(held);
    leases_.push_back({a.task, state, award_->lease_until});
    outputs_.push(LeaseGranted{round_, a.task, award_->lease_until});
  }
  std::erase_if(leases_, [now](const Lease& l) { return l.until <= now; });
  elector_.accepted(*award_);
  confirmation_ = Confirmation{round_, self_, true, {}};
  messages_.push(*confirmation_);
  next_status_ = now + params_.heartbeat;
}

void Participant::refuse(const Why& why, Instant /*now*/) {
  confirmation_ = Confirmation{round_, self_, false, why};
  messages_.push(*confirmation_);
  leave(Event::refused, why);
}

void Participant::on_cancel(const Cancel& message, Instant now) {
  if (message.round != round_ || machine_.in(State::free)) return;
  // The operator may withdraw a site, or take a grant back, until a delivery has begun: that one is
  // not broken off.
  if (is_by_operator(message.why.reason) && delivery_in_progress()) return finish_alone();
  // The leader counts on what it was told has begun; and one that leads the site again later, on
  // all that it does not know to be given up.
  const bool is_led_again = message.why.reason == Reason::held_by_operator;
  for (const auto& lease : leases_) {
    if (is_led_again || lease.state == TaskState::started) give_up(lease, now);
  }
  elector_.cancelled();
  leave(Event::released, message.why);
}

void Participant::on_lease_renewal(const LeaseRenewal& message, Instant now) {
  elector_.on_lease_renewal(message, now);
  const bool is_followed =
      contains(message.members, self_) && message.round.coalition == round_.coalition &&
      message.round.number >= round_.number && !(award_ && message.sent_at <= award_->awarded_at);
  // A delivery that an earlier leader took for flown, perhaps, this one may have flown yet.
  const auto is_known_anew = [&message](const Over& over) {
    return over.since == Instant::min() && over.task.site == message.site &&
           !contains(message.unknown, over.task);
  };
  if (is_followed) std::erase_if(over_, is_known_anew);
  for (const auto& task : message.done) note_over({task, now, false});
  for (const auto& task : message.unknown) note_over({task, Instant::min(), false});
  for (auto& f : finished_) {
    const bool concerned =
        f.entry.state == TaskState::done || f.round.coalition == message.round.coalition;
    if (concerned && contains(message.done, f.entry.task)) f.report_until = now;
  }
  if (!is_followed) return;
  // Renewals were lost, and the leader still counts on the plan that is held for a successor.
  const bool heard_again = machine_.in(State::orphaned) && message.round == round_ &&
                           message.lease_until > now && elector_.follows_leader();
  if (heard_again) machine_.fire(Event::leader_heard);
  for (auto& lease : leases_) {
    if ((lease.until <= now && !heard_again) || message.lease_until <= lease.until) continue;
    lease.until = message.lease_until;
    outputs_.push(LeaseGranted{round_, lease.task, lease.until});
  }
}

void Participant::on_timeout(Instant now) {
  if ((machine_.in(State::bidding) || machine_.in(State::rebidding)) && now >= bidding_until_) {
    leave(Event::no_award, {Reason::no_award});
  }
  if (machine_.in(State::orphaned)) {
    if (now >= orphaned_until_) {
      for (const auto& lease : leases_) give_up(lease, now);
      leave(Event::released, {Reason::no_successor});
    }
  } else if (!machine_.in(State::deciding)) {
    // An award that is being answered may be a successor's: what it goes on with has not ended.
    expire_leases(now);
  }
  elector_.on_timeout(now);
  while (auto message = elector_.poll_message()) messages_.push(std::move(*message));
  if (auto won = elector_.poll_won()) outputs_.push(std::move(*won));
  std::erase_if(finished_, [now](const Finished& f) {
    return f.entry.state != TaskState::done && f.report_until <= now;
  });
  if (finished_.size() > kFinishedMax) finished_.erase(finished_.begin());
  if (now >= next_status_ && has_news(now)) send_status(now);
}

void Participant::expire_leases(Instant now) {
  const auto ran_out = [now](const Lease& lease) { return lease.until <= now; };
  if (std::none_of(leases_.begin(), leases_.end(), ran_out)) return;
  // What has begun is left: nobody may fly a task without its lease.
  const bool held = machine_.in(State::member) && elector_.awaits_successor() &&
                    !task_in_progress() && std::all_of(leases_.begin(), leases_.end(), ran_out);
  for (const auto& lease : leases_) {
    if (!ran_out(lease)) continue;
    outputs_.push(LeaseEnded{round_, lease.task, {Reason::lease_ran_out}, held});
  }
  if (held) {
    machine_.fire(Event::leader_lost);
    orphaned_until_ = now + params_.succession_time();
    return;
  }
  for (const auto& lease : leases_) {
    if (ran_out(lease)) give_up(lease, now);
  }
  std::erase_if(leases_, ran_out);
  if (leases_.empty() && machine_.in(State::member)) {
    leave(Event::released, {Reason::lease_ran_out});
  }
}

/// The leader may count on a lease for longer than it was heard to: it is told otherwise.
void Participant::give_up(const Lease& lease, Instant now) {
  finished_.push_back({round_, {lease.task, TaskState::failed, now}, now + params_.lease});
}

void Participant::on_status(const MemberStatus& message) {
  elector_.on_status(message);
  for (const auto& entry : message.tasks) {
    if (entry.state == TaskState::done) note_over({entry.task, entry.time, true});
  }
}

/// Who flew it knows when best, and of two words the earlier one counts.
void Participant::note_over(const Over& over) {
  const auto known = std::ranges::find(over_, over.task, &Over::task);
  if (known != over_.end()) {
    if (known->told_by_owner == over.told_by_owner) {
      known->since = std::min(known->since, over.since);
    } else if (over.told_by_owner) {
      *known = over;
    }
    return;
  }
  over_.push_back(over);
  if (over_.size() > kOverMax) over_.erase(over_.begin());
}

std::optional<Participant::Over> Participant::over(const TaskId& task) const {
  const auto known = std::ranges::find(over_, task, &Over::task);
  return known == over_.end() ? std::nullopt : std::optional{*known};
}

void Participant::on_claim(const LeadershipClaim& message, Instant now) {
  elector_.on_claim(message, now);
}

void Participant::on_allegiance(const Allegiance& message, Instant now) {
  elector_.on_allegiance(message, now);
}

bool Participant::has_news(Instant now) const {
  return !leases_.empty() || std::any_of(finished_.begin(), finished_.end(),
                                         [now](const Finished& f) { return f.report_until > now; });
}

bool Participant::task_in_progress() const {
  return std::any_of(leases_.begin(), leases_.end(),
                     [](const Lease& l) { return l.state == TaskState::started; });
}

bool Participant::delivery_in_progress() const {
  return std::any_of(leases_.begin(), leases_.end(), [](const Lease& l) {
    return l.state == TaskState::started && l.task.kind == TaskKind::deliver;
  });
}

bool Participant::holds(const TaskId& task, Instant now, Instant until) const {
  return std::any_of(leases_.begin(), leases_.end(), [&](const Lease& l) {
    return l.task == task && l.until > now && l.until >= until;
  });
}

void Participant::task_started(const TaskId& task, Instant now) {
  for (auto& lease : leases_) {
    if (lease.task == task) lease.state = TaskState::started;
  }
  send_status(now);
}

void Participant::task_done(const TaskId& task, Instant end, Instant now) {
  finish(task, TaskState::done, end, now);
}

void Participant::task_failed(const TaskId& task, Instant now) {
  finish(task, TaskState::failed, now, now);
}

void Participant::finish(const TaskId& task, TaskState state, Instant end, Instant now) {
  const auto lease =
      std::find_if(leases_.begin(), leases_.end(), [&](const Lease& l) { return l.task == task; });
  if (lease == leases_.end()) return;
  leases_.erase(lease);
  const Why why{state == TaskState::done ? Reason::task_done : Reason::task_failed};
  outputs_.push(LeaseEnded{round_, task, why, false});
  finished_.push_back({round_, {task, state, end}, now + kReportFinishedFor});
  send_status(now);
  if (leases_.empty() && (machine_.in(State::member) || machine_.in(State::orphaned))) {
    leave(Event::released, why);
  }
}

void Participant::withdraw(Reason reason, Instant now) {
  while (!leases_.empty()) finish(leases_.front().task, TaskState::failed, now, now);
  if (!machine_.in(State::free)) leave(Event::released, {reason});
}

void Participant::end_leases(const Why& why, bool unstarted_only) {
  const auto ends = [unstarted_only](const Lease& l) {
    return !unstarted_only || l.state == TaskState::planned;
  };
  for (const auto& lease : leases_) {
    if (ends(lease)) outputs_.push(LeaseEnded{round_, lease.task, why, false});
  }
  std::erase_if(leases_, ends);
}

void Participant::leave(Event event, const Why& why) {
  if (!machine_.fire(event)) return;
  end_leases(why, false);
  if (event != Event::new_round) elector_.leave();
  bid_.reset();
  award_.reset();
  outputs_.push(Released{round_, why});
}

void Participant::send_status(Instant now) {
  std::map<Round, MemberStatus> by_round;
  for (const auto& lease : leases_) {
    by_round[round_].tasks.push_back({lease.task, lease.state, now});
  }
  for (const auto& done : finished_) {
    if (done.report_until <= now) continue;
    by_round[done.round].tasks.push_back(done.entry);
  }
  for (auto& [round, status] : by_round) {
    status.round = round;
    status.member = self_;
    messages_.push(std::move(status));
  }
  next_status_ = now + params_.heartbeat;
}

std::optional<Message> Participant::poll_message() { return messages_.pop(); }
std::optional<Participant::Output> Participant::poll_output() { return outputs_.pop(); }

Instant Participant::next_timeout() const {
  Instant next = Instant::max();
  if (machine_.in(State::bidding) || machine_.in(State::rebidding)) next = bidding_until_;
  if (machine_.in(State::orphaned)) {
    next = orphaned_until_;
  } else {
    for (const auto& lease : leases_) next = std::min(next, lease.until);
  }
  next = std::min(next, elector_.next_timeout());
  if (has_news(next_status_)) next = std::min(next, next_status_);
  return next;
}

Instant Participant::quiet_until(bool may_lead) const {
  const bool waits = may_lead != elector_.may_lead() || elector_.has_output();
  if (waits || finished_.size() > kFinishedMax) return Instant::min();
  Instant next = next_timeout();
  for (const Finished& f : finished_) {
    if (f.entry.state != TaskState::done) next = std::min(next, f.report_until);
  }
  return next;
}

std::string_view to_string(Participant::State state) {
  static constexpr std::array<std::string_view, 6> kNames{"free",   "bidding",   "deciding",
                                                          "member", "rebidding", "orphaned"};
  static_assert(kNames.size() == static_cast<std::size_t>(Participant::State::count));
  return kNames.at(static_cast<std::size_t>(state));
}

std::string_view to_string(Participant::Event event) {
  static constexpr std::array<std::string_view, 10> kNames{
      "bid",      "award_received", "accepted",  "refused",     "not_awarded",
      "no_award", "released",       "new_round", "leader_lost", "leader_heard"};
  static_assert(kNames.size() == static_cast<std::size_t>(Participant::Event::count));
  return kNames.at(static_cast<std::size_t>(event));
}

}  // namespace skein::coalition
