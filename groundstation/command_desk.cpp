// SPDX-License-Identifier: Apache-2.0
#include "skein/groundstation/command_desk.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "skein/base/text.hpp"
#include "skein/codec/json_text.hpp"
#include "skein/mission/may_say.hpp"

namespace skein::groundstation {
namespace {

/// A newer start is heard before it says who it is.
constexpr Duration kNameWithin = std::chrono::seconds{2};
constexpr std::size_t kWhoMax = 160;  ///< bytes
constexpr std::size_t kVehiclesMax = 4096;

mission::MissionEvent event_of(bool here, std::string who, Instant now) {
  return {kGroundStation, now, {}, {}, mission::event::CommandHanded{here, std::move(who)}};
}

}  // namespace

CommandDesk::CommandDesk(configuration::CommandConfig config, InstanceId start, Instant now)
    : config_{std::move(config)},
      state_{config_.station == 0 ? State::commanding
             : config_.watches    ? State::watching
                                  : State::listening},
      since_{now} {
  if (config_.station == 0) own_ = start;
}

CommandDesk::Heard CommandDesk::on_message(const mission::Message& message, VehicleId sender,
                                           InstanceId instance, Instant now) {
  if (const auto* health = std::get_if<mission::Health>(&message)) on_health(*health, now);
  if (sender != kGroundStation) return Heard::others;
  if (own_ && instance == *own_) return Heard::own;
  // Only what is signed counts: nobody else may silence this one.
  const bool is_old = (newest_ && instance < *newest_) || (own_ && instance < *own_);
  if (is_old || !mission::is_signed(message)) return Heard::others;
  if (newest_ != instance) {
    newest_ = instance;
    who_.clear();
    offered_by_.clear();
    changed_at_ = now;
  }
  heard_at_ = now;
  if (state_ == State::listening) state_ = State::watching;
  const bool superseded = is_commanding();
  if (superseded) {
    state_ = State::watching;
    since_ = now;
    own_.reset();
    word_.reset();
  }
  const auto* event = std::get_if<mission::MissionEvent>(&message);
  const auto* word =
      event == nullptr ? nullptr : std::get_if<mission::event::CommandHanded>(&event->body);
  if (word != nullptr) {
    if (who_ != word->who && word->here) changed_at_ = now;
    who_ = word->who;
    offered_by_ = word->here ? "" : word->who;
  }
  if (superseded) return Heard::superseded;
  return word != nullptr ? Heard::word : Heard::others;
}

/// Nobody decides by it: it only tells the operator.
void CommandDesk::on_health(const mission::Health& health, Instant now) {
  const auto heard = std::ranges::find(health.heard, kGroundStation, &mission::Heard::vehicle);
  const bool is_told = heard != health.heard.end() || health.heard.size() < mission::kHeardMax;
  if (!is_told) return;
  if (heard != health.heard.end() && heard->age <= kHeeds) {
    unheard_by_.erase(health.vehicle);
  } else if (unheard_by_.size() < kVehiclesMax) {
    unheard_by_.try_emplace(health.vehicle, now);
  }
}

std::vector<VehicleId> CommandDesk::unheeding(Instant now) const {
  std::vector<VehicleId> all;
  if (!is_commanding() || now < since_ + kHeeds) return all;
  for (const auto& [vehicle, since] : unheard_by_) {
    if (now >= std::max(since, since_) + kHeeds) all.push_back(vehicle);
  }
  return all;
}

bool CommandDesk::takes_by_itself(Instant now) const {
  return state_ == State::listening && now >= since_ + kListen;
}

bool CommandDesk::nobody_commands(Instant now) const {
  if (is_commanding()) return false;
  return now >= (heard_at_ ? *heard_at_ : since_) + kNobodyAfter;
}

std::optional<std::string> CommandDesk::why_not_take(Instant now) const {
  if (!is_one_of_several()) {
    return is_commanding()
               ? "this ground station has the command: there is no other (command.station)"
               : "another ground station has taken the command, and this one was not configured as "
                 "one of several: give it command.station and start it anew";
  }
  if (is_commanding() && offered_by_.empty() && unheeding(now).empty()) {
    return "this ground station has the command already";
  }
  return std::nullopt;
}

mission::MissionEvent CommandDesk::take(InstanceId start, const std::string& by,
                                        const std::string& reason, Instant now) {
  state_ = State::commanding;
  own_ = start;
  since_ = now;
  changed_at_.reset();
  offered_by_.clear();
  who_ = own_name();
  if (!by.empty()) who_ += " (" + by + ")";
  word_ = event_of(true, as_text(reason.empty() ? who_ : who_ + ": " + reason, kWhoMax), now);
  word_again_ = now + kTellAgain;
  return *word_;
}

mission::MissionEvent CommandDesk::keep(const std::string& by, const std::string& reason,
                                        Instant now) {
  return take(*own_, by, reason, now);
}

Result<mission::MissionEvent> CommandDesk::hand_over(const std::string& by, Instant now) {
  if (!is_commanding()) return Error{"this ground station does not have the command"};
  if (!is_one_of_several()) {
    return Error{"there is no other ground station to hand it to (command.station)"};
  }
  offered_by_ = own_name() + (by.empty() ? "" : " (" + by + ")");
  word_ = event_of(false, as_text(offered_by_, kWhoMax), now);
  word_again_ = now + kTellAgain;
  return *word_;
}

std::optional<mission::MissionEvent> CommandDesk::poll_word(Instant now) {
  if (!word_ || !is_commanding() || now < word_again_) return std::nullopt;
  word_again_ = now + kTellAgain;
  return word_;
}

std::optional<mission::MissionEvent> CommandDesk::poll_news(Instant now) {
  if (!changed_at_ || (who_.empty() && now < *changed_at_ + kNameWithin)) return std::nullopt;
  changed_at_.reset();
  return event_of(false, other(), now);
}

std::optional<std::string> CommandDesk::poll_notice(Instant now) {
  const std::string is =
      fmt::format("{} {} {} {}", static_cast<int>(state_), who_, offered_by_, nobody_commands(now));
  if (is == noticed_) return std::nullopt;
  noticed_ = is;
  return text(now);
}

std::string CommandDesk::own_name() const {
  if (!config_.name.empty()) return config_.name;
  return fmt::format("ground station {}", config_.station);
}

std::string CommandDesk::other() const { return who_.empty() ? "another ground station" : who_; }

std::string CommandDesk::text(Instant now) const {
  if (is_commanding()) {
    if (!is_one_of_several()) return "this ground station has the command; there is no other";
    std::string text = who_ + " has the command: this ground station";
    if (!offered_by_.empty()) text += ", which asks others to take it";
    std::vector<std::uint16_t> ids;
    for (const VehicleId vehicle : unheeding(now)) ids.push_back(vehicle.value);
    if (!ids.empty()) {
      text += fmt::format("; {} {} not heed it: 'take command' speaks beyond whom they heed",
                          fmt::join(ids, ", "), ids.size() == 1 ? "does" : "do");
    }
    return text;
  }
  if (state_ == State::listening) return "this ground station listens whether another commands";
  if (nobody_commands(now)) {
    return heard_at_ ? fmt::format("NOBODY is in command: {} was not heard for {:.0f} s", other(),
                                   to_seconds(now - *heard_at_))
                     : "NOBODY is in command: no ground station was heard";
  }
  if (!heard_at_) return "no ground station in command was heard yet; this one watches";
  return fmt::format("{} {}; this ground station watches", other(),
                     offered_by_.empty() ? "has the command" : "asks others to take the command");
}

std::string CommandDesk::why_no_orders(Instant now) const {
  return text(now) + "; 'take command' takes it\n";
}

std::string CommandDesk::json(Instant now) const {
  static constexpr std::array<const char*, static_cast<std::size_t>(State::count)> kStates{
      "listening", "watching", "commanding"};
  codec::Json unheeding_ids = codec::Json::array();
  for (const VehicleId vehicle : unheeding(now)) unheeding_ids.push_back(vehicle.value);
  const auto number = [](std::optional<Instant> time) {
    return time ? codec::Json(to_seconds(*time)) : codec::Json(nullptr);
  };
  return codec::json_text({{"state", kStates.at(static_cast<std::size_t>(state_))},
                           {"several", is_one_of_several()},
                           {"name", is_one_of_several() ? own_name() : ""},
                           {"who", is_commanding() || heard_at_ ? other() : ""},
                           {"since_s", number(since_)},
                           {"heard_s", number(heard_at_)},
                           {"nobody", nobody_commands(now)},
                           {"offered", !offered_by_.empty()},
                           {"unheeding", std::move(unheeding_ids)},
                           {"text", text(now)}});
}

}  // namespace skein::groundstation
