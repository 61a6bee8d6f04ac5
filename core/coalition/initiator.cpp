// SPDX-License-Identifier: Apache-2.0
#include "skein/coalition/initiator.hpp"

#include <algorithm>
#include <functional>
#include <set>
#include <string>
#include <utility>

#include "skein/base/contains.hpp"
#include "skein/base/random.hpp"

namespace skein::coalition {
namespace {
/// How long after a task's time its owner may still say that it has not begun.
constexpr Duration kOverdue = std::chrono::seconds{3};
/// How long before its time a delivery may have begun, where the owner's bid is not known.
constexpr Duration kLongestRun = std::chrono::seconds{15};
/// A message is given that part of a lease at most: a first lease lasts four of them and 3 s, and
/// the electors' promises must reach beyond it.
constexpr int kDelaysInLease = 15;
}  // namespace

Initiator::Initiator(const ProtocolParams& params, const CoalitionId& id, const Site& site,
                     const std::vector<TaskId>& done, const Vec2& leader_at_formation, Instant now)
    : params_{params}, leader_at_formation_{leader_at_formation} {
  announcement_.round.coalition = id;
  announcement_.site = site;
  make_ledger(done);
  start_round(now);
}

Initiator::Initiator(const ProtocolParams& params, const CoalitionId& id, const Elector::Won& won,
                     bool authorised, const Vec2& leader_at_formation, Instant now)
    : params_{params},
      machine_{kTable, State::awarding},
      leader_at_formation_{leader_at_formation},
      majority_{won.majority} {
  announcement_.round = {id, 1};
  announcement_.site = won.plan.site;
  announcement_.announced_at = now;
  announcement_.bids_until = now;
  announcement_.formed_at = now;
  announcement_.leader_at_formation = leader_at_formation;
  make_ledger(won.done);
  promised_until_ = won.promised_from + params_.lease;
  for (const auto& [elector, instance] : won.supporters) {
    electors_[elector] = {won.promised_from, instance, Instant::min()};
    heard_[elector] = now;
  }
  std::vector<TaskAssignment> held;
  for (auto& entry : ledger_) {
    if (entry.ownership == Ownership::done) continue;
    const auto planned =
        std::find_if(won.plan.assignments.begin(), won.plan.assignments.end(),
                     [&](const TaskAssignment& a) { return a.task == entry.task; });
    const bool in_plan = planned != won.plan.assignments.end();
    if (in_plan && electors_.contains(planned->vehicle)) {
      held.push_back(*planned);
    } else if (entry.task.kind == TaskKind::deliver && authorised &&
               (!in_plan || planned->time <= now)) {
      entry.ownership = Ownership::unknown;  // its owner follows somebody else, or is lost
      if (in_plan) entry.assignment = *planned;
      outputs_.push(TaskUnknown{won.plan.round, entry.assignment});
    }
  }
  send_award(std::move(held), now);
  award_->continues = won.plan.round.coalition;
  messages_.push(*award_);
}

void Initiator::make_ledger(const std::vector<TaskId>& done) {
  for (const auto& task : tasks_after_survey(announcement_.site)) {
    Entry entry;
    entry.task = task;
    entry.assignment.task = task;
    if (contains(done, task)) entry.ownership = Ownership::done;
    ledger_.push_back(entry);
  }
}

void Initiator::start_round(Instant now) {
  ++announcement_.round.number;
  announcement_.announced_at = now;
  announcement_.bids_until = now + 2 * params_.message_delay;
  announcement_.formed_at = now + params_.formation_time();
  announcement_.leader_at_formation = leader_at_formation_;
  collect_open_tasks(now);
  bids_.clear();
  late_bid_took_ = {};
  doubled_.clear();
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
    if (!begun && !over && !entry.maybe_flown) announcement_.tasks.push_back(entry.task);
  }
  announcement_.reward =
      announcement_.site.reward * static_cast<double>(announcement_.tasks.size());
}

