// SPDX-License-Identifier: Apache-2.0
#include "skein/coalition/initiator.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace skein::coalition {
namespace {
/// An award gives a short lease; it grows by renewals once the member has confirmed. So a member
/// whose confirmation is lost frees its tasks soon.
constexpr Duration kFirstLease = std::chrono::seconds{3};
/// How long after a task's time its owner may still say that it has not begun.
constexpr Duration kOverdue = std::chrono::seconds{3};
}  // namespace

Initiator::Initiator(const ProtocolParams& params, const CoalitionId& id, const Site& site,
                     const Vec2& leader_at_formation, Instant now)
    : params_{params}, leader_at_formation_{leader_at_formation} {
  announcement_.round.coalition = id;
  announcement_.site = site;
  for (const auto& task : site.tasks_after_survey()) {
    Entry entry;
    entry.task = task;
    ledger_.push_back(entry);
  }
  start_round(now);
}

void Initiator::start_round(Instant now) {
  ++announcement_.round.number;
  announcement_.announced_at = now;
  announcement_.bids_until = now + 2 * params_.message_delay;
  announcement_.formed_at = now + params_.formation_time();
  announcement_.leader_at_formation = leader_at_formation_;
  collect_open_tasks(now);
  bids_.clear();
  award_.reset();
  confirmed_.clear();
  deadline_ = announcement_.bids_until;
  next_repeat_ = now + params_.message_delay / 2;
  messages_.push(announcement_);
}

void Initiator::collect_open_tasks(Instant now) {
  announcement_.tasks.clear();
  for (const auto& entry : ledger_) {
    const bool begun = entry.ownership == Ownership::leased &&
                       entry.reported == TaskState::started && entry.lease_until > now;
    const bool over = entry.ownership == Ownership::done || entry.ownership == Ownership::unknown;
    if (!begun && !over) announcement_.tasks.push_back(entry.task);
  }
  announcement_.reward =
      announcement_.site.reward * static_cast<double>(announcement_.tasks.size());
}

void Initiator::on_bid(const Bid& message, Instant now) {
  heard_[message.bidder] = now;
  if (message.round != announcement_.round || !machine_.in(State::announcing)) return;
  if (bids_.size() < kMembersMax) bids_.emplace(message.bidder, message);
}

void Initiator::close_bids(Instant now) {
  if (!machine_.fire(Event::bids_closed)) return;
  AllocationWanted wanted;
  wanted.round = announcement_.round;
  wanted.formed_at = announcement_.formed_at;
  wanted.answer_by = now + params_.allocation_time;
  deadline_ = wanted.answer_by;
  for (auto& entry : ledger_) {
    // Who bids again has given its tasks back (Participant::bid).
    if (entry.ownership == Ownership::leased && bids_.contains(entry.assignment.vehicle) &&
        entry.reported == TaskState::planned) {
      entry.ownership = Ownership::open;
    }
    if (entry.ownership == Ownership::open) wanted.tasks.push_back(entry.task);
  }
  for (const auto& [bidder, bid] : bids_) wanted.bids.push_back(bid);
  if (wanted.tasks.empty()) {
    not_formed(Event::allocation_failed, "waiting for tasks whose owners are silent", now);
  } else {
    outputs_.push(std::move(wanted));
  }
}

void Initiator::allocated(const Round& round, std::vector<TaskAssignment> assignments,
                          Instant now) {
  if (round != announcement_.round || !machine_.in(State::allocating))
    return;  // too late: asked anew
  machine_.fire(Event::allocated);
  Award award;
  award.round = round;
  award.site = announcement_.site;
  award.formed_at = announcement_.formed_at;
  award.assignments = std::move(assignments);
  award.lease_until = std::max(announcement_.formed_at, now) + kFirstLease;
  for (const auto& a : award.assignments) {
    Entry* entry = find(a.task);
    if (entry == nullptr) continue;
    entry->ownership = Ownership::leased;
    entry->assignment = a;
    entry->round = round;
    entry->reported = TaskState::planned;
    entry->lease_until = award.lease_until;
    confirmed_[a.vehicle] = false;
  }
  deadline_ = std::max(announcement_.formed_at, now) + 2 * params_.message_delay + params_.margin;
  next_repeat_ = now + params_.message_delay;
  award_ = award;
  messages_.push(std::move(award));
}

void Initiator::allocation_failed(const Round& round, const std::string& why, Instant now) {
  if (round != announcement_.round || !machine_.in(State::allocating)) return;
  not_formed(Event::allocation_failed, why, now);
}

void Initiator::not_formed(Event event, const std::string& why, Instant now) {
  if (!machine_.fire(event)) return;
  // Frees the bidders, and with them whoever has confirmed an award that not all can fly.
  messages_.push(Cancel{announcement_.round, why.substr(0, kReasonMax)});
  outputs_.push(NotFormed{announcement_.round, why});
  deadline_ = now + params_.monitoring_interval;
}

