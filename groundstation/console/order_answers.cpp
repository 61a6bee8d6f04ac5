// SPDX-License-Identifier: Apache-2.0
#include "skein/console/order_answers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "news_delay.hpp"
#include "skein/mission/shown_state.hpp"

namespace skein::console {
namespace {

using mission::CommandKind;
using mission::ShownState;

/// Orders to several vehicles are said within it.
constexpr Duration kAtOnce = std::chrono::milliseconds{100};
/// A vehicle's clock from ours.
constexpr Duration kClocksDiffer = std::chrono::seconds{1};
constexpr std::size_t kDecidedMax = 256;
constexpr const char* kTakeBack = "take back";

std::string words_of(std::string_view name) {
  std::string words{name};
  std::ranges::replace(words, '_', ' ');
  return words;
}

bool is_on_ground(ShownState state) {
  return state == ShownState::on_the_ground || state == ShownState::waiting_for_the_start ||
         state == ShownState::landed;
}

/// Does what a vehicle does show that it obeys?
bool shows(CommandKind command, ShownState state, Duration after) {
  using enum ShownState;
  const bool is_home =
      state == returning || state == at_home || state == landing || state == landed;
  switch (command) {
    case CommandKind::hold:
      return state == holding_by_order;
    case CommandKind::return_home:
      return is_home;
    case CommandKind::land:
      return state == landing || state == landed;
    case CommandKind::resume:
      return state != holding_by_order && !is_home && after >= kNewsMayTake;
    case CommandKind::give_back:
    case CommandKind::count:
      break;
  }
  return false;
}

void answer(GivenOrder& order, VehicleId vehicle, Instant now) {
  if (!order.asked || order.waiting.erase(vehicle) == 1) {
    order.answered.try_emplace(vehicle, now - order.given);
  }
}

bool concerns(const GivenOrder& order, VehicleId vehicle) {
  if (order.decision) return true;
  return order.to.empty() || order.to.contains(vehicle);
}

/// By its own event.
bool is_answered_by(const GivenOrder& order, const mission::MissionEvent& event) {
  if (event.vehicle == kGroundStation || !concerns(order, event.vehicle)) return false;
  if (event.time + kClocksDiffer < order.given) return false;  // of an order before it
  if (order.command) {
    const auto* obeyed = std::get_if<mission::event::Commanded>(&event.body);
    return obeyed != nullptr && obeyed->command == *order.command;
  }
  if (event.round != order.decision->round) return false;
  if (order.decision->granted) return event.kind() == mission::EventKind::authorised;
  // What was granted before, or is withdrawn with its site, ends with its coalition.
  return event.kind() == mission::EventKind::authorisation_refused ||
         event.kind() == mission::EventKind::cancelled ||
         event.kind() == mission::EventKind::released;
}

/// By what it does.
bool is_answered_by(const GivenOrder& order, const mission::Telemetry& told, Instant now) {
  if (!concerns(order, told.vehicle) || told.state.time < order.given) return false;
  const ShownState state = mission::shown_state(told.activity, told.detail);
  if (order.command) return shows(*order.command, state, now - order.given);
  const bool is_at_it = told.task.site == order.site && order.decision->granted;
  return is_at_it && state == ShownState::delivering;
}

/// Who is heard and in the air; whoever was named answers in any case.
std::set<VehicleId> asked_by(const GivenOrder& order, const Picture& picture,
                             const mission::Fleet& fleet) {
  std::set<VehicleId> all;
  if (order.decision && order.decision->granted) {
    for (const auto& delivery : order.decision->deliveries) all.insert(delivery.assignment.vehicle);
  } else if (order.decision) {
    // A round that nobody has asked a decision on has no leader to answer.
    const auto known = std::ranges::find_if(picture.authorisations(), [&](const auto& one) {
      return one.request.round == order.decision->round;
    });
    if (known != picture.authorisations().end()) all.insert(order.decision->round.coalition.leader);
  } else if (!order.to.empty()) {
    all = order.to;
  } else {
    for (const auto& [id, entry] : fleet.vehicles()) {
      if (!entry.expected || !entry.telemetry) continue;
      const auto state = mission::shown_state(entry);
      if (!is_on_ground(state)) all.insert(id);
    }
  }
  for (const auto& [id, after] : order.answered) all.erase(id);
  return all;
}

/// It was given up, or another one has taken its place.
bool is_over(const coalition::Round& round, const Picture& picture) {
  for (const auto& [id, coalition] : picture.coalitions()) {
    if (id != round.coalition) continue;
    const bool gone =
        coalition.state == CoalitionState::failed || coalition.state == CoalitionState::closed;
    const bool replaced =
        !coalition.rounds.empty() && coalition.rounds.back().number > round.number;
    return gone || replaced;
  }
  return false;
}

/// Nobody flies what was decided any more, or something else was asked since.
bool is_past(const GivenOrder& order, const Picture& picture, Instant now) {
  if (!order.decision) return false;
  if (order.decision->granted && now > order.decision->until) return true;
  if (order.decision->granted && is_over(order.decision->round, picture)) return true;
  const auto site = picture.sites().find(order.site);
  if (site != picture.sites().end()) {
    const auto& at = site->second;
    if (order.decision->granted ? at.over() : at.withdrawn || at.done) return true;
  }
  if (!order.decision->granted && is_over(order.decision->round, picture)) return true;
  return std::ranges::any_of(picture.authorisations(), [&](const AuthorisationPicture& one) {
    return one.request.site == order.site && one.asked_at > order.given;
  });
}

}  // namespace

std::string line_of(const GivenOrder& order) {
  if (order.kind == kTakeBack) return fmt::format("withdraw decision {}", order.site.value);
  if (order.decision) return fmt::format("{} site {}", order.kind, order.site.value);
  const std::string verb = words_of(order.kind);
  if (order.to.empty()) return verb + " all";
  std::string names;
  for (const VehicleId id : order.to) {
    names += (names.empty() ? "" : ", ") + std::to_string(id.value);
  }
  return verb + " " + names;
}

void OrderAnswers::on_message(const mission::Message& message, VehicleId sender, Instant now) {
  if (const auto* telemetry = std::get_if<mission::Telemetry>(&message)) take(*telemetry, now);
  if (sender != kGroundStation) return;
  if (const auto* command = std::get_if<mission::Command>(&message)) take(*command, now);
  if (const auto* decision = std::get_if<mission::Authorisation>(&message)) take(*decision, now);
}

void OrderAnswers::take(const mission::Command& command, Instant now) {
  // Older ones are said again to whoever has not heard them.
  const std::uint64_t number = mission::number_of(command);
  if (number <= newest_command_ || command.told_by != kGroundStation) return;
  newest_command_ = number;
  for (GivenOrder& before : orders_) {
    if (!before.command) continue;
    if (command.vehicle == kGroundStation) before.waiting.clear();
    before.waiting.erase(command.vehicle);
  }
  if (add_to_last(command, now)) return;
  GivenOrder order;
  order.kind = to_string(command.kind);
  if (command.vehicle != kGroundStation) order.to.insert(command.vehicle);
  order.given = now;
  order.command = command.kind;
  add(std::move(order));
}

/// To several at once is one order, though each of them is told by itself.
bool OrderAnswers::add_to_last(const mission::Command& command, Instant now) {
  if (orders_.empty() || command.vehicle == kGroundStation) return false;
  GivenOrder& last = orders_.back();
  const bool same =
      last.command == command.kind && !last.to.empty() && !last.asked && now < last.given + kAtOnce;
  if (same) last.to.insert(command.vehicle);
  return same;
}

void OrderAnswers::take(const mission::Authorisation& decision, Instant now) {
  if (!decided_.emplace(decision.round, decision.granted).second) return;
  if (decided_.size() > kDecidedMax) decided_.erase(decided_.begin());
  // Of an earlier process of this ground station.
  if (decision.decided_at + kNewsMayTake < now) return;
  GivenOrder order;
  bool was_granted = false;
  for (GivenOrder& before : orders_) {
    if (!before.decision || before.decision->round != decision.round) continue;
    was_granted = was_granted || before.decision->granted;
    before.asked = true;  // nobody is waited for any more
    before.waiting.clear();
  }
  order.kind = decision.granted ? "authorise" : was_granted ? kTakeBack : "refuse";
  order.site = decision.site;
  order.given = now;
  order.decision = decision;
  add(std::move(order));
}

void OrderAnswers::take(const mission::Telemetry& telemetry, Instant now) {
  for (GivenOrder& order : orders_) {
    if (order.waiting.contains(telemetry.vehicle) && is_answered_by(order, telemetry, now)) {
      answer(order, telemetry.vehicle, now);
    }
  }
}

void OrderAnswers::add(GivenOrder order) {
  orders_.push_back(std::move(order));
  if (orders_.size() > kOrdersMax) orders_.pop_front();
}

void OrderAnswers::on_event(const mission::MissionEvent& event, Instant now) {
  // The newest that it can be of: the same order may have been given before.
  const auto order = std::find_if(orders_.rbegin(), orders_.rend(),
                                  [&](const auto& one) { return is_answered_by(one, event); });
  if (order != orders_.rend()) answer(*order, event.vehicle, now);
}

void OrderAnswers::on_timeout(const Picture& picture, const mission::Fleet& fleet, Instant now) {
  for (GivenOrder& order : orders_) {
    if (!std::exchange(order.asked, true)) order.waiting = asked_by(order, picture, fleet);
    if (!order.waiting.empty() && is_past(order, picture, now)) order.waiting.clear();
  }
}

}  // namespace skein::console