void Initiator::on_bid(const Bid& message, Instant now) {
  if (!makes_sense(message)) {
    ++bad_messages_;
    return;
  }
  heard_[message.bidder] = now;
  for (auto& entry : ledger_) {
    const bool newer = message.round.coalition == entry.round.coalition &&
                       message.round.number > entry.round.number;
    if (entry.ownership == Ownership::leased && entry.assignment.vehicle == message.bidder &&
        newer) {
      take_back(entry, message, now);
    }
  }
  if (message.round != announcement_.round) return;
  const auto known = bids_.find(message.bidder);
  if (!machine_.in(State::announcing)) {
    if (known == bids_.end()) note_late_bid(now);
    return;
  }
  if (known == bids_.end()) {
    if (bids_.size() < kMembersMax) bids_.emplace(message.bidder, message);
  } else if (known->second.instance != message.instance) {
    doubled_.insert(message.bidder);
  }
}

void Initiator::close_bids(Instant now) {
  if (!machine_.fire(Event::bids_closed)) return;
  AllocationWanted wanted;
  wanted.round = announcement_.round;
  wanted.formed_at = announcement_.formed_at;
  planning_since_ = now;
  wanted.answer_by = now + params_.allocation_time;
  deadline_ = wanted.answer_by;
  for (auto& entry : ledger_) {
    if (entry.ownership == Ownership::open) wanted.tasks.push_back(entry.task);
  }
  // Two programs under one number would both take what is awarded to it.
  for (const auto& [bidder, bid] : bids_) {
    if (!doubled_.contains(bidder)) wanted.bids.push_back(bid);
  }
  if (wanted.tasks.empty()) {
    not_formed(Event::allocation_failed, {Reason::owners_silent}, now);
  } else {
    outputs_.push(std::move(wanted));
  }
}

/// Who bids again has given back what it had not begun (Participant::bid). Who has started anew
/// holds nothing any more, and cannot say what it had begun.
void Initiator::take_back(Entry& entry, const Bid& bid, Instant now) {
  const bool started_anew = bid.instance != entry.instance;
  if (!started_anew && entry.reported != TaskState::planned) return;
  const bool begun = entry.reported == TaskState::started ||
                     (authorised_rounds_.contains(entry.round.number) && now >= entry.begins);
  const bool may_be_flown = started_anew && entry.task.kind == TaskKind::deliver && begun;
  if (may_be_flown) {
    make_unknown(entry);
  } else {
    reopen(entry);
  }
}

void Initiator::allocated(const Round& round, std::vector<TaskAssignment> assignments,
                          Instant now) {
  if (round != announcement_.round) return;  // too late: asked anew
  note_planning_time(now);
  if (!machine_.in(State::allocating)) return;
  const Instant lease_until = std::max(announcement_.formed_at, now) + params_.first_lease();
  if (authority_until() < lease_until) {
    not_formed(Event::allocation_failed, {Reason::electors_silent}, now);
    return;
  }
  machine_.fire(Event::allocated);
  send_award(std::move(assignments), now);
  messages_.push(*award_);
}

void Initiator::send_award(std::vector<TaskAssignment> assignments, Instant now) {
  Award award;
  award.round = announcement_.round;
  award.site = announcement_.site;
  award.formed_at = announcement_.formed_at;
  award.assignments = std::move(assignments);
  award.awarded_at = now;
  award.lease_until =
      std::min(authority_until(), std::max(announcement_.formed_at, now) + params_.first_lease());
  for (auto& entry : ledger_) entry.left_over = entry.ownership == Ownership::open;
  for (const auto& a : award.assignments) {
    InstanceId& program = award.programs.emplace_back();
    Entry* entry = find(a.task);
    if (entry == nullptr) continue;
    entry->ownership = Ownership::leased;
    entry->left_over = false;
    entry->assignment = a;
    entry->round = award.round;
    entry->begins = a.time - kLongestRun;
    const auto bid = bids_.find(a.vehicle);
    if (bid != bids_.end()) {
      entry->instance = bid->second.instance;
      entry->begins = a.time - approach_time(bid->second);
    } else if (const auto elector = electors_.find(a.vehicle); elector != electors_.end()) {
      entry->instance = elector->second.instance;  // its plan goes on under this leader
    }
    program = entry->instance;
    entry->reported = TaskState::planned;
    entry->lease_until = award.lease_until;
    confirmed_[a.vehicle] = false;
    const auto elector = electors_.find(a.vehicle);
    if (elector != electors_.end()) elector->second.awarded_at = now;
  }
  deadline_ = std::max(announcement_.formed_at, now) + 2 * params_.message_delay + params_.margin;
  next_repeat_ = now + params_.message_delay;
  award_ = std::move(award);
}

