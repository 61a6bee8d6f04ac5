// SPDX-License-Identifier: Apache-2.0
#include "command_desk.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace skein::ardupilot {
namespace {

using mavlink::Command;

constexpr std::size_t kWaitingMax = 32;

constexpr std::array<std::pair<Command, const char*>, 8> kCommandNames{{
    {Command::do_set_mode, "DO_SET_MODE"},
    {Command::component_arm_disarm, "COMPONENT_ARM_DISARM"},
    {Command::nav_takeoff, "NAV_TAKEOFF"},
    {Command::do_change_speed, "DO_CHANGE_SPEED"},
    {Command::do_change_altitude, "DO_CHANGE_ALTITUDE"},
    {Command::do_reposition, "DO_REPOSITION"},
    {Command::set_message_interval, "SET_MESSAGE_INTERVAL"},
    {Command::request_message, "REQUEST_MESSAGE"},
}};

constexpr std::array<const char*, 10> kResultNames{
    "accepted",         "temporarily rejected", "denied",    "unsupported",
    "failed",           "in progress",          "cancelled", "COMMAND_LONG only",
    "COMMAND_INT only", "unsupported frame"};

}  // namespace

void CommandDesk::ask(const mavlink::CommandLong& command, const Patience& patience, bool latest) {
  if (latest) {
    const auto waiting = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) {
      return e.sent == 0 && e.command.command == command.command;
    });
    if (waiting != entries_.end()) {
      waiting->command = command;
      return;
    }
  }
  if (entries_.size() < kWaitingMax) entries_.push_back({command, patience, 0, {}});
}

std::optional<mavlink::CommandLong> CommandDesk::next(Instant now) {
  for (auto entry = entries_.begin(); entry != entries_.end(); ++entry) {
    const bool first_of_kind = std::none_of(entries_.begin(), entry, [&](const Entry& e) {
      return e.command.command == entry->command.command;
    });
    const bool due = entry->sent == 0 || now >= entry->answer_by;
    if (!first_of_kind || !due || entry->sent >= entry->patience.attempts) continue;
    entry->command.confirmation = static_cast<std::uint8_t>(entry->sent);
    ++entry->sent;
    entry->answer_by = now + entry->patience.each;
    return entry->command;
  }
  return std::nullopt;
}

std::optional<Outcome> CommandDesk::on_ack(const mavlink::CommandAck& ack) {
  const auto entry = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) {
    return e.sent > 0 && e.command.command == ack.command;
  });
  if (entry == entries_.end()) return std::nullopt;
  const auto result = static_cast<mavlink::CommandResult>(ack.result);
  if (result == mavlink::CommandResult::in_progress) return std::nullopt;
  const Answer answer =
      result == mavlink::CommandResult::accepted ? Answer::accepted : Answer::refused;
  const Outcome outcome{entry->command, answer, ack.result};
  entries_.erase(entry);
  return outcome;
}

std::optional<Outcome> CommandDesk::give_up(Instant now) {
  const auto entry = std::find_if(entries_.begin(), entries_.end(), [now](const Entry& e) {
    return e.sent >= e.patience.attempts && now >= e.answer_by;
  });
  if (entry == entries_.end()) return std::nullopt;
  const Outcome outcome{entry->command, Answer::unanswered, 0};
  entries_.erase(entry);
  return outcome;
}

bool CommandDesk::asks(Command command) const {
  return std::any_of(entries_.begin(), entries_.end(), [command](const Entry& e) {
    return e.command.command == static_cast<std::uint16_t>(command);
  });
}

std::string name_of_command(std::uint16_t command) {
  for (const auto& [value, name] : kCommandNames) {
    if (static_cast<std::uint16_t>(value) == command) return name;
  }
  return "command " + std::to_string(command);
}

std::string name_of_result(std::uint8_t result) {
  return result < kResultNames.size() ? kResultNames[result] : "result " + std::to_string(result);
}

}  // namespace skein::ardupilot