bool Initiator::all_confirmed() const {
  return std::all_of(confirmed_.begin(), confirmed_.end(), [](const auto& c) { return c.second; });
}

void Initiator::on_confirmation(const Confirmation& message, Instant now) {
  heard_[message.member] = now;
  const auto member = confirmed_.find(message.member);
  if (message.round != announcement_.round || member == confirmed_.end()) return;
  if (!message.accepted) {
    for (auto& entry : ledger_) {
      if (entry.ownership == Ownership::leased && entry.assignment.vehicle == message.member &&
          entry.round == message.round) {
        entry.ownership = Ownership::open;
      }
    }
    if (machine_.in(State::awarding)) {
      not_formed(Event::not_confirmed,
                 "vehicle " + std::to_string(message.member.value) + " refused: " + message.reason,
                 now);
    }
    return;
  }
  member->second = true;
  if (machine_.in(State::awarding) && all_confirmed()) {
    machine_.fire(Event::confirmed);
    outputs_.push(Formed{announcement_.round, award_->assignments});
    next_heartbeat_ = now;
  }
}

void Initiator::on_status(const MemberStatus& message, Instant now) {
  if (message.round.coalition != announcement_.round.coalition) return;
  heard_[message.member] = now;
  for (const auto& reported : message.tasks) {
    Entry* entry = find(reported.task);
    if (entry == nullptr || entry->ownership == Ownership::done) continue;
    const bool owner =
        entry->ownership == Ownership::leased && entry->assignment.vehicle == message.member;
    if (reported.state == TaskState::done) {  // whoever did it, it is done
      entry->ownership = Ownership::done;
      entry->assignment.vehicle = message.member;
      entry->done_at = reported.time;
    } else if (owner && reported.state == TaskState::failed && message.round == entry->round) {
      entry->ownership = Ownership::open;
      outputs_.push(TaskLost{entry->round, entry->assignment, "its owner reports that it failed"});
    } else if (owner && reported.state == TaskState::started) {
      entry->reported = TaskState::started;
    }
  }
  finish_if_done();
}

void Initiator::finish_if_done() {
  const bool over = std::all_of(ledger_.begin(), ledger_.end(), [](const Entry& e) {
    return e.ownership == Ownership::done || e.ownership == Ownership::unknown;
  });
  if (!over || !machine_.accepts(Event::all_done)) return;
  machine_.fire(Event::all_done);
  // So that members need not go on reporting.
  messages_.push(LeaseRenewal{announcement_.round, {}, done_tasks(), announcement_.formed_at});
  outputs_.push(AllDone{announcement_.round});
}

void Initiator::expire(Instant now) {
  for (auto& entry : ledger_) {
    if (entry.ownership != Ownership::leased || now < entry.lease_until + params_.clock_guard)
      continue;
    const bool may_be_flown = entry.task.kind == TaskKind::deliver &&
                              authorised_rounds_.contains(entry.round.number) &&
                              entry.assignment.time <= entry.lease_until;
    if (may_be_flown) {
      entry.ownership = Ownership::unknown;
      outputs_.push(TaskUnknown{entry.round, entry.assignment});
    } else {
      entry.ownership = Ownership::open;
      outputs_.push(TaskLost{entry.round, entry.assignment, "its owner fell silent"});
    }
  }
  finish_if_done();
}

void Initiator::heartbeat(Instant now) {
  next_heartbeat_ = now + params_.heartbeat;
  std::set<VehicleId> members;
  for (const auto& entry : ledger_) {
    if (entry.ownership != Ownership::leased) continue;
    const auto confirmed = confirmed_.find(entry.assignment.vehicle);
    const bool unconfirmed =
        entry.round == announcement_.round && confirmed != confirmed_.end() && !confirmed->second;
    if (unconfirmed || !hears(entry.assignment.vehicle, now)) continue;
    members.insert(entry.assignment.vehicle);
  }
  const Instant until = now + params_.lease;
  for (auto& entry : ledger_) {
    if (entry.ownership == Ownership::leased && members.contains(entry.assignment.vehicle)) {
      entry.lease_until = std::max(entry.lease_until, until);
    }
  }
  messages_.push(
      LeaseRenewal{announcement_.round, {members.begin(), members.end()}, done_tasks(), until});
}

void Initiator::announce_again(const std::string& why, Instant now) {
  if (!machine_.in(State::executing) || !machine_.fire(Event::try_again)) return;
  outputs_.push(NotFormed{announcement_.round, why});
  start_round(now);
}

void Initiator::authorised(const Round& round) { authorised_rounds_[round.number] = true; }