/// How far the electors' promises to follow nobody else reach: half of them, this leader included,
/// are enough, because another leader needs more than half (Elector).
Instant Initiator::authority_until() const {
  const std::size_t needed = (electors_.size() + 1) / 2;
  if (needed <= 1) return promised_until_;
  std::vector<Instant> stamps;
  stamps.reserve(electors_.size());
  for (const auto& [vehicle, elector] : electors_) {
    if (vehicle != announcement_.round.coalition.leader) stamps.push_back(elector.acknowledged);
  }
  const auto nth = stamps.begin() + static_cast<std::ptrdiff_t>(needed - 2);
  std::nth_element(stamps.begin(), nth, stamps.end(), std::greater<>{});
  return *nth == Instant::min() ? *nth : std::min(promised_until_, *nth + params_.lease);
}

void Initiator::on_allegiance(const Allegiance& message, Instant now) {
  if (message.coalition != announcement_.round.coalition) return;
  const auto elector = electors_.find(message.elector);
  if (elector == electors_.end() || message.elector == message.coalition.leader) return;
  if (message.acknowledges > now) {  // nothing that this leader has said
    ++bad_messages_;
    return;
  }
  // One that has started anew does not know what it had promised to whom.
  if (elector->second.instance != message.instance) return;
  if (elector->second.leaves_by(message)) {
    electors_.erase(elector);
  } else if (message.follows == message.coalition.leader) {
    heard_[message.elector] = now;
    Instant& acknowledged = elector->second.acknowledged;
    acknowledged = std::max(acknowledged, message.acknowledges);
  }
}

/// Said before its newest award, and perhaps by an earlier start: by that award it has a vote.
bool Initiator::ElectorEntry::leaves_by(const Allegiance& message) const {
  return message.follows == VehicleId{} && message.instance == instance &&
         message.acknowledges > awarded_at;
}

void Initiator::Electorate::on_allegiance(const Allegiance& message, Instant now) {
  if (message.coalition != coalition || message.acknowledges > now) return;
  const auto other = others.find(message.elector);
  if (other != others.end() && other->second.leaves_by(message)) others.erase(other);
}

void Initiator::on_rival(const Round& rival, bool rival_stands, Instant now) {
  const auto& own = announcement_.round.coalition;
  if (rival.coalition == own || machine_.in(State::closed)) return;
  const bool stands = !electors_.empty() && has_authority(now);
  if (stands == rival_stands ? own < rival.coalition : stands) {
    next_heartbeat_ = now;  // so that the other hears of it
    return;
  }
  MemberStatus known{rival, own.leader, {}};
  for (const auto& entry : ledger_) {
    if (entry.ownership == Ownership::done) {
      known.tasks.push_back({entry.task, TaskState::done, entry.done_at});
    }
  }
  close({Reason::superseded, rival.coalition.leader}, now);
  if (!known.tasks.empty()) messages_.push(std::move(known));
  outputs_.push(Superseded{announcement_.round, rival.coalition});
}

/// Half of the electors have not been heard for so long that none of them can be at work under
/// another leader: the next coalition that stands chooses its electors anew.
void Initiator::start_anew(Instant now) {
  if (authority_until() >= now || now < starts_anew_at()) return;
  electors_.clear();
  promised_until_ = Instant::max();
}

Instant Initiator::starts_anew_at() const {
  const Instant until = authority_until();
  if (until == Instant::max()) return until;
  return (until == Instant::min() ? announcement_.formed_at : until) + params_.cut_max;
}

