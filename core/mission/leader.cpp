// SPDX-License-Identifier: Apache-2.0
#include "leader.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "skein/base/assert.hpp"
#include "skein/base/contains.hpp"
#include "skein/base/overloaded.hpp"

namespace skein::mission {
namespace {

/// So often all open tasks of a site are tried at once.
constexpr int kRoundsForAll = 3;
/// The decision must be there this long before the first gate, so that it reaches every member.
constexpr Duration kDecisionMargin = std::chrono::seconds{2};
constexpr Duration kRequestPeriod = std::chrono::seconds{1};
constexpr int kFarewells = 5;
constexpr std::size_t kFarewellsMax = 16;
constexpr std::size_t kGrantsMax = 64;

/// Of things of which there are few.
template <class Container>
std::uint8_t count_of(const Container& some) {
  return static_cast<std::uint8_t>(std::min<std::size_t>(some.size(), 255));
}

/// Of the lots that a plan may need: another for every round, the same in every replay.
std::uint64_t seed_of(const coalition::Round& round) {
  const std::uint64_t coalition =
      (std::uint64_t{round.coalition.leader.value} << 32U) | round.coalition.number;
  return (coalition << 8U) ^ round.number;
}

/// Deliveries are made together; assessments, where nobody more can be had, one after another.
void leave_for_later(std::vector<TaskId>& tasks, const std::vector<coalition::Bid>& bids) {
  if (std::ranges::any_of(tasks, [](const TaskId& task) { return task.kind == TaskKind::deliver; }))
    return;
  const auto able = std::ranges::count_if(
      bids, [](const coalition::Bid& bid) { return bid.capabilities.has(TaskKind::assess); });
  const auto most = static_cast<std::size_t>(able);
  if (most > 0 && most < tasks.size()) tasks.resize(most);
}
}  // namespace

using coalition::Reason;

/// Precondition: the table has it.
void Leader::fire(Event event) {
  const bool known = machine_.fire(event);
  SKEIN_ASSERT(known);
}

void Leader::lead(const SurveyedSite& what, Instant now) {
  if (tasks_after_survey(what.site).empty()) {
    outbox_.report(event::SiteDone{}, {}, {what.site.id, TaskKind::survey, 0}, now);
    return;
  }
  fire(Event::taken_up);
  rounds_failed_ = 0;
  initiator_.emplace(protocol_, next_coalition(), what.site, what.over, position_at_formation(now),
                     now);
  outbox_.report(event::Announced{count_of(initiator_->announcement().tasks), {}},
                 initiator_->round(), about_site(), now);
}

void Leader::take_over(const coalition::Participant::LeadershipWon& won, Instant now) {
  if (leading()) return;
  fire(Event::taken_up);
  rounds_failed_ = 0;
  bids_.clear();  // of a site that was led here before
  initiator_.emplace(protocol_, next_coalition(), won, contains(granted_, won.plan.round),
                     position_at_formation(now), now);
  const VehicleId lost = won.plan.round.coalition.leader;
  outbox_.report(event::LeaderReplaced{lost, count_of(won.supporters)}, initiator_->round(),
                 about_site(), now);
}

coalition::CoalitionId Leader::next_coalition() {
  return {ownship_.spec().id, ownship_.config().instance, ++coalitions_led_};
}

Vec2 Leader::position_at_formation(Instant now) const {
  const auto& protocol = initiator_ ? initiator_->params() : protocol_;
  const Instant formed_at = now + protocol.formation_time();
  return ownship_.flight().pose_at(formed_at).position();
}

std::optional<PutOffSite> Leader::on_message(const coalition::Message& message, Instant now) {
  std::optional<PutOffSite> gives_way;
  std::visit(
      Overloaded{[&](const coalition::Announcement& m) {
                   for (auto& farewell : farewells_) {
                     if (farewell.last.site == m.site.id) farewell.times = 1;
                   }
                   meet_rival(m.site.id, m.round, false, now);
                   if (!yields_to(m, now)) return;
                   const auto& own = initiator_->announcement();
                   outbox_.report(
                       event::ConflictYielded{m.round.coalition.leader, own.reward, false},
                       own.round, about_site(), now);
                   gives_way = put_off(Reason::yields, now);
                 },
                 [&](const coalition::Award& m) { meet_rival(m.site.id, m.round, true, now); },
                 [&](const coalition::LeaseRenewal& m) {
                   const bool led_here = initiator_ && initiator_->site().id == m.site;
                   if (m.closed && led_here && leads_other(m.round.coalition)) {
                     give_up({Reason::site_done}, now);
                   }
                   meet_rival(m.site, m.round, stands(m), now);
                 },
                 [&](const coalition::Bid& m) {
                   if (initiator_) initiator_->on_bid(m, now);
                 },
                 [&](const coalition::Confirmation& m) {
                   if (initiator_) initiator_->on_confirmation(m, now);
                 },
                 [&](const coalition::MemberStatus& m) {
                   if (initiator_) initiator_->on_status(m, now);
                 },
                 [&](const coalition::Allegiance& m) {
                   if (initiator_) initiator_->on_allegiance(m, now);
                 },
                 [](const coalition::Cancel&) {}, [](const coalition::LeadershipClaim&) {}},
      message);
  return gives_way;
}

void Leader::meet_rival(SiteId site, const coalition::Round& rival, bool stands, Instant now) {
  if (initiator_ && initiator_->site().id == site) initiator_->on_rival(rival, stands, now);
}

/// Two leaders announce at once: the one with the smaller reward, then the higher id, bids for the
/// other and keeps its own site for later (Wang 2022, protocol step 2). So does one whose rounds
/// have been in vain, whatever the reward, where it can do some of the other's work: those
/// that it waits for may lead in vain, and wait for it.
bool Leader::yields_to(const coalition::Announcement& other, Instant now) const {
  if (!leads_other(other.round.coalition) || !initiator_->owned().empty()) return false;
  if (!in_vain() && initiator_->state() != Initiator::State::announcing) return false;
  if (now >= other.bids_until + ownship_.config().protocol.clock_guard) return false;
  if (!makes_sense(other, now)) return false;  // its own member does not bid for that either
  const auto& own = initiator_->announcement();
  if (other.site.id == own.site.id) return false;  // a rival: Initiator::on_rival
  const auto can = [this](const TaskId& task) { return ownship_.can(task); };
  if (in_vain()) return std::ranges::any_of(other.tasks, can);
  return own.reward < other.reward ||
         (own.reward == other.reward && ownship_.spec().id > other.round.coalition.leader);
}

/// Nor could all that can be had do less.
bool Leader::in_vain() const {
  return monitoring() && initiator_->owned().empty() && rounds_failed_ > kRoundsForAll;
}

std::optional<PutOffSite> Leader::put_off(Reason why, Instant now) {
  if (!leading()) return std::nullopt;
  PutOffSite what{initiator_->site(), initiator_->outstanding(), initiator_->electorate()};
  give_up({why}, now);
  return what;
}

void Leader::hand_on(Reason why, Instant now) {
  if (!leading() || !initiator_->owned().empty()) return;
  outbox_.report(event::Cancelled{{why}}, initiator_->round(), about_site(), now);
  give_up({why}, now);
}

void Leader::withdraw(SiteId site, Instant now) {
  if (!leading() || initiator_->site().id != site) return;
  if (!machine_.in(State::parting)) {
    outbox_.report(event::Cancelled{{Reason::site_withdrawn}}, initiator_->round(), about_site(),
                   now);
  }
  give_up({Reason::site_withdrawn}, now);
}

void Leader::give_up(const coalition::Why& why, Instant now) {
  initiator_->close(why, now);
  end();
}

void Leader::end() {
  // Its last words: cancels and releases.
  while (auto message = initiator_->poll_message()) last_words_.push(std::move(*message));
  tally_ += initiator_->tally();
  protocol_ = initiator_->params();
  initiator_.reset();
  fire(Event::ended);
}

void Leader::part() {
  if (machine_.in(State::parting)) end();
}

std::optional<coalition::Message> Leader::poll_message() {
  if (auto words = poll_last_words()) return words;
  return initiator_ ? initiator_->poll_message() : std::nullopt;
}

bool Leader::answer_next(Instant now) {
  if (!initiator_) return false;
  const auto output = initiator_->poll_output();
  if (!output) return false;
  std::visit([&](const auto& asked) { answer(asked, now); }, *output);
  return true;
}

void Leader::answer(const Initiator::AllocationWanted& wanted, Instant /*now*/) {
  PlanningRequest request;
  request.round = wanted.round;
  request.answer_by = wanted.answer_by;
  request.params = ownship_.config().planning;
  auto& problem = request.problem;
  problem.site = initiator_->site();
  problem.open_tasks = wanted.tasks;
  if (rounds_failed_ >= kRoundsForAll) leave_for_later(problem.open_tasks, wanted.bids);
  problem.seed = seed_of(wanted.round);
  problem.hazards = planning::with_room_for_arcs(ownship_.hazards());
  problem.start = wanted.formed_at;
  Duration approach{};
  for (const auto& bid : wanted.bids) approach = std::max(approach, coalition::approach_time(bid));
  problem.earliest_delivery =
      wanted.formed_at + ownship_.config().protocol.authorisation_lead + kDecisionMargin + approach;
  // A task that is open in this round is not owned, so this looks at deliveries of others only.
  problem.deliveries_done = initiator_->last_delivery().value_or(Instant{});
  bids_.clear();
  for (const auto& bid : wanted.bids) {
    bids_.emplace(bid.bidder, bid);
    problem.candidates.push_back({bid.bidder, bid.pose_at_formation, bid.speed_mps,
                                  bid.planning_radius_m, bid.range_left_m, bid.final_approach_m,
                                  bid.assess_radius_m, bid.capabilities, bid.loads});
  }
  outbox_.planning_requests.push(std::move(request));
}

bool Leader::on_planning_result(const PlanningResult& result, Instant now) {
  if (!initiator_ || result.round != initiator_->round()) return false;
  if (result.allocation) {
    const auto& assignments = result.allocation->assignments;
    const planning::Allocation& made = *result.allocation;
    outbox_.report(
        event::AllocationDone{result.took, count_of(bids_), made.method, made.value.total,
                              made.proven, made.proven ? 0.0 : made.gap()},
        result.round, about_site(), now);
    initiator_->allocated(result.round, assignments, now);
    if (initiator_->state() == Initiator::State::awarding) {
      outbox_.report(event::Awarded{count_of(assignments)}, result.round, about_site(), now);
    }
  } else {
    const auto& why = result.allocation.error().message;
    outbox_.report(event::AllocationFailed{count_of(bids_), why}, result.round, about_site(), now);
    initiator_->allocation_failed(result.round, why, now);
  }
  return true;
}

void Leader::answer(const Initiator::Formed& formed, Instant now) {
  rounds_failed_ = 0;
  std::set<VehicleId> vehicles{ownship_.spec().id};
  for (const auto& a : formed.assignments) vehicles.insert(a.vehicle);
  outbox_.report(event::CoalitionFormed{count_of(vehicles)}, formed.round, about_site(), now);
  ask_operator(formed, now);
}

void Leader::answer(const Initiator::NotFormed& failed, Instant now) {
  ++rounds_failed_;
  fire(Event::round_ended);
  const std::uint8_t tasks = count_of(initiator_->announcement().tasks);
  outbox_.report(monitoring() ? EventBody{event::Monitoring{tasks, failed.why}}
                              : EventBody{event::Announced{tasks, failed.why}},
                 failed.round, about_site(), now);
}

void Leader::answer(const Initiator::TaskLost& lost, Instant now) {
  outbox_.report(event::TaskLost{{lost.why, lost.assignment.vehicle}}, lost.round,
                 lost.assignment.task, now);
}

void Leader::answer(const Initiator::TaskUnknown& unknown, Instant now) {
  outbox_.report(event::TaskUnknown{unknown.assignment.vehicle}, unknown.round,
                 unknown.assignment.task, now);
}

void Leader::answer(const Initiator::Superseded& superseded, Instant now) {
  outbox_.report(event::ConflictYielded{superseded.by.leader, 0.0, true}, superseded.round,
                 about_site(), now);
  fire(Event::over);
}

void Leader::answer(const Initiator::AllDone& /*done*/, Instant now) {
  outbox_.report(event::SiteDone{count_of(tasks_after_survey(initiator_->site()))},
                 initiator_->round(), about_site(), now);
  farewells_.push_back({initiator_->farewell(), now, kFarewells});
  if (farewells_.size() > kFarewellsMax) farewells_.erase(farewells_.begin());
  fire(Event::over);
}

void Leader::ask_operator(const Initiator::Formed& formed, Instant now) {
  const auto& site = initiator_->site();
  AuthorisationRequest request{formed.round, site.id, site.position, {}, Instant::max()};
  for (const auto& a : formed.assignments) {
    if (a.task.kind != TaskKind::deliver) continue;
    request.deliveries.push_back({a, site.deliveries.at(a.task.index).bearing_rad});
    request.decide_by = std::min(request.decide_by, decide_by(a));
  }
  if (request.deliveries.empty()) return;
  outbox_.report(event::AuthorisationRequested{request.decide_by}, formed.round,
                 {site.id, TaskKind::deliver, 0}, now);
  request_ = std::move(request);
  request_again_ = now;
  fire(Event::asked);
}

/// When the operator's decision on that delivery must be there. Who leads on a lost leader's plan
/// has not heard the bids for it: its own final approach stands for the others'. Where that is too
/// short they are late at the gate, and there is another round.
Instant Leader::decide_by(const TaskAssignment& delivery) const {
  const auto bid = bids_.find(delivery.vehicle);
  const Duration approach =
      bid != bids_.end() ? coalition::approach_time(bid->second) : ownship_.approach_time();
  return delivery.time - approach - kDecisionMargin;
}

void Leader::on_authorisation(const Authorisation& message, Instant now) {
  if (!message.granted) return on_refusal(message, now);
  if (!contains(granted_, message.round)) {
    granted_.push_back(message.round);
    if (granted_.size() > kGrantsMax) granted_.erase(granted_.begin());
  }
  if (!leading()) return;
  // A grant counts for the rounds before this one too: a member may have heard it and begun.
  if (!leads_other(message.round.coalition)) initiator_->authorised(message.round);
  const bool asked = machine_.in(State::awaiting_decision) && message.round == request_.round;
  if (asked) fire(Event::granted);
}

/// Of the round that awaits its decision, or of one that was granted before: what of it has begun
/// is flown to its end, and nobody leads the site any more.
void Leader::on_refusal(const Authorisation& message, Instant now) {
  if (!leading() || machine_.in(State::parting) || initiator_->site().id != message.site) return;
  const bool granted = contains(granted_, message.round);
  const bool asked = machine_.in(State::awaiting_decision) && message.round == request_.round;
  if (asked && !granted) {
    outbox_.report(event::AuthorisationRefused{message.decided_by}, message.round,
                   {message.site, TaskKind::deliver, 0}, now);
    give_up({Reason::refused_by_operator}, now);
  } else if (granted || !leads_other(message.round.coalition)) {
    outbox_.report(event::Cancelled{{Reason::grant_taken_back}}, initiator_->round(), about_site(),
                   now);
    give_up({Reason::grant_taken_back}, now);
  }
}

void Leader::on_timeout(Instant now) {
  if (!initiator_) return;
  initiator_->set_leader_at_formation(position_at_formation(now));
  initiator_->on_timeout(now);
}

void Leader::repeat(Instant now) {
  say_farewell(now);
  watch_decision(now);
}

/// The end of a coalition is said several times, and again to whoever announces its site.
void Leader::say_farewell(Instant now) {
  for (auto& farewell : farewells_) {
    if (farewell.times == 0 || now < farewell.next) continue;
    --farewell.times;
    farewell.next = now + ownship_.config().protocol.heartbeat;
    outbox_.messages.push(Message{coalition::Message{farewell.last}});
  }
}

void Leader::watch_decision(Instant now) {
  if (!machine_.in(State::awaiting_decision)) return;
  if (now >= request_.decide_by) {
    outbox_.report(event::AuthorisationLate{event::Lateness::no_decision}, request_.round,
                   {request_.site, TaskKind::deliver, 0}, now);
    fire(Event::round_ended);
    initiator_->announce_again(Reason::no_decision, now);
  } else if (now >= request_again_) {
    outbox_.messages.push(Message{request_});
    request_again_ = now + kRequestPeriod;
  }
}

bool Leader::leads_other(const coalition::CoalitionId& than) const {
  return initiator_ && initiator_->round().coalition != than;
}

bool Leader::monitoring() const {
  return initiator_ && initiator_->state() == Initiator::State::monitoring;
}

Instant Leader::next_timeout() const {
  Instant next = initiator_ ? initiator_->next_timeout() : Instant::max();
  for (const auto& farewell : farewells_) {
    if (farewell.times > 0) next = std::min(next, farewell.next);
  }
  if (machine_.in(State::awaiting_decision)) {
    next = std::min({next, request_again_, request_.decide_by});
  }
  return next;
}

coalition::Tally Leader::tally() const {
  coalition::Tally all = tally_;
  if (initiator_) all += initiator_->tally();
  all.dropped += last_words_.dropped();
  return all;
}

std::string_view to_string(Leader::State state) {
  static constexpr std::array<std::string_view, 4> kNames{"idle", "leading", "awaiting_decision",
                                                          "parting"};
  static_assert(kNames.size() == static_cast<std::size_t>(Leader::State::count));
  return kNames.at(static_cast<std::size_t>(state));
}

std::string_view to_string(Leader::Event event) {
  static constexpr std::array<std::string_view, 6> kNames{"taken_up",    "asked", "granted",
                                                          "round_ended", "over",  "ended"};
  static_assert(kNames.size() == static_cast<std::size_t>(Leader::Event::count));
  return kNames.at(static_cast<std::size_t>(event));
}

}  // namespace skein::mission
