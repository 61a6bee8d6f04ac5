// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/ground_agent.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "names.hpp"
#include "skein/base/contains.hpp"

namespace skein::mission {
namespace {

constexpr Duration kAuthorisationRepeat = std::chrono::milliseconds{500};
constexpr Duration kCommandRepeat = std::chrono::seconds{1};
constexpr Duration kCommandRepeatedFor = std::chrono::seconds{5};
// What a flood from the network can make us remember.
constexpr std::size_t kAuthorisationsMax = 64;
constexpr std::size_t kSeenEventsMax = 8192;
constexpr std::size_t kTasksRememberedMax = 1024;
constexpr std::size_t kSitesRememberedMax = 64;
// How often it passes on what a leader says, and that a site is closed.
constexpr Duration kLeaderPassedOn = std::chrono::seconds{10};
constexpr Duration kClosedPassedOn = std::chrono::seconds{1};
constexpr int kClosedTimes = 5;
constexpr Duration kLeaderLost = std::chrono::seconds{75};
/// A vehicle's from that of the ground station; more than ProtocolParams::clock_guard.
constexpr Duration kClocksDiffer = std::chrono::seconds{1};
/// How far the numbers of orders may be ahead of the mission's time.
constexpr Duration kOrdersAheadMax = std::chrono::seconds{60};

Instant last_delivery(const AuthorisationRequest& request) {
  Instant last = request.decide_by;
  for (const auto& delivery : request.deliveries) last = std::max(last, delivery.assignment.time);
  return last;
}

}  // namespace

GroundAgent::GroundAgent(const GroundAgentConfig& config, Instant /*now*/)
    : config_{config}, fleet_{{.expected = config.expected, .silence = config.silence}} {}

void GroundAgent::recall(const Message& message, VehicleId sender, Instant at) {
  if (std::holds_alternative<Telemetry>(message) || std::holds_alternative<Health>(message) ||
      std::holds_alternative<Preflight>(message)) {
    return;
  }
  if (sender == kGroundStation) {
    recall_own(message, at);
  } else {
    hear(message, at);
  }
  while (messages_.pop()) continue;  // said then
  while (events_.pop()) continue;
}

void GroundAgent::recall_own(const Message& message, Instant at) {
  if (const auto* decision = std::get_if<Authorisation>(&message)) {
    note_grant(*decision);
    for (PendingAuthorisation& pending : pending_) {
      const bool of_it =
          pending.request.site == decision->site && pending.request.round == decision->round;
      if (!of_it) continue;
      if (pending.decision && decision->decided_at <= pending.decision->decided_at) continue;
      const bool first = !pending.decision;
      if (first && script_for(decision->site) != nullptr) ++scripted_[decision->site];
      take(pending, *decision);
      next_repeat_ = std::min(next_repeat_, at + kAuthorisationRepeat);
    }
  } else if (const auto* report = std::get_if<SiteReport>(&message)) {
    if (report->withdrawn) end_site(report->site.id, "the operator", at);
  } else if (const auto* command = std::get_if<Command>(&message)) {
    last_command_ = std::max(last_command_, number_of(*command));
  }
}

void GroundAgent::overhear(const Message& message, Instant now) {
  if (const auto* event = std::get_if<MissionEvent>(&message)) return on_event(*event);
  const auto* decision = std::get_if<Authorisation>(&message);
  const auto waits = [&](const PendingAuthorisation& pending) {
    return !pending.decision && pending.request.round == decision->round &&
           pending.request.site == decision->site;
  };
  const bool is_news = decision != nullptr && std::ranges::any_of(pending_, waits);
  recall_own(message, now);
  if (!is_news) return;
  const std::string& by = decision->decided_by;
  report(decision->granted ? EventBody{event::Authorised{by}}
                           : EventBody{event::AuthorisationRefused{by}},
         decision->round, {decision->site, TaskKind::deliver, 0}, now);
}

/// Numbers are times: one far ahead is no order's.
void GroundAgent::note_order(std::uint64_t number, Instant now) {
  const auto ahead = std::chrono::duration_cast<std::chrono::milliseconds>(
      (now + kOrdersAheadMax).time_since_epoch());
  if (ahead.count() > 0 && number <= static_cast<std::uint64_t>(ahead.count())) {
    last_command_ = std::max(last_command_, number);
  }
}

void GroundAgent::on_message(const Message& message, Instant now) {
  hear(message, now);
  on_timeout(now);
}

void GroundAgent::hear(const Message& message, Instant now) {
  fleet_.on_message(message, now);
  if (const auto* request = std::get_if<AuthorisationRequest>(&message)) {
    on_request(*request, now);
  } else if (const auto* event = std::get_if<MissionEvent>(&message)) {
    on_event(*event);
  } else if (const auto* decision = std::get_if<Authorisation>(&message)) {
    note_grant(*decision);
  } else if (const auto* said = std::get_if<coalition::Message>(&message)) {
    if (const auto* status = std::get_if<coalition::MemberStatus>(said)) on_status(*status);
    if (const auto* renewal = std::get_if<coalition::LeaseRenewal>(said)) on_renewal(*renewal, now);
    if (const auto* a = std::get_if<coalition::Announcement>(said)) on_announcement(*a, now);
  }
}

void GroundAgent::on_timeout(Instant now) {
  fleet_.on_timeout(now);
  while (const auto news = fleet_.poll_news()) report(*news, {}, {}, now);
  if (watching_) return;
  decide_by_script(now);
  send_again(now);
}

void GroundAgent::on_request(const AuthorisationRequest& request, Instant now) {
  for (const auto& known : pending_) {
    if (known.request.site == request.site && known.request.round == request.round) return;
    // Late copies of a plan that has been replaced must not become the newest request.
    if (known.request.site == request.site &&
        known.request.round.coalition == request.round.coalition &&
        known.request.round.number > request.round.number) {
      return;
    }
  }
  std::erase_if(pending_, [&](const PendingAuthorisation& p) {
    return !p.decision && p.request.site == request.site &&
           p.request.round.coalition == request.round.coalition;
  });
  if (const auto by = withdrawn_.find(request.site); by != withdrawn_.end()) {
    // Its leader has not heard of it, or is of a release that does not know that sites can be.
    messages_.push(
        Message{Authorisation{request.round, request.site, false, by->second, now, {}, {}, {}}});
    return;
  }
  if (tell_what_is_over(request, now) || granted_to_another(request) != nullptr) return;
  if (pending_.size() >= kAuthorisationsMax) pending_.erase(pending_.begin());
  pending_.push_back({request, now, std::nullopt});
  grant_again(pending_.back(), now);
}

/// Where the same deliveries were granted in another round: the operator's approval is of those.
void GroundAgent::grant_again(PendingAuthorisation& pending, Instant now) {
  if (watching_ || pending.decision || now >= pending.request.decide_by) return;
  const Authorisation* before = granted_before(pending.request);
  if (before == nullptr || why_not_grant(pending.request, now)) return;
  Authorisation again = *before;
  again.round = pending.request.round;
  say(pending, again, now, {});
}

void GroundAgent::set_watching(bool watching, Instant now) {
  watching_ = watching;
  if (watching) return commands_.clear();  // who has not heard them asks who has the command
  for (PendingAuthorisation& pending : pending_) grant_again(pending, now);
}

void GroundAgent::on_status(const coalition::MemberStatus& status) {
  for (const auto& entry : status.tasks) {
    if (entry.state == coalition::TaskState::done) note_done(entry);
  }
}

/// Where it remembers much already, the tasks of sites that are over go first.
void GroundAgent::note_done(const coalition::TaskStatus& status) {
  if (done_.contains(status.task)) return;
  if (done_.size() >= kTasksRememberedMax) {
    const auto over = std::ranges::find_if(done_, [this](const auto& done) {
      const auto led = led_.find(done.first.site);
      return led == led_.end() || led->second.last.closed;
    });
    if (over == done_.end()) return;
    done_.erase(over);
  }
  done_.emplace(status.task, status);
}

/// What is known of that site; nothing where there is no room. Of those that are over the one that
/// was not heard of for longest makes room.
GroundAgent::LedSite* GroundAgent::led_site(SiteId site) {
  if (!led_.contains(site) && led_.size() >= kSitesRememberedMax) {
    auto oldest = led_.end();
    for (auto it = led_.begin(); it != led_.end(); ++it) {
      if (!it->second.last.closed) continue;
      if (oldest == led_.end() || it->second.heard_at < oldest->second.heard_at) oldest = it;
    }
    if (oldest == led_.end()) return nullptr;
    led_.erase(oldest);
  }
  return &led_[site];
}

void GroundAgent::on_renewal(const coalition::LeaseRenewal& renewal, Instant now) {
  LedSite* const known = led_site(renewal.site);
  if (known == nullptr || known->last.closed) return;
  LedSite& led = *known;
  led.last = renewal;
  led.heard_at = now;
  if (!renewal.closed && now < led.passed_on_at + kLeaderPassedOn) return;
  led.passed_on_at = now;
  messages_.push(Message{coalition::Message{renewal}});
}

/// Somebody announces what was done: it has not heard that the site is closed.
void GroundAgent::on_announcement(const coalition::Announcement& announcement, Instant now) {
  LedSite* const led = led_site(announcement.site.id);
  if (led == nullptr) return;
  if (!led->last.closed) {
    led->announcement = announcement;
    led->heard_at = now;
    return;
  }
  if (now < led->passed_on_at + kClosedPassedOn) return;
  led->passed_on_at = now;
  messages_.push(Message{coalition::Message{led->last}});
}

/// True when the request has deliveries that nobody may fly again: its leader is told, and asks
/// anew without them.
bool GroundAgent::tell_what_is_over(const AuthorisationRequest& request, Instant now) {
  coalition::MemberStatus over{request.round, kGroundStation, {}};
  for (const auto& delivery : request.deliveries) {
    const TaskId& task = delivery.assignment.task;
    const auto done = done_.find(task);
    const auto granted = granted_.find(task);
    if (done != done_.end()) {
      over.tasks.push_back(done->second);
    } else if (granted != granted_.end() && !granted->second.given_up &&
               granted->second.round.coalition != request.round.coalition &&
               granted->second.assignment.time <= now) {
      over.tasks.push_back({task, coalition::TaskState::unknown, granted->second.assignment.time});
    }
  }
  if (over.tasks.empty()) return false;
  messages_.push(Message{coalition::Message{std::move(over)}});
  return true;
}

/// A grant to another coalition that another vehicle may still fly: until it has said otherwise, or
/// the time has passed (tell_what_is_over), nobody else is granted that delivery.
const GroundAgent::Granted* GroundAgent::granted_to_another(
    const AuthorisationRequest& request) const {
  for (const auto& delivery : request.deliveries) {
    const auto granted = granted_.find(delivery.assignment.task);
    if (granted == granted_.end() || granted->second.given_up) continue;
    const Granted& to = granted->second;
    if (to.round.coalition != request.round.coalition &&
        to.assignment.vehicle != delivery.assignment.vehicle) {
      return &to;
    }
  }
  return nullptr;
}

/// The grant that has every delivery of the request as it stands: same vehicle, time and bearing.
const Authorisation* GroundAgent::granted_before(const AuthorisationRequest& request) const {
  std::optional<coalition::Round> round;
  for (const auto& delivery : request.deliveries) {
    const auto granted = granted_.find(delivery.assignment.task);
    if (granted == granted_.end()) return nullptr;
    const auto& was = granted->second;
    const bool same = was.assignment.vehicle == delivery.assignment.vehicle &&
                      was.assignment.time == delivery.assignment.time &&
                      was.bearing_rad == delivery.bearing_rad;
    if (!same || was.given_up || (round && *round != was.round)) return nullptr;
    round = was.round;
  }
  for (const auto& pending : pending_) {
    if (round && pending.request.round == *round && pending.decision) return &*pending.decision;
  }
  return nullptr;
}

/// Is that said by who was granted the delivery, of that plan? It may go on under a successor,
/// whose request was not heard here: what the vehicle says of the delivery after the grant is of
/// the same plan, or of one that has replaced it; what is older may be of a plan before it.
bool GroundAgent::is_of_grant(const MissionEvent& event, const Granted& granted) {
  return granted.assignment.vehicle == event.vehicle &&
         (granted.round == event.round || event.time > granted.granted_at + kClocksDiffer);
}

void GroundAgent::on_event(const MissionEvent& event) {
  const auto* ended = std::get_if<event::LeaseEnded>(&event.body);
  const bool lost =
      ended != nullptr && ended->why.reason != coalition::Reason::task_done && !ended->held;
  const EventKind kind = event.kind();
  const bool gives_up =
      lost || kind == EventKind::task_failed || kind == EventKind::authorisation_late;
  const auto granted = granted_.find(event.task);
  if (granted != granted_.end() && is_of_grant(event, granted->second)) {
    // What was begun may be flown to its end, whatever is said afterwards.
    granted->second.begun = granted->second.begun || kind == EventKind::task_started;
    granted->second.given_up = granted->second.given_up || (gives_up && !granted->second.begun);
  }
  if (kind == EventKind::task_done) {
    note_done({event.task, coalition::TaskState::done, event.time});
  }
  if (!seen_events_.emplace(event.time, event.vehicle, event.task, event.body).second) {
    return;
  }
  if (seen_events_.size() > kSeenEventsMax) seen_events_.erase(seen_events_.begin());
  events_.push(event);
}

Result<std::string> GroundAgent::authorise(SiteId site, const std::string& operator_name,
                                           Instant now, bool although_silent) {
  return decide_newest(site, {true, although_silent}, operator_name, now);
}
Result<void> GroundAgent::refuse(SiteId site, const std::string& operator_name, Instant now) {
  const auto refused = decide_newest(site, {false, false}, operator_name, now);
  if (!refused) return refused.error();
  return {};
}

Result<std::string> GroundAgent::decide_on(const coalition::Round& round, SiteId site, Verdict what,
                                           const std::string& operator_name, Instant now) {
  const auto plan = std::find_if(pending_.begin(), pending_.end(), [&](const auto& p) {
    return p.request.site == site && p.request.round == round;
  });
  if (plan == pending_.end()) {
    return Error{"that plan for " + name_of(site) +
                 " does not wait for a decision any more; look at what does"};
  }
  if (plan->decision || now >= plan->request.decide_by) {
    return Error{"that plan for " + name_of(site) +
                 (plan->decision ? " was already decided by " + plan->decision->decided_by
                                 : " has run out; the vehicles hold and will ask again")};
  }
  return decide(*plan, what, operator_name, now);
}

Result<std::string> GroundAgent::decide_newest(SiteId site, Verdict what, const std::string& by,
                                               Instant now) {
  const auto waiting = std::find_if(pending_.rbegin(), pending_.rend(), [&](const auto& p) {
    return p.request.site == site && !p.decision && now < p.request.decide_by;
  });
  if (waiting != pending_.rend()) return decide(*waiting, what, by, now);
  const auto last = std::find_if(pending_.rbegin(), pending_.rend(),
                                 [&](const auto& p) { return p.request.site == site; });
  if (last == pending_.rend()) return Error{"no request for " + name_of(site) + " is waiting"};
  if (last->decision) {
    return Error{"the request for " + name_of(site) + " was already " +
                 (last->decision->granted ? "authorised" : "refused") + " by " +
                 last->decision->decided_by};
  }
  return Error{"the request for " + name_of(site) +
               " has run out; the vehicles hold and will ask again with new times"};
}

Result<std::string> GroundAgent::decide(PendingAuthorisation& pending, Verdict what,
                                        const std::string& by, Instant now) {
  const auto& request = pending.request;
  Authorisation decision{request.round, request.site, what.grant, by, now, {}, {}, {}};
  std::string although;
  if (what.grant) {
    if (auto why = why_not_grant(request, now)) return Error{*why};
    although = silent_text(request, now);
    if (!although.empty() && !what.although_silent) {
      return Error{although +
                   "; it may not hear the decision, and nobody hears what it does. "
                   "Refuse it, wait for another plan, or order 'authorise " +
                   std::to_string(request.site.value) + " override'"};
    }
    decision.deliveries = request.deliveries;
    for (const auto& delivery : request.deliveries) {
      decision.until = std::max(decision.until, delivery.assignment.time);
    }
    if (config_.approve) {
      if (auto approved = config_.approve(decision); !approved) return approved.error();
    }
  }
  say(pending, decision, now, although);
  return although;
}

std::vector<VehicleId> silent_in(const AuthorisationRequest& request, const Fleet& fleet) {
  std::vector<VehicleId> named{request.round.coalition.leader};
  for (const auto& delivery : request.deliveries) named.push_back(delivery.assignment.vehicle);
  std::ranges::sort(named);
  named.erase(std::unique(named.begin(), named.end()), named.end());
  std::erase_if(named, [&fleet](VehicleId vehicle) {
    const auto known = fleet.vehicles().find(vehicle);
    return known != fleet.vehicles().end() && known->second.telemetry && !known->second.silent;
  });
  return named;
}

/// "vehicle 3 is silent for 7 s, vehicle 5 was never heard"; empty: all are heard.
std::string GroundAgent::silent_text(const AuthorisationRequest& request, Instant now) const {
  std::string text;
  for (const VehicleId vehicle : silent_in(request, fleet_)) {
    const auto known = fleet_.vehicles().find(vehicle);
    const bool heard = known != fleet_.vehicles().end() && known->second.telemetry;
    if (!text.empty()) text += ", ";
    text += name_of(vehicle);
    if (!heard) {
      text += " was never heard";
      continue;
    }
    const auto silent_for =
        std::chrono::duration_cast<std::chrono::seconds>(now - known->second.heard_at);
    text += " is silent for " + std::to_string(silent_for.count()) + " s";
  }
  return text;
}

/// Past its gate, or perhaps: what it says of it may be on its way.
bool GroundAgent::may_be_taken_back(const PendingAuthorisation& pending, Instant now) const {
  if (!pending.decision || !pending.decision->granted) return false;
  return std::ranges::any_of(pending.request.deliveries, [&](const Delivery& delivery) {
    const auto granted = granted_.find(delivery.assignment.task);
    const bool begun = granted != granted_.end() && granted->second.begun;
    return !begun && !done_.contains(delivery.assignment.task) && now < delivery.assignment.time;
  });
}

bool GroundAgent::has_granted_since(const Authorisation& refusal) const {
  return std::ranges::any_of(pending_, [&](const PendingAuthorisation& pending) {
    return pending.request.site == refusal.site && pending.decision && pending.decision->granted &&
           pending.decision->decided_at > refusal.decided_at;
  });
}

Result<TakenBack> GroundAgent::take_back(SiteId site, const std::string& by, Instant now) {
  std::vector<PendingAuthorisation*> granted;
  bool asked = false;
  for (auto& pending : pending_) {
    if (pending.request.site != site) continue;
    if (may_be_taken_back(pending, now)) granted.push_back(&pending);
    asked = asked || (!pending.decision && now < pending.request.decide_by);
  }
  if (granted.empty()) {
    return Error{
        "nothing that is granted at " + name_of(site) + " waits for its gate" +
        (asked ? "; refuse what waits for a decision" : "; what has begun is flown to its end")};
  }
  TakenBack taken;
  for (const auto& [task, one] : granted_) {
    if (task.site != site || done_.contains(task)) continue;
    if (one.begun) taken.flown_on.push_back(one.assignment);
  }
  for (PendingAuthorisation* pending : granted) {
    for (const VehicleId vehicle : silent_in(pending->request, fleet_)) {
      if (!contains(taken.silent, vehicle)) taken.silent.push_back(vehicle);
    }
  }
  for (PendingAuthorisation* pending : granted) {
    // Later than the grant, also where the clock was set back since.
    const Instant at = std::max(now, pending->decision->decided_at + Duration{1});
    const Authorisation back{pending->request.round, site, false, by, at, {}, {}, {}};
    take(*pending, back);
    report(event::AuthorisationWithdrawn{by}, back.round, {site, TaskKind::deliver, 0}, now);
    messages_.push(Message{back});
    next_repeat_ = std::min(next_repeat_, now + kAuthorisationRepeat);
  }
  return taken;
}

std::optional<std::string> GroundAgent::why_not_grant(const AuthorisationRequest& request,
                                                      Instant now) {
  if (const Granted* const other = granted_to_another(request)) {
    // What was never asked for here cannot be taken back here.
    const bool was_asked = std::ranges::any_of(pending_, [&](const PendingAuthorisation& pending) {
      return pending.request.site == request.site && pending.request.round == other->round;
    });
    return to_string(other->assignment.task) + " is granted to " +
           name_of(other->assignment.vehicle) + " in another coalition already; " +
           (was_asked ? "refuse " + name_of(request.site) + " to take that back"
                      : "withdraw " + name_of(request.site)) +
           ", or wait until its time has passed";
  }
  if (tell_what_is_over(request, now)) {
    return "a delivery of this plan is over by now; its leader will ask again";
  }
  for (const auto& delivery : request.deliveries) {
    if (auto why = fleet_.why_not_with(delivery.assignment.vehicle)) return why;
  }
  return fleet_.why_not_with(request.round.coalition.leader);
}

/// `although`: what the operator has passed over.
void GroundAgent::say(PendingAuthorisation& pending, const Authorisation& decision, Instant now,
                      const std::string& although) {
  const auto& request = pending.request;
  take(pending, decision);
  std::string by = decision.decided_by;
  if (!although.empty()) by += ", although " + although;
  report(decision.granted ? EventBody{event::Authorised{by}}
                          : EventBody{event::AuthorisationRefused{by}},
         request.round, {request.site, TaskKind::deliver, 0}, now);
  messages_.push(Message{decision});
  next_repeat_ = std::min(next_repeat_, now + kAuthorisationRepeat);
}

void GroundAgent::take(PendingAuthorisation& pending, const Authorisation& decision) {
  const auto& request = pending.request;
  if (!decision.granted) {
    led_[request.site].announcement.reset();
    std::erase_if(granted_, [&](const auto& g) { return g.first.site == request.site; });
  }
  for (const Delivery& delivery : request.deliveries) {
    if (!decision.granted) break;
    granted_.insert_or_assign(
        delivery.assignment.task,
        Granted{request.round, delivery.assignment, delivery.bearing_rad, decision.decided_at});
  }
  pending.decision = decision;
}

/// By another ground station, perhaps of what was never asked for here: it may be flown. It is said
/// again and again, also in the rounds of successors, all of one time: what is known of it stays.
void GroundAgent::note_grant(const Authorisation& grant) {
  if (!grant.granted) return;
  for (const Delivery& delivery : grant.deliveries) {
    const auto known = granted_.find(delivery.assignment.task);
    const bool is_news = known == granted_.end() ? granted_.size() < kTasksRememberedMax
                                                 : grant.decided_at > known->second.granted_at;
    if (!is_news) continue;
    granted_.insert_or_assign(
        delivery.assignment.task,
        Granted{grant.round, delivery.assignment, delivery.bearing_rad, grant.decided_at});
  }
}

const ScriptedDecision* GroundAgent::script_for(SiteId site) const {
  const auto taken = scripted_.find(site);
  std::size_t skip = taken == scripted_.end() ? 0 : taken->second;
  const ScriptedDecision* last = nullptr;
  for (const auto& decision : config_.decisions) {
    if (decision.site != site) continue;
    last = &decision;
    if (skip-- == 0) break;
  }
  return last;
}

std::optional<Instant> GroundAgent::script_due(const PendingAuthorisation& pending) const {
  const auto* scripted = script_for(pending.request.site);
  if (scripted == nullptr || pending.decision) return std::nullopt;
  return std::max({pending.asked_at + scripted->reaction, scripted->not_before, script_again_});
}

void GroundAgent::decide_by_script(Instant now) {
  for (auto& pending : pending_) {
    const auto due = script_due(pending);
    if (!due || now < *due || now >= pending.request.decide_by) continue;
    const SiteId site = pending.request.site;
    // Who wrote the script has passed over whatever there may be.
    if (decide(pending, {script_for(site)->grant, true}, "scenario", now).ok()) {
      ++scripted_[site];
    } else {
      script_again_ = now + kAuthorisationRepeat;
    }
  }
}

bool GroundAgent::has_granted(SiteId site) const {
  return std::ranges::any_of(granted_, [site](const auto& one) { return one.first.site == site; });
}

Result<void> GroundAgent::command(VehicleId vehicle, CommandKind kind, Instant now) {
  const bool all = vehicle == kGroundStation;
  if (kind == CommandKind::give_back && (all || now < Instant{})) {
    // A vehicle that its pilot takes at this moment must be able to tell what is older.
    return Error{all ? "an aircraft is given back one at a time"
                     : "an aircraft cannot be given back before mission time 0"};
  }
  if (!all && !fleet_.expects(vehicle)) return Error{name_of(vehicle) + " is not in the fleet"};
  for (const auto& [id, entry] : fleet_.vehicles()) {
    const bool concerned = all ? kind != CommandKind::hold : id == vehicle;
    const bool takes_part =
        id == vehicle && (kind == CommandKind::resume || kind == CommandKind::give_back);
    const bool gone = id == vehicle && entry.revoked;
    if (gone || (concerned && entry.duplicate) || (takes_part && entry.differs)) {
      return Error{*fleet_.why_not_with(id)};
    }
  }
  // Numbers grow also over a restart of this process, or vehicles would take new commands for old.
  const auto since_epoch = std::chrono::duration_cast<std::chrono::milliseconds>(
                               std::max(now, Instant{}).time_since_epoch())
                               .count();
  last_command_ = std::max(last_command_, static_cast<std::uint64_t>(since_epoch)) + 1;
  const auto is_act = [](CommandKind of) { return of == CommandKind::give_back; };
  std::erase_if(commands_, [&](const SentCommand& sent) {  // an act takes no order's place
    const bool same = is_act(sent.command.kind) == is_act(kind);
    return same && (all || sent.command.vehicle == vehicle);
  });
  Command command{.vehicle = vehicle, .kind = kind};
  set_number(command, last_command_);
  messages_.push(Message{command});
  commands_.push_back({command, now + kCommandRepeat, now + kCommandRepeatedFor});
  return {};
}

void GroundAgent::end_site(SiteId site, const std::string& by, Instant now) {
  withdrawn_.emplace(site, by);
  if (const auto led = led_.find(site); led != led_.end()) led->second.announcement.reset();
  for (auto& pending : pending_) {
    const bool waits = pending.request.site == site && !pending.decision;
    if (waits) (void)decide(pending, {false, false}, by, now);
  }
  // What was granted is not said any more: who has not heard it holds.
  std::erase_if(pending_, [site](const PendingAuthorisation& pending) {
    return pending.request.site == site && pending.decision && pending.decision->granted;
  });
}

void GroundAgent::send_again(Instant now) {
  if (now >= next_repeat_) {
    next_repeat_ = Instant::max();
    for (const auto& pending : pending_) {
      if (!pending.decision || now > last_delivery(pending.request)) continue;
      messages_.push(Message{*pending.decision});
      next_repeat_ = now + kAuthorisationRepeat;
    }
  }
  for (auto& [site, led] : led_) {
    if (!led.last.closed && led.announcement && now >= led.heard_at + kLeaderLost) {
      led.heard_at = now;
      messages_.push(Message{coalition::Message{*led.announcement}});
    }
    const bool due = led.last.closed && led.times_closed < kClosedTimes &&
                     now >= led.passed_on_at + kClosedPassedOn;
    if (!due) continue;
    ++led.times_closed;
    led.passed_on_at = now;
    messages_.push(Message{coalition::Message{led.last}});
  }
  for (auto& sent : commands_) {
    if (now < sent.next) continue;
    messages_.push(Message{sent.command});
    sent.next = now + kCommandRepeat;
  }
  std::erase_if(commands_, [&](const SentCommand& sent) { return sent.next > sent.repeat_until; });
}

std::optional<Message> GroundAgent::poll_message() { return messages_.pop(); }
std::optional<MissionEvent> GroundAgent::poll_event() { return events_.pop(); }

Instant GroundAgent::next_timeout() const {
  if (watching_) return fleet_.next_timeout();
  Instant next = std::min(next_repeat_, fleet_.next_timeout());
  for (const auto& sent : commands_) next = std::min(next, sent.next);
  for (const auto& [site, led] : led_) {
    if (led.last.closed && led.times_closed < kClosedTimes) {
      next = std::min(next, led.passed_on_at + kClosedPassedOn);
    }
  }
  for (const auto& pending : pending_) {
    const auto due = script_due(pending);
    if (due && *due < pending.request.decide_by) next = std::min(next, *due);
  }
  return next;
}

void GroundAgent::report(EventBody body, const coalition::Round& round, const TaskId& task,
                         Instant now) {
  events_.push({kGroundStation, now, round, task, std::move(body)});
}

}  // namespace skein::mission
