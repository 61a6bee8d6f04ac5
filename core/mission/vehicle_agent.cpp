// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/vehicle_agent.hpp"

#include <algorithm>

#include "skein/base/assert.hpp"
#include "skein/base/overloaded.hpp"
#include "vehicle_agent_impl.hpp"

namespace skein::mission {

void VehicleAgent::Impl::on_state(const VehicleState& state, Instant now) {
  const bool starts = !ownship_.flight().started();
  if (ownship_.measures_range(state)) failsafe_.look_again(now);
  watch_wind(state, now);
  if (!ownship_.on_state(state, now)) {
    outbox.report(event::VehicleTrouble{event::Trouble::route_not_flown}, {}, {}, now);
  }
  if (starts && ownship_.flight().started() && failsafe_.in(Failsafe::Action::stay)) {
    ownship_.hold(now);
  }
  // A route that was given before may lead into what was told since.
  if (starts && ownship_.flight().en_route(now) && !ownship_.way_is_open(now)) {
    respond(*failsafe_.update(now, {.path_barred = true}), now);
  }
  if (order_at_start_ && ownship_.flight().started()) {
    obey(*std::exchange(order_at_start_, {}), now);
  }
  step(now);
}

/// What others count with is not planned anew: the next plan is the wider one.
void VehicleAgent::Impl::watch_wind(const VehicleState& state, Instant now) {
  const bool lacked = ownship_.lacks_turn_room();
  const bool is_news = ownship_.measures_wind(state);
  if (ownship_.lacks_turn_room() && !lacked) {
    outbox.report(event::VehicleTrouble{event::Trouble::turns_not_held}, {}, {}, now);
  }
  const Flight& flight = ownship_.flight();
  if (!is_news || !flight.started()) return;
  failsafe_.look_again(now);
  if (flight.at_will() && !ownship_.landing()) ownship_.plans_for_wind(now);
}

void VehicleAgent::Impl::on_message(const Message& message, Instant now) {
  std::visit(Overloaded{[&](const coalition::Message& m) { receive(m, now); },
                        [&](const Authorisation& m) { on_authorisation(m, now); },
                        [&](const Command& m) { on_command(m, now); },
                        [&](const SiteReport& m) { on_site(m, now); },
                        [&](const HazardReport& m) { on_hazard(m, now); },
                        [&](const Telemetry& m) { on_telemetry(m, now); },
                        [](const AuthorisationRequest&) {},
                        [](const MissionEvent&) {},
                        [](const formation::Change&) {},
                        [](const FormationStatus&) {},
                        [](const PlanReport&) {},
                        [](const Health&) {},
                        [](const TrackFlight&) {},
                        [](const Setup&) {},
                        [](const Detection&) {},
                        [](const RouteStatus&) {},
                        [](const FenceOrder&) {},
                        [&](const Traffic& m) { traffic_.on_traffic(m); },
                        [](const Preflight&) {},
                        [&](const ReturnFlight& m) { on_return_flight(m, now); },
                        [&](const Route& m) { routes_.on_route(m, route_standing(), now); }},
             message);
  step(now);
}

void VehicleAgent::Impl::on_planning_result(const PlanningResult& result, Instant now) {
  if (leader_.on_planning_result(result, now)) step(now);
}

void VehicleAgent::Impl::step(Instant now) {
  routes_.step(route_standing(), now);
  watch_traffic(now);
  if (!ownship_.flight().started()) return;
  leader_.on_timeout(now);
  flyer_.fly_begun(now);
  flyer_.on_timeout(may_lead(), now);
  pump(now);
  leader_.repeat(now);
  pump(now);
  flyer_.fly(now);
  if (!flyer_.free()) {  // on its way to relieve a site it may have bid for another
    scout_.wait();
  } else if (const auto site = scout_.fly(now)) {
    leader_.lead(*site, now);
  }
  pump(now);
  watch_range(now);
  watch_fence(now);
  watch_orbit(now);
  idle(now);
  come_down(now);
  pump(now);
  watch_separation(now);
  check();
}

bool VehicleAgent::Impl::may_lead() const {
  return !leader_.leading() && !scout_.flying() && failsafe_.in(Failsafe::Action::none);
}

/// Each pass hands on what the last one brought forth; what a vehicle leads it also takes part in.
/// Nearly always there is nothing, several times with every message that comes: that must be cheap.
void VehicleAgent::Impl::pump(Instant now) {
  while (leader_.has_output() || flyer_.has_output()) pass_on(now);
  leader_.part();
}

/// The next thing that a part brought forth.
void VehicleAgent::Impl::pass_on(Instant now) {
  if (const auto words = leader_.poll_message()) {
    send(*words, now);
  } else if (leader_.answer_next(now)) {
    return;
  } else if (const auto message = flyer_.poll_message()) {
    send(*message, now);
  } else if (const auto output = flyer_.poll_output()) {
    answer(*output, now);
  }
}

/// What holds between the parts when everything is worked off.
void VehicleAgent::Impl::check() const {
  SKEIN_ASSERT(!(leader_.leading() && scout_.flying()));
  SKEIN_ASSERT(!(flyer_.flying() && scout_.flying()));
  SKEIN_ASSERT(flyer_.free() || !scout_.surveys());
  SKEIN_ASSERT(!flyer_.flying() || !flyer_.free());  // it holds its task, or awaits a successor
}

void VehicleAgent::Impl::send(const coalition::Message& message, Instant now) {
  outbox.messages.push(Message{message});
  receive(message, now);  // its own leader, or its own member
}

void VehicleAgent::Impl::receive(const coalition::Message& message, Instant now) {
  if (!ownship_.flight().started()) return;
  scout_.on_message(message, now);
  const auto* call = std::get_if<coalition::Announcement>(&message);
  if (call == nullptr || !scout_.is_withdrawn(call->site.id)) relay_.on_message(message, now);
  if (auto site = leader_.on_message(message, now)) scout_.put_off(*std::move(site));
  say_last_words(now);  // before its own member bids for the leader that it gives way to
  flyer_.on_message(message, now);
}

void VehicleAgent::Impl::say_last_words(Instant now) {
  while (const auto words = leader_.poll_last_words()) send(*words, now);
}

void VehicleAgent::Impl::answer(const coalition::Participant::Output& output, Instant now) {
  if (const auto* call = std::get_if<coalition::Participant::BidWanted>(&output)) {
    flyer_.answer_call(call->announcement, otherwise_engaged(call->announcement), now);
  } else if (const auto* won = std::get_if<coalition::Participant::LeadershipWon>(&output)) {
    if (!scout_.is_withdrawn(won->plan.site.id)) leader_.take_over(*won, now);
  } else {
    flyer_.answer(output, now);
    if (flyer_.flying()) scout_.call_off();  // it was on its way to relieve another site
  }
}

coalition::Reason VehicleAgent::Impl::otherwise_engaged(const coalition::Announcement& call) const {
  if (!failsafe_.in(Failsafe::Action::none)) return failsafe_.reason();
  if (scout_.is_withdrawn(call.site.id)) return coalition::Reason::site_withdrawn;
  if (scout_.surveys()) return coalition::Reason::surveying;
  if (leader_.leads_other(call.round.coalition)) return coalition::Reason::leading;
  return coalition::Reason::none;
}

void VehicleAgent::Impl::on_authorisation(const Authorisation& message, Instant now) {
  flyer_.on_authorisation(message, now);
  if (!message.granted) {
    scout_.close(message.site);
    relay_.close(message.site);
  }
  leader_.on_authorisation(message, now);
  say_last_words(now);
}

/// Of one that is withdrawn only what has begun is flown to its end.
void VehicleAgent::Impl::on_site(const SiteReport& message, Instant now) {
  if (!message.withdrawn) return scout_.on_site_report(message, now);
  const SiteId site = message.site.id;
  if (!scout_.withdraw(site, flyer_.free(), now)) return;  // what it has bid holds from its way
  relay_.close(site);
  leader_.withdraw(site, now);
  say_last_words(now);
  flyer_.leave_site(site, coalition::Reason::site_withdrawn, now);
}

/// Nothing to do: search on, or take up a site that waits.
void VehicleAgent::Impl::idle(Instant now) {
  if (failsafe_.holds_still() || flyer_.flying()) return;
  if (ownship_.flight().en_route(now) || (scout_.flying() && flyer_.free())) return;
  if (ownship_.flight().poll_orbit_barred() && !ownship_.keeps_clear(now)) ownship_.hold(now);
  if (!flyer_.free()) return;
  if (failsafe_.in(Failsafe::Action::come_home)) {
    if (ownship_.comes_home()) ownship_.come_home(now);
    return;
  }
  if (failsafe_.in(Failsafe::Action::none) && leader_.in_vain() && scout_.has_another_site()) {
    if (auto site = leader_.put_off(coalition::Reason::yields, now)) {
      scout_.put_last(*std::move(site));
    }
    say_last_words(now);
  }
  if (leader_.leading()) return;  // it keeps circling its site
  if (failsafe_.in(Failsafe::Action::none)) {
    if (const auto site = scout_.take_up(now)) leader_.lead(*site, now);
  }
  if (scout_.flying() || leader_.leading()) return;
  if (failsafe_.in(Failsafe::Action::none) && relay_.fly(now)) return;
  const Flight& flight = ownship_.flight();
  if (!flight.searching() || now >= flight.search_goes_on_at()) ownship_.search(now);
}

/// When idle() does something next.
Instant VehicleAgent::Impl::idle_until(Instant now) const {
  constexpr Instant kNever = Instant::max();
  if (failsafe_.holds_still() || flyer_.flying() || scout_.flying()) return kNever;
  const Flight& flight = ownship_.flight();
  if (!flyer_.free() || flight.en_route(now)) return kNever;
  if (failsafe_.in(Failsafe::Action::come_home)) {
    if (!ownship_.comes_home()) return kNever;
    return flight.homing() ? flight.tries_home_at() : now;
  }
  const Instant searches_at = flight.searching() ? flight.search_goes_on_at() : now;
  if (!failsafe_.in(Failsafe::Action::none)) return searches_at;
  const Instant next = std::min(scout_.takes_up_at(), relay_.flies_at());
  return flight.stands_by() ? next : std::min(next, searches_at);
}

RouteStanding VehicleAgent::Impl::route_standing() const {
  const Failsafe::Facts& facts = failsafe_.facts();
  return {.orders_unknown = facts.orders_unknown,
          .setup_differs = facts.setup_differs,
          .obeys_others = facts.ordered || facts.range_spent || facts.left_fence || facts.piloted,
          .has_task = flyer_.flying() || scout_.flying() || leader_.leading()};
}

Instant VehicleAgent::Impl::next_timeout() const {
  return std::min({leader_.next_timeout(), flyer_.next_timeout(), scout_timeout()});
}

Instant VehicleAgent::Impl::scout_timeout() const {
  return flyer_.free() ? scout_.next_timeout() : Instant::max();
}

/// As step() goes through the parts. A leader looks with every step where it will be.
Instant VehicleAgent::Impl::quiet_until(Instant now) const {
  const Flight& flight = ownship_.flight();
  const bool busy = leader_.leading() || leader_.has_output() || flyer_.has_output();
  const bool looks = separation_.watches() || traffic_.watches() || lands_ ||
                     failsafe_.facts().range_spent || ownship_.config().fence.exists();
  if (!flight.started() || busy || routes_.awaits() || looks) return now;
  Instant next = std::min({leader_.next_timeout(), flyer_.quiet_until(may_lead(), now),
                           scout_timeout(), idle_until(now)});
  if (flight.en_route(now)) next = std::min(next, flight.plan().timed.end_time());
  if (!flyer_.in_run()) next = std::min(next, failsafe_.wants_range_at());
  // A battery's percentage counts from when it changes.
  if (ownship_.state().battery_percent != kBatteryNotTold) next = now;
  return next;
}

PartStates VehicleAgent::Impl::part_states() const {
  const Flight& flight = ownship_.flight();
  const Instant at = ownship_.state().time;
  return {.failsafe = failsafe_.action(),
          .piloted = failsafe_.facts().piloted,
          .lands = ownship_.landing(),
          .landed = ownship_.landing() && ownship_.state().on_ground(),
          .has_task = flyer_.flying(),
          .leads = leader_.leading(),
          .monitors = leader_.monitoring(),
          .scouts = scout_.flying(),
          .bids = !flyer_.free(),
          .en_route = flight.en_route(at),
          .stands_by = flight.stands_by().has_value(),
          .on_ground = ownship_.state().on_ground(),
          .takes_off = ownship_.takes_off(),
          .begun = flight.started(),
          .homes = flight.homing(),
          .at_home = flight.at_home(at),
          .range_spent = failsafe_.facts().range_spent,
          .delivers = flyer_.delivers(),
          .awaits_decision = flyer_.flying() ? flyer_.awaits_decision() : leader_.awaits_decision(),
          .late = flyer_.late(),
          .avoids_traffic = traffic_.gives_way()};
}

Activity VehicleAgent::Impl::activity() const { return activity_of(part_states()); }

Telemetry VehicleAgent::Impl::telemetry() const {
  Telemetry telemetry = ownship_.telemetry();
  const PartStates states = part_states();
  telemetry.activity = activity_of(states);
  telemetry.detail = detail_of(states);
  telemetry.task = flyer_.task().value_or(scout_.task().value_or(TaskId{}));
  flyer_.tell_declined(telemetry, ownship_.state().time);
  return telemetry;
}

Counters VehicleAgent::Impl::counters() const {
  Counters all;
  coalition::Tally parts = flyer_.tally();
  parts += leader_.tally();
  all.protocol_errors = parts.protocol_errors;
  all.bad_messages = parts.bad_messages;
  all.messages_dropped = parts.dropped + scout_.dropped() + outbox.messages.dropped() +
                         outbox.planning_requests.dropped();
  all.events_dropped = outbox.events.dropped();
  return all;
}

VehicleAgent::VehicleAgent(const VehicleAgentConfig& config, Instant /*now*/)
    : impl_{std::make_unique<Impl>(config)} {}
VehicleAgent::~VehicleAgent() = default;

void VehicleAgent::on_state(const VehicleState& state, Instant now) { impl_->on_state(state, now); }
void VehicleAgent::on_message(const Message& message, VehicleId /*sender*/, Instant now) {
  impl_->on_message(message, now);
}
void VehicleAgent::on_planning_result(const PlanningResult& result, Instant now) {
  impl_->on_planning_result(result, now);
}
void VehicleAgent::on_timeout(Instant now) { impl_->on_timeout(now); }

std::optional<Message> VehicleAgent::poll_message() { return impl_->outbox.messages.pop(); }
std::optional<Guidance> VehicleAgent::poll_guidance() { return impl_->poll_guidance(); }
std::optional<MissionEvent> VehicleAgent::poll_event() { return impl_->outbox.events.pop(); }
std::optional<PlanningRequest> VehicleAgent::poll_planning_request() {
  return impl_->outbox.planning_requests.pop();
}
void VehicleAgent::on_bar(Bar bar, Instant now) { impl_->on_bar(bar, now); }
std::string VehicleAgent::keep_fence(const Fence& fence, Instant now) {
  return impl_->keep_fence(fence, now);
}
Instant VehicleAgent::next_timeout() const { return impl_->next_timeout(); }
Instant VehicleAgent::quiet_until(Instant now) const { return impl_->quiet_until(now); }
Telemetry VehicleAgent::telemetry() const { return impl_->telemetry(); }
Activity VehicleAgent::activity() const { return impl_->activity(); }
Counters VehicleAgent::counters() const { return impl_->counters(); }
void VehicleAgent::on_piloted(bool piloted, Instant now) { impl_->on_piloted(piloted, now); }
bool VehicleAgent::watches_others() const { return impl_->separation().watches(); }
std::optional<SeparationConflict> VehicleAgent::separation_conflict() const {
  return impl_->separation().conflict();
}
std::optional<TrafficWatch::Conflict> VehicleAgent::traffic_conflict() const {
  return impl_->traffic().conflict();
}
bool VehicleAgent::range_spent() const { return impl_->range_spent(); }

}  // namespace skein::mission