/// Whose support a successor has not settled yet may be chosen by any of the lost leader's
/// electors.
Initiator::Electorate Initiator::electorate() const {
  const bool settled = promised_until_ == Instant::max();
  const CoalitionId& coalition = announcement_.round.coalition;
  Electorate all{coalition, electors_, settled ? electors_.size() / 2 + 1 : 1, authority_until(),
                 starts_anew_at()};
  all.others.erase(coalition.leader);
  return all;
}

void Initiator::allocation_failed(const Round& round, const std::string& detail, Instant now) {
  if (round != announcement_.round) return;
  note_planning_time(now);
  if (!machine_.in(State::allocating)) return;
  not_formed(Event::allocation_failed, {Reason::no_allocation, {}, detail}, now);
}

/// A planner that is slower than it was thought to be would never have a plan in time. What it is
/// given is bounded by the leases, which must reach beyond the award.
void Initiator::note_planning_time(Instant now) {
  const Duration took = now - planning_since_;
  if (took < params_.allocation_time) return;
  params_.allocation_time =
      std::max(params_.allocation_time, std::min(3 * took / 2, params_.lease / 2));
}

/// Where the air is slower than it was thought to be, no round would have more than the leader's
/// own bid: the others come when it is over, or is about to be.
void Initiator::note_late_bid(Instant now) {
  late_bid_took_ = std::max(late_bid_took_, now - announcement_.announced_at);
  if (machine_.in(State::monitoring)) heed_late_bids();
}

/// What bids are given is bounded by the leases, as above.
void Initiator::heed_late_bids() {
  const Duration delay = 3 * late_bid_took_ / 4;  // there and back, and half as long again
  params_.message_delay =
      std::max(params_.message_delay, std::min(delay, params_.lease / kDelaysInLease));
}

void Initiator::not_formed(Event event, const Why& why, Instant now) {
  if (!machine_.fire(event)) return;
  heed_late_bids();
  // Frees the bidders, and with them whoever has confirmed an award that not all can fly.
  messages_.push(Cancel{announcement_.round, why});
  outputs_.push(NotFormed{announcement_.round, why});
  deadline_ = now + params_.monitoring_interval + stagger();
}

/// Where rounds are nearly as long as the time between them, leaders that wait for each other's
/// bidders would for ever ask at the same times: each waits for another while, every time.
Duration Initiator::stagger() const {
  const Duration longer = params_.allocation_time - params_.monitoring_interval / 10;
  if (longer <= Duration{}) return {};
  const auto& round = announcement_.round;
  Random random{(std::uint64_t{round.coalition.leader.value} << 32U) ^ round.number};
  return from_seconds(random.uniform(0.0, 4.0) * to_seconds(longer));
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
        reopen(entry);
      }
    }
    if (machine_.in(State::awarding)) {
      std::string detail = message.why.detail;
      if (detail.empty()) {
        detail = to_string(message.why.reason);
        std::ranges::replace(detail, '_', ' ');
      }
      not_formed(Event::not_confirmed, {Reason::award_refused, message.member, std::move(detail)},
                 now);
    }
    return;
  }
  member->second = true;
  if (machine_.in(State::awarding) && all_confirmed()) {
    machine_.fire(Event::confirmed);
    outputs_.push(Formed{announcement_.round, award_->assignments});
    next_heartbeat_ = now;
    found(now);
  }
}

/// The coalition stands. Who may choose another leader is settled the first time, and again only
/// where nobody is left who could.
void Initiator::found(Instant now) {
  const VehicleId self = announcement_.round.coalition.leader;
  std::map<VehicleId, ElectorEntry> supporters;
  const bool taken_over = promised_until_ != Instant::max();
  if (taken_over) {
    const auto came_over = std::count_if(confirmed_.begin(), confirmed_.end(), [&](const auto& c) {
      return c.first != self && electors_.contains(c.first);
    });
    if (static_cast<std::size_t>(came_over) + 1 < majority_) return;
    promised_until_ = Instant::max();
    supporters.swap(electors_);
  }
  if (electors_.size() > 1) return;
  electors_[self].acknowledged = now;
  for (const auto& [vehicle, yes] : confirmed_) {
    const auto bid = bids_.find(vehicle);  // none of who came over with the plan that it held
    const InstanceId instance =
        bid == bids_.end() ? supporters[vehicle].instance : bid->second.instance;
    electors_.try_emplace(vehicle, ElectorEntry{Instant::min(), instance, award_->awarded_at});
  }
}