void Initiator::close(const std::string& why, Instant /*now*/) {
  if (machine_.in(State::closed) || !machine_.fire(Event::closed)) return;
  std::set<Round> rounds{announcement_.round};
  for (const auto& entry : ledger_) {
    if (entry.ownership == Ownership::leased) rounds.insert(entry.round);
  }
  for (const auto& round : rounds) messages_.push(Cancel{round, why.substr(0, kReasonMax)});
}

void Initiator::on_timeout(Instant now) {
  if (machine_.in(State::closed)) return;
  expire(now);
  if (now >= next_heartbeat_) heartbeat(now);
  switch (machine_.state()) {
    case State::announcing:
      if (now >= deadline_) {
        close_bids(now);
      } else if (now >= next_repeat_) {
        next_repeat_ = now + params_.message_delay / 2;
        messages_.push(announcement_);
      }
      break;
    case State::allocating:
      if (now >= deadline_) {
        not_formed(Event::allocation_failed, "the allocation was not ready in time", now);
      }
      break;
    case State::awarding:
      if (now >= deadline_) {
        not_formed(Event::not_confirmed, "not every member confirmed the award", now);
      } else if (now >= next_repeat_) {
        next_repeat_ = now + params_.message_delay;
        messages_.push(*award_);
      }
      break;
    case State::monitoring:
      if (now >= deadline_ && machine_.fire(Event::try_again)) start_round(now);
      break;
    case State::executing: {
      const auto needs_round = [&](const Entry& e) {
        // An owner that is heard and has not begun in time holds at its gate. One that is not heard
        // keeps its lease until that runs out.
        const bool overdue = e.ownership == Ownership::leased && e.reported == TaskState::planned &&
                             now > e.assignment.time + kOverdue && hears(e.assignment.vehicle, now);
        return e.ownership == Ownership::open || overdue;
      };
      if (std::any_of(ledger_.begin(), ledger_.end(), needs_round)) {
        announce_again("tasks are open again", now);
      }
      break;
    }
    case State::closed:
    case State::count:
      break;
  }
}

Instant Initiator::next_timeout() const {
  if (machine_.in(State::closed)) return Instant::max();
  Instant next = next_heartbeat_;
  if (!machine_.in(State::executing)) next = std::min(next, deadline_);
  if (machine_.in(State::announcing) || machine_.in(State::awarding))
    next = std::min(next, next_repeat_);
  return next;
}

std::optional<Instant> Initiator::last_delivery() const {
  std::optional<Instant> last;
  for (const auto& entry : ledger_) {
    if (entry.task.kind != TaskKind::deliver) continue;
    if (entry.ownership == Ownership::open) continue;
    const Instant t = entry.ownership == Ownership::done ? entry.done_at : entry.assignment.time;
    last = last ? std::max(*last, t) : t;
  }
  return last;
}

std::vector<TaskAssignment> Initiator::owned() const {
  std::vector<TaskAssignment> tasks;
  for (const auto& entry : ledger_) {
    if (entry.ownership == Ownership::leased) tasks.push_back(entry.assignment);
  }
  return tasks;
}

std::optional<Message> Initiator::poll_message() { return messages_.pop(); }
std::optional<Initiator::Output> Initiator::poll_output() { return outputs_.pop(); }

std::vector<TaskId> Initiator::done_tasks() const {
  std::vector<TaskId> tasks;
  for (const auto& entry : ledger_) {
    if (entry.ownership == Ownership::done) tasks.push_back(entry.task);
  }
  return tasks;
}

bool Initiator::hears(VehicleId member, Instant now) const {
  const auto heard = heard_.find(member);
  return heard != heard_.end() && now - heard->second <= params_.silence;
}

Initiator::Entry* Initiator::find(const TaskId& task) {
  const auto it =
      std::find_if(ledger_.begin(), ledger_.end(), [&](const Entry& e) { return e.task == task; });
  return it == ledger_.end() ? nullptr : &*it;
}

std::string_view to_string(Initiator::State state) {
  static constexpr std::array<std::string_view, 6> kNames{"announcing", "allocating", "awarding",
                                                          "executing",  "monitoring", "closed"};
  static_assert(kNames.size() == static_cast<std::size_t>(Initiator::State::count));
  return kNames.at(static_cast<std::size_t>(state));
}

std::string_view to_string(Initiator::Event event) {
  static constexpr std::array<std::string_view, 8> kNames{
      "bids_closed",   "allocated", "allocation_failed", "confirmed",
      "not_confirmed", "try_again", "all_done",          "closed"};
  static_assert(kNames.size() == static_cast<std::size_t>(Initiator::Event::count));
  return kNames.at(static_cast<std::size_t>(event));
}

}  // namespace skein::coalition
