// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/ground_node.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "names.hpp"
#include "skein/mission/may_say.hpp"
#include "skein/mission/told_by.hpp"

namespace skein::mission {

namespace {

/// It may have given orders before that it does not recall: vehicles that know them tell each other
/// first.
constexpr Duration kOthersAnswer = std::chrono::seconds{10};

}  // namespace

GroundNode::GroundNode(const GroundNodeConfig& config, Instant now)
    : agent_{config.agent, now},
      formation_{config.formation, now},
      tracks_{config.tracks, now},
      setup_{config.setup, kGroundStation, config.instance, now},
      start_{config.instance},
      knows_orders_at_{starts_anew(now) ? now + kOthersAnswer : now},
      hazards_{config.hazards},
      fence_{config.fence},
      routes_{config.fence},
      searches_{config.searches},
      detections_{config.detections},
      returns_{config.returns} {}

void GroundNode::recall(const Message& message, VehicleId sender, Instant at) {
  if (!may_say(message, sender) || told_by(message) != kGroundStation) return;
  agent_.recall(message, sender, at);
  take_in(message, sender, at);
  knows_orders_at_ = at;
}

/// What was said then, but for the agent.
void GroundNode::take_in(const Message& message, VehicleId sender, Instant at) {
  sites_.recall(message, sender, at);
  hazards_.recall(message, sender, at);
  fence_.recall(message, sender, at);
  if (fence_.ordered()) use_fence();
  routes_.recall(message, sender, at);
  detections_.recall(message, sender);
  formation_.recall(message, sender);
  const auto* command = std::get_if<Command>(&message);
  if (command != nullptr && sender == kGroundStation) orders_.note(*command);
  const auto* decision = std::get_if<Authorisation>(&message);
  if (decision != nullptr && !decision->granted) note_refusal(*decision, at);
}

/// It stands for the rest of the mission, whoever may lead there by then.
void GroundNode::note_refusal(const Authorisation& decision, Instant now) {
  sites_.on_refused(decision.site, now);
  agent_.end_site(decision.site, decision.decided_by, now);
}

void GroundNode::watch(Instant now) {
  watching_ = true;
  agent_.set_watching(true, now);
  // What it had ordered goes on as long as who has the command now lets it.
  landings_.forget();
  returns_.forget();
  drop_words();
  on_timeout(now);
}

void GroundNode::take_command(InstanceId start, Instant now) {
  if (watching_) knows_orders_at_ = now + kOthersAnswer;
  reign_from_ = agent_.newest_order() + 1;
  told_.clear();
  watching_ = false;
  agent_.set_watching(false, now);
  start_ = start;
  speak();
}

/// What its parts would say is for who has the command to say; of their events, too.
void GroundNode::drop_words() {
  while (next_message()) continue;
  while (events_.pop()) continue;
}

bool GroundNode::on_message(const Message& message, VehicleId sender, Instant now) {
  if (!may_say(message, sender)) {
    ++refused_;
    return false;
  }
  if (told_by(message) != kGroundStation) return false;  // to who has started anew, not to us
  const auto* decision = std::get_if<Authorisation>(&message);
  // What another one has refused or taken back stands, too, whoever has the command by then.
  const bool refuses =
      decision != nullptr && !decision->granted && !agent_.has_granted_since(*decision);
  if (sender == kGroundStation && (watching_ || refuses)) {
    agent_.overhear(message, now);
    take_in(message, sender, now);
    return true;
  }
  if (const auto* setup = std::get_if<Setup>(&message)) on_setup(*setup, now);
  const auto* telemetry = std::get_if<Telemetry>(&message);
  if (telemetry != nullptr) {
    setup_.on_time(sender, telemetry->state.time, now);
    take_differences(sender, now);
  }
  agent_.on_message(message, now);
  if (telemetry != nullptr && fleet().is_late(*telemetry)) return true;  // heard, and no news
  sites_.on_message(message, now);
  hazards_.on_message(message);
  routes_.on_message(message, now);
  searches_.on_message(message, now);
  // Who runs with another origin has seen it somewhere else.
  const bool saw =
      std::holds_alternative<Detection>(message) && setup_.difference(sender) == nullptr;
  if (auto site = saw && !watching_ ? detections_.on_message(message, sites_, now) : std::nullopt) {
    (void)sites_.add(*std::move(site), std::nullopt, fleet(), now);  // full: it is seen again
  }
  formation_.on_message(message, now);
  tracks_.on_message(message, now);
  returns_.on_message(message);
  return true;
}

/// News are of anybody; who differs is known of whoever speaks.
void GroundNode::take_differences(VehicleId vehicle, Instant now) {
  for (auto news = setup_.poll_news(); news; news = setup_.poll_news()) {
    MissionEvent event{kGroundStation, now, {}, {}, *std::move(news)};
    messages_.push(event);
    events_.push(std::move(event));
  }
  const SetupDifference* const difference = setup_.difference(vehicle);
  agent_.fleet().set_difference(vehicle, difference);
  // An id that is used twice is no matter of setups, and its end would not be heard of here.
  const auto why_not = difference == nullptr ? std::nullopt : fleet().why_not_with(vehicle);
  formation_.barred().set(vehicle, why_not);
  tracks_.barred().set(vehicle, why_not);
}

void GroundNode::on_setup(const Setup& setup, Instant now) {
  setup_.on_setup(setup, now);
  take_differences(setup.node, now);
  agent_.note_order(setup.newest_order, now);
  const Command standing = orders_.standing(setup.node, kGroundStation);
  if (orders_heard_.contains(setup.node) || orders_heard_.size() < OrderBook::kVehiclesMax) {
    orders_heard_[setup.node] = setup.newest_order;
  }
  const bool asks = !setup.knows_orders && now >= knows_orders_at_ && knows_orders();
  if (asks || number_of(standing) > setup.newest_order) messages_.push(Message{standing});
  if (!watching_) order_again(setup, standing, now);
}

/// No vehicle that is heard obeys an order that this one has not heard of, where another had the
/// command: what stands for whom, vehicles know then.
bool GroundNode::knows_orders() const {
  return std::ranges::none_of(orders_heard_, [this](const auto& heard) {
    const auto known = fleet().vehicles().find(heard.first);
    const bool is_heard = known != fleet().vehicles().end() && !known->second.silent;
    return is_heard && heard.second > number_of(orders_.standing(heard.first, kGroundStation));
  });
}

/// Who had the command before has gone on to order a vehicle that could not hear this one: what was
/// ordered here since stands.
void GroundNode::order_again(const Setup& setup, const Command& standing, Instant now) {
  if (!reign_from_ || number_of(standing) < *reign_from_) return;
  std::uint64_t told = 0;
  for (const VehicleId to : {kGroundStation, setup.node}) {
    const auto known = told_.find(to);
    if (known != told_.end()) told = std::max(told, known->second);
  }
  if (setup.newest_order > told) (void)command(setup.node, standing.kind, now);
}

void GroundNode::on_timeout(Instant now) {
  if (watching_) {
    agent_.on_timeout(now);
    return drop_words();
  }
  if (auto ours = setup_.poll_setup({}, now)) {
    ours->instance = start_;
    messages_.push(Message{*std::move(ours)});
  }
  agent_.on_timeout(now);
  sites_.on_timeout(fleet(), now);
  hazards_.on_timeout(now);
  fence_.on_timeout(now);
  routes_.on_timeout(fleet(), now);
  searches_.on_timeout(hazards_.known(), fleet(), routes_, now);
  hazards_.retire(fleet(), now);
  detections_.on_timeout(now);
  formation_.on_timeout(now);
  tracks_.on_timeout(now);
  returns_.on_timeout(fleet(), hazards_.known(), now);
  traffic_.on_timeout(fleet(), now);
  const auto lands = landings_.next(fleet(), now);
  if (lands) (void)agent_.command(*lands, CommandKind::land, now);  // else it is not in the fleet
}

/// Of all: nobody does anything else.
bool GroundNode::stays_in_formation(VehicleId vehicle) const {
  const auto& members = formation_.members();
  if (vehicle != kGroundStation) return members.contains(vehicle);
  return !members.empty() && std::ranges::all_of(fleet().vehicles(), [&members](const auto& known) {
    return members.contains(known.first);
  });
}

std::optional<std::string> GroundNode::why_not_land(VehicleId vehicle) const {
  if (!fleet().expects(vehicle)) return name_of(vehicle) + " is not in the fleet";
  if (formation_.members().contains(vehicle) || tracks_.members().contains(vehicle)) {
    return name_of(vehicle) + " flies in a formation, which lands as one or is landed by pilots";
  }
  if (auto why = fleet().why_not_with(vehicle)) return why;
  return GroundLanding::why_not(vehicle, orders_.standing(vehicle, kGroundStation).kind, fleet());
}

/// Of all those that may.
Result<void> GroundNode::land(VehicleId vehicle, Instant now) {
  const bool all = vehicle == kGroundStation;
  bool any = false;
  for (const VehicleId one : concerned(vehicle)) {
    const auto why = why_not_land(one);
    if (why && !all) return Error{*why};
    if (!why) landings_.add(one, now);
    any = any || !why;
  }
  if (!any) return Error{"nobody is at home or on the way there: order 'return all' first"};
  return {};
}

std::optional<std::string> GroundNode::why_not_told(VehicleId vehicle, CommandKind kind) const {
  return kind == CommandKind::land ? why_not_land(vehicle) : std::nullopt;
}

std::optional<std::string> GroundNode::why_not_return(VehicleId vehicle) const {
  if (!stays_in_formation(vehicle)) return std::nullopt;
  return (vehicle == kGroundStation ? "the fleet" : name_of(vehicle)) +
         std::string{
             " flies in a formation of copters, which know no way home of their own; order "
             "the formation to rally, or to land"};
}

Result<ReturnPreview> GroundNode::preview_return(std::vector<VehicleId> vehicles,
                                                 Instant now) const {
  if (vehicles.empty()) {
    if (auto why = why_not_return(kGroundStation)) return Error{*std::move(why)};
    vehicles = concerned(kGroundStation);
  }
  for (const VehicleId vehicle : vehicles) {
    if (auto why = why_not_return(vehicle)) return Error{*std::move(why)};
  }
  return returns_.preview(vehicles, fleet(), hazards_.known(), now);
}

Result<void> GroundNode::command(VehicleId vehicle, CommandKind kind, Instant now) {
  if (kind == CommandKind::land) return land(vehicle, now);
  if (kind == CommandKind::return_home) {
    if (auto why = why_not_return(vehicle)) return Error{*std::move(why)};
  }
  auto given = agent_.command(vehicle, kind, now);
  if (!given || kind == CommandKind::give_back) return given;
  returns_.on_order(concerned(vehicle), kind, fleet(), now);
  for (const VehicleId one : concerned(vehicle)) landings_.drop(one);
  return given;
}

/// Whom an order moves that ways home are planned for: who flies in a formation has none.
std::vector<VehicleId> GroundNode::concerned(VehicleId vehicle) const {
  if (vehicle != kGroundStation) return {vehicle};
  std::vector<VehicleId> all;
  for (const auto& [id, entry] : fleet().vehicles()) {
    if (!formation_.members().contains(id)) all.push_back(id);
  }
  return all;
}

Result<std::vector<TaskId>> GroundNode::withdraw_site(SiteId site, const std::string& by,
                                                      Instant now) {
  auto flown_on = sites_.withdraw(site, by, now);
  if (flown_on) agent_.end_site(site, by, now);
  return flown_on;
}

Result<SiteId> GroundNode::change_site(SiteId old, Site site, std::optional<VehicleId> surveyor,
                                       const std::string& by, Instant now) {
  if (agent_.has_granted(old)) sites_.on_granted(old);  // in this very moment, perhaps
  auto changed = sites_.change(old, std::move(site), surveyor, fleet(), by, now);
  if (changed) agent_.end_site(old, by, now);
  return changed;
}

Result<std::uint32_t> GroundNode::order_fence(const Fence& fence, Instant now) {
  auto number = fence_.order(fence, fleet(), now);
  if (number) use_fence();
  return number;
}

void GroundNode::use_fence() {
  routes_.set_fence(fence_.fence());
  formation_.set_fence(fence_.fence());
  tracks_.set_fence(fence_.fence());
}

Result<SiteId> GroundNode::answer_proposal(std::uint32_t number, bool accepted,
                                           const std::string& by, Instant now) {
  auto site = detections_.proposed(number);
  if (!site) return site.error();
  SiteId added;
  if (accepted) {
    const auto given = add_site(*std::move(site), std::nullopt, now);
    if (!given) return given;
    added = *given;
  }
  (void)detections_.answer(number, accepted, by, now);
  return added;
}

void GroundNode::say(MissionEvent event) {
  take_events();  // which were before this one
  messages_.push(event);
  events_.push(std::move(event));
}

void GroundNode::take_events() {
  const auto take = [this](auto& from) {
    while (auto event = from.poll_event()) {
      messages_.push(*event);
      events_.push(std::move(*event));
    }
  };
  take(formation_);
  take(tracks_);
  take(sites_);
  take(routes_);
  take(detections_);
  take(returns_);
  take(landings_);
}

std::optional<Message> GroundNode::poll_message() {
  if (!watching_) return next_message();
  drop_words();
  return std::nullopt;
}

std::optional<Message> GroundNode::next_message() {
  take_events();
  if (auto message = hazards_.poll_message()) {
    // What the operator tells of is to be planned around, too.
    if (const auto* hazard = std::get_if<HazardReport>(&*message)) tracks_.know(*hazard);
    return message;
  }
  if (auto message = sites_.poll_message()) return message;
  if (auto message = fence_.poll_message()) return message;
  if (auto message = routes_.poll_message()) return message;
  while (auto message = agent_.poll_message()) {
    const auto* decision = std::get_if<Authorisation>(&*message);
    const bool grants = decision != nullptr && decision->granted;
    if (grants && sites_.is_withdrawn(decision->site)) continue;  // since it was decided
    if (decision != nullptr && decision->granted) sites_.on_granted(decision->site);
    if (decision != nullptr && !decision->granted) note_refusal(*decision, decision->decided_at);
    if (const auto* command = std::get_if<Command>(&*message)) {
      orders_.note(*command);
      std::uint64_t& newest = told_[command->vehicle];
      newest = std::max(newest, number_of(*command));
    }
    return message;
  }
  if (auto message = formation_.poll_message()) return message;
  if (auto message = tracks_.poll_message()) return message;
  if (auto message = returns_.poll_message()) return message;
  if (auto message = traffic_.poll_message()) return message;
  return messages_.pop();
}

std::optional<MissionEvent> GroundNode::poll_event() {
  if (watching_) drop_words();
  take_events();
  if (auto event = events_.pop()) return event;
  return agent_.poll_event();
}

Instant GroundNode::next_timeout() const {
  if (watching_) return agent_.next_timeout();
  return std::min({agent_.next_timeout(), sites_.next_timeout(), hazards_.next_timeout(),
                   fence_.next_timeout(), routes_.next_timeout(), formation_.next_timeout(),
                   tracks_.next_timeout(), setup_.next_timeout(), returns_.next_timeout(),
                   landings_.next_timeout(), traffic_.next_timeout()});
}

}  // namespace skein::mission