void Initiator::on_status(const MemberStatus& message, Instant now) {
  const bool own = message.round.coalition == announcement_.round.coalition;
  if (own) heard_[message.member] = now;
  for (const auto& reported : message.tasks) {
    Entry* entry = find(reported.task);
    if (entry == nullptr || entry->ownership == Ownership::done) continue;
    if (!own && reported.state != TaskState::done && reported.state != TaskState::unknown) continue;
    const bool owner =
        entry->ownership == Ownership::leased && entry->assignment.vehicle == message.member;
    if (reported.state == TaskState::done) {  // whoever did it, it is done
      entry->ownership = Ownership::done;
      entry->assignment.vehicle = message.member;
      entry->done_at = reported.time;
      next_heartbeat_ = now;  // who waits for it hears it at once
    } else if (reported.state == TaskState::unknown && entry->ownership != Ownership::unknown) {
      entry->maybe_flown = true;
      if (entry->ownership == Ownership::open) make_unknown(*entry);
    } else if (owner && message.round == entry->round) {  // not of an award before this one
      if (reported.state == TaskState::failed) lose(*entry, Reason::owner_failed);
      if (reported.state == TaskState::started) entry->reported = TaskState::started;
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
  messages_.push(farewell());
  outputs_.push(AllDone{announcement_.round});
}

LeaseRenewal Initiator::farewell() const {
  LeaseRenewal last;
  last.round = announcement_.round;
  last.site = announcement_.site.id;
  last.done = tasks_that_are(Ownership::done);
  last.unknown = tasks_that_are(Ownership::unknown);
  last.closed = true;
  return last;
}

/// Within its lease, by an owner of whom nothing more is heard.
bool Initiator::may_be_flown(const Entry& entry) const {
  const bool due =
      authorised_rounds_.contains(entry.round.number) && entry.assignment.time <= entry.lease_until;
  return entry.task.kind == TaskKind::deliver && (due || entry.reported == TaskState::started);
}

void Initiator::expire(Instant now) {
  for (auto& entry : ledger_) {
    if (entry.ownership != Ownership::leased || now < entry.lease_until + params_.clock_guard)
      continue;
    if (may_be_flown(entry)) {
      make_unknown(entry);
    } else {
      lose(entry, Reason::owner_silent);
    }
  }
  finish_if_done();
}

/// Nobody's again, unless the ground station has said that it may have been flown.
void Initiator::reopen(Entry& entry) {
  if (entry.maybe_flown) {
    make_unknown(entry);
  } else {
    entry.ownership = Ownership::open;
  }
}

void Initiator::lose(Entry& entry, Reason why) {
  reopen(entry);
  if (entry.ownership == Ownership::open) {
    outputs_.push(TaskLost{entry.round, entry.assignment, why});
  }
}

void Initiator::make_unknown(Entry& entry) {
  entry.ownership = Ownership::unknown;
  outputs_.push(TaskUnknown{entry.round, entry.assignment});
}

void Initiator::heartbeat(Instant now) {
  next_heartbeat_ = now + params_.heartbeat;
  std::set<VehicleId> members;
  for (const auto& entry : ledger_) {
    if (entry.ownership != Ownership::leased || entry.maybe_flown) continue;
    const auto confirmed = confirmed_.find(entry.assignment.vehicle);
    const bool unconfirmed =
        entry.round == announcement_.round && confirmed != confirmed_.end() && !confirmed->second;
    if (unconfirmed || !hears(entry.assignment.vehicle, now)) continue;
    members.insert(entry.assignment.vehicle);
  }
  LeaseRenewal renewal;
  renewal.round = announcement_.round;
  renewal.site = announcement_.site.id;
  renewal.members = {members.begin(), members.end()};
  if (promised_until_ == Instant::max()) {  // until then they are those of the lost leader
    for (const auto& [vehicle, elector] : electors_) renewal.electors.push_back(vehicle);
  }
  renewal.done = tasks_that_are(Ownership::done);
  renewal.unknown = tasks_that_are(Ownership::unknown);
  renewal.sent_at = now;
  renewal.lease_until = std::max(Instant{}, std::min(authority_until(), now + params_.lease));
  for (auto& entry : ledger_) {
    if (entry.ownership == Ownership::leased && members.contains(entry.assignment.vehicle)) {
      entry.lease_until = std::max(entry.lease_until, renewal.lease_until);
    }
  }
  messages_.push(std::move(renewal));
}

void Initiator::announce_again(Reason why, Instant now) {
  if (!machine_.in(State::executing) || !machine_.fire(Event::try_again)) return;
  outputs_.push(NotFormed{announcement_.round, {why}});
  start_round(now);
}

void Initiator::authorised(const Round& round) { authorised_rounds_.insert(round.number); }

void Initiator::close(const Why& why, Instant /*now*/) {
  if (machine_.in(State::closed) || !machine_.fire(Event::closed)) return;
  std::set<Round> rounds{announcement_.round};
  for (const auto& entry : ledger_) {
    if (entry.ownership == Ownership::leased) rounds.insert(entry.round);
  }
  for (const auto& round : rounds) messages_.push(Cancel{round, why});
}

void Initiator::on_timeout(Instant now) {
  if (machine_.in(State::closed)) return;
  expire(now);
  start_anew(now);
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
        note_planning_time(now);
        not_formed(Event::allocation_failed, {Reason::allocation_too_late}, now);
      }
      break;
    case State::awarding:
      if (now >= deadline_) {
        not_formed(Event::not_confirmed, {Reason::not_confirmed}, now);
      } else if (now >= next_repeat_) {
        next_repeat_ = now + params_.message_delay;
        messages_.push(*award_);
      }
      break;
    case State::monitoring:
      if (now >= deadline_ && has_authority(now) && machine_.fire(Event::try_again)) {
        start_round(now);
      }
      break;
    case State::executing: {
      const bool owned_by_anyone = std::any_of(ledger_.begin(), ledger_.end(), [](const Entry& e) {
        return e.ownership == Ownership::leased;
      });
      // Who is heard and does not bid, since what it hears comes too late, is not asked on and on:
      // the air would be full of it, and no decision of the operator's in time.
      const bool may_ask_again = now >= announcement_.announced_at + params_.monitoring_interval;
      const auto needs_round = [&](const Entry& e) {
        // An owner that is heard and has not begun in time holds at its gate. One that is not heard
        // keeps its lease until that runs out.
        const bool overdue = e.ownership == Ownership::leased && e.reported == TaskState::planned &&
                             now > due(e) + kOverdue && hears(e.assignment.vehicle, now) &&
                             may_ask_again;
        const bool waits = e.left_over && owned_by_anyone;
        return overdue || (e.ownership == Ownership::open && !waits);
      };
      if (has_authority(now) && std::any_of(ledger_.begin(), ledger_.end(), needs_round)) {
        announce_again(Reason::tasks_open, now);
      }
      break;
    }
    case State::closed:
    case State::count:
      break;
  }
}

/// An assessment waits for deliveries that were awarded again after it.
Instant Initiator::due(const Entry& entry) const {
  if (entry.task.kind == TaskKind::deliver) return entry.assignment.time;
  const auto delivered = last_delivery();
  return delivered ? std::max(entry.assignment.time, *delivered + announcement_.site.assess_wait)
                   : entry.assignment.time;
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

std::vector<Initiator::Outstanding> Initiator::outstanding() const {
  std::vector<Outstanding> all;
  for (const auto& entry : ledger_) {
    if (entry.ownership != Ownership::leased) continue;
    all.push_back({entry.task, entry.assignment.vehicle, entry.round,
                   entry.lease_until + params_.clock_guard,
                   entry.maybe_flown || may_be_flown(entry)});
  }
  return all;
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

std::vector<TaskId> Initiator::tasks_that_are(Ownership ownership) const {
  std::vector<TaskId> tasks;
  for (const auto& entry : ledger_) {
    if (entry.ownership == ownership) tasks.push_back(entry.task);
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
