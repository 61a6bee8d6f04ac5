// SPDX-License-Identifier: Apache-2.0
#include "commanding.hpp"

#include <spdlog/spdlog.h>

#include <utility>
#include <variant>

namespace skein::groundstation {
namespace {

constexpr Duration kTryAgain = std::chrono::seconds{5};

/// What changes nothing of the mission.
bool is_of_this_machine(const Input& input) {
  return std::holds_alternative<TakeCommand>(input) || std::holds_alternative<HandOver>(input) ||
         std::holds_alternative<Record>(input) || std::holds_alternative<Acknowledge>(input) ||
         std::holds_alternative<Quit>(input) || std::holds_alternative<Wait>(input);
}

}  // namespace

Commanding::Commanding(configuration::CommandConfig config, InstanceId start,
                       StationNetwork& network, mission::GroundNode& node, Instant now)
    : desk_{std::move(config), start, now}, network_{network}, node_{node} {
  if (!desk_.is_commanding()) node_.watch(now);
}

std::optional<network::Received> Commanding::next(Instant now) {
  while (auto received = network_.ear().poll()) {
    const auto heard =
        desk_.on_message(received->message, received->sender, received->instance, now);
    if (desk_.newest() && desk_.newest() != noted_) {
      noted_ = desk_.newest();
      network_.note(*noted_);
    }
    switch (heard) {
      case CommandDesk::Heard::superseded:
        network_.fall_silent();
        node_.watch(now);
        break;
      case CommandDesk::Heard::others:
        break;
      case CommandDesk::Heard::own:
      case CommandDesk::Heard::word:
        continue;
    }
    const auto* event = std::get_if<mission::MissionEvent>(&received->message);
    if (event != nullptr && std::holds_alternative<mission::event::CommandHanded>(event->body)) {
      continue;  // said by another of itself
    }
    return received;
  }
  return std::nullopt;
}

std::optional<std::string> Commanding::on_timeout(const Tell& tell, Instant now) {
  if (desk_.takes_by_itself(now) && now >= try_again_) {
    if (const auto taken = take("", "", now); !taken) {
      try_again_ = now + kTryAgain;
      const std::string before = std::exchange(trouble_, taken.error().message);
      if (before != trouble_) {
        spdlog::error("cannot take the command: {}", trouble_);
      }
    }
  }
  if (const auto word = desk_.poll_word(now)) network_.publish(mission::Message{*word});
  if (const auto news = desk_.poll_news(now)) tell(*news);
  if (!desk_.is_one_of_several()) return std::nullopt;
  return desk_.poll_notice(now);
}

std::optional<Answer> Commanding::why_not(const Input& input, Instant now) const {
  if (is_commanding() || is_of_this_machine(input)) return std::nullopt;
  return Answer{false, desk_.why_no_orders(now)};
}

Result<void> Commanding::take(const std::string& by, const std::string& reason, Instant now) {
  const bool is_heeded = desk_.unheeding(now).empty();
  if (desk_.is_commanding() && is_heeded) {  // it had asked others to: no more
    node_.say(desk_.keep(by, reason, now));
    return {};
  }
  // Whom vehicles heed was not heard here.
  const auto start = network_.speak(is_heeded ? desk_.newest() : std::nullopt);
  if (!start) return start.error();
  node_.take_command(*start, now);
  node_.say(desk_.take(*start, by, reason, now));
  return {};
}

Answer Commanding::answer(const TakeCommand& order, const std::string& by, Instant now) {
  if (const auto why = desk_.why_not_take(now)) return {false, *why + "\n"};
  if (const auto taken = take(by, order.reason, now); !taken) {
    return {false, taken.error().message + "\n"};
  }
  return {true, desk_.text(now) + "\n"};
}

Answer Commanding::answer(const HandOver& /*order*/, const std::string& by, Instant now) {
  const auto word = desk_.hand_over(by, now);
  if (!word) return {false, word.error().message + "\n"};
  network_.publish(mission::Message{*word});
  return {true,
          "the others are asked to take the command; this ground station has it until one does\n"};
}

}  // namespace skein::groundstation
