// SPDX-License-Identifier: Apache-2.0
#include "skein/coalition/elector.hpp"

#include <algorithm>
#include <utility>

#include "skein/base/contains.hpp"

namespace skein::coalition {
namespace {
constexpr std::size_t kLeftMax = 16;
/// Between the first claims of two electors, so that they do not split the others.
constexpr Duration kStagger = std::chrono::milliseconds{1500};
constexpr VehicleId kNobody{};
}  // namespace

Elector::Elector(const ProtocolParams& params, VehicleId self, InstanceId instance)
    : params_{params}, instance_{instance}, self_{self} {}

void Elector::accepted(const Award& award) {
  const bool goes_on = plan_ && plan_->round.coalition == award.round.coalition;
  const bool succeeded = succeeds(award);
  if (!goes_on) leave();
  if (!goes_on && !succeeded) done_.clear();
  plan_ = award;
}

void Elector::leave() {
  if (plan_ && !strayed_ && !contains(left_, plan_->round.coalition)) {
    left_.push_back(plan_->round.coalition);
    if (left_.size() > kLeftMax) left_.erase(left_.begin());
  }
  plan_.reset();
  elector_ = false;
  electors_.clear();
  supporters_.clear();
  won_.reset();
  follows_ = kNobody;
  renewed_at_ = Instant::min();
  strayed_ = false;
}

void Elector::cancelled() {
  if (!elector_ || strayed_) return;
  messages_.push(Allegiance{plan_->round.coalition, self_, instance_, kNobody, renewed_at_});
}

void Elector::on_lease_renewal(const LeaseRenewal& message, Instant now) {
  const CoalitionId& coalition = message.round.coalition;
  if (coalition.leader == self_) return;  // it follows itself, and its initiator knows
  const bool named = contains(message.electors, self_);
  if (contains(left_, coalition)) {
    if (named) messages_.push(Allegiance{coalition, self_, instance_, kNobody, message.sent_at});
    return;
  }
  if (!plan_ || plan_->round.coalition != coalition) return;
  for (const auto& task : message.done) {
    if (!contains(done_, task)) done_.push_back(task);
  }
  // Who has promised to follow a claimant is deaf to the old leader until that promise is over.
  // A renewal that comes late, or twice, names electors that may have left since: as this vehicle
  // may have, by an earlier start, before it was awarded anew.
  if (message.sent_at < renewed_at_ || message.sent_at <= plan_->awarded_at) return;
  if (!named || (elector_ && follows_ != coalition.leader && !promise_over(now))) return;
  elector_ = true;
  renewed_at_ = message.sent_at;
  electors_ = message.electors;
  supporters_.clear();
  follow(coalition.leader, message.sent_at, now);
}

void Elector::follow(VehicleId whom, Instant stamp, Instant now) {
  follows_ = whom;
  strayed_ = strayed_ || whom != plan_->round.coalition.leader;
  promised_until_ = now + params_.lease;
  messages_.push(Allegiance{plan_->round.coalition, self_, instance_, whom, stamp});
}

/// The guard is for leases, which end by the clocks of those that hold them.
bool Elector::promise_over(Instant now) const {
  return now >= promised_until_ + params_.clock_guard;
}

void Elector::on_claim(const LeadershipClaim& message, Instant now) {
  if (!elector_ || message.coalition != plan_->round.coalition || message.claimant == self_) return;
  if (!contains(electors_, message.claimant)) return;
  // A claim of its own that has not won binds nobody: it gives way to that of a lower id.
  const bool gives_way = follows_ == self_ && message.claimant < self_;
  if (message.claimant != follows_ && !gives_way && !promise_over(now)) return;
  supporters_.clear();
  follow(message.claimant, message.sent_at, now);
}

/// The electors claim in the order of their ids, some time apart.
Instant Elector::claims_at() const {
  const auto before = std::count_if(electors_.begin(), electors_.end(), [&](VehicleId e) {
    return e < self_ && e != plan_->round.coalition.leader;
  });
  return promised_until_ + params_.clock_guard + before * kStagger;
}

void Elector::on_timeout(Instant now) {
  if (!elector_ || !may_lead_) return;
  const bool claiming = follows_ == self_;
  if (!claiming && now < claims_at()) return;
  if (now < next_claim_) return;
  next_claim_ = now + params_.heartbeat;
  if (claiming) {
    count_supporters(now);  // after a heartbeat: whoever can answer has
  } else {
    supporters_.clear();
  }
  follows_ = self_;
  strayed_ = true;
  promised_until_ = now + params_.lease;
  supporters_[self_] = {now, instance_};
  messages_.push(LeadershipClaim{plan_->round.coalition, self_, now});
}

void Elector::on_allegiance(const Allegiance& message, Instant now) {
  if (!elector_ || !may_lead_ || message.coalition != plan_->round.coalition) return;
  if (message.follows != self_ || follows_ != self_ || !contains(electors_, message.elector))
    return;
  if (message.acknowledges > now) {  // no claim that was made here
    ++bad_messages_;
    return;
  }
  auto& [acknowledged, instance] = supporters_[message.elector];
  acknowledged = std::max(acknowledged, message.acknowledges);
  instance = message.instance;
  if (supporters_.size() + 1 == electors_.size()) count_supporters(now);  // all but the leader
}

void Elector::count_supporters(Instant now) {
  Won won;
  won.promised_from = now;
  for (const auto& [elector, support] : supporters_) {
    if (now > support.acknowledged + params_.silence) continue;
    won.supporters.push_back({elector, support.instance});
    won.promised_from = std::min(won.promised_from, support.acknowledged);
  }
  won.majority = electors_.size() / 2 + 1;
  if (won.supporters.size() < won.majority) return;
  won.plan = *plan_;
  won.done = done_;
  won_ = std::move(won);
}

std::optional<Elector::Won> Elector::poll_won() { return std::exchange(won_, std::nullopt); }

bool Elector::succeeds(const Award& award) const {
  return elector_ && award.continues == plan_->round.coalition &&
         award.round.coalition.leader == follows_ && follows_ != award.continues.leader;
}

void Elector::on_status(const MemberStatus& message) {
  if (!plan_ || message.round.coalition != plan_->round.coalition) return;
  for (const auto& entry : message.tasks) {
    if (entry.state == TaskState::done && !contains(done_, entry.task)) done_.push_back(entry.task);
  }
}

Instant Elector::next_timeout() const {
  if (!elector_ || !may_lead_) return Instant::max();
  return follows_ == self_ ? next_claim_ : std::max(claims_at(), next_claim_);
}

}  // namespace skein::coalition
