// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>

#include "custody.hpp"
#include "skein/ardupilot/companion.hpp"

namespace skein::ardupilot {
namespace {

using State = Companion::State;
using Event = Companion::Event;
using Entry = Companion::Entry;

/// The states in which streams are expected, so that silence means something.
constexpr std::array kLinked{State::standing_by, State::arming,  State::climbing,
                             State::taking_over, State::flying,  State::landing,
                             State::piloted,     State::checking};

constexpr std::array kOwn{
    Entry{State::searching, Event::autopilot_found, State::preparing},
    Entry{State::searching, Event::wrong_autopilot, State::refused},
    Entry{State::searching, Event::duplicate, State::duplicated},
    Entry{State::refused, Event::autopilot_found, State::preparing},
    Entry{State::refused, Event::duplicate, State::duplicated},
    Entry{State::refused, Event::rebooted, State::searching},
    Entry{State::preparing, Event::ready, State::standing_by},
    Entry{State::preparing, Event::wrong_autopilot, State::refused},
    Entry{State::preparing, Event::link_lost, State::searching},
    Entry{State::preparing, Event::rebooted, State::searching},
    Entry{State::preparing, Event::duplicate, State::duplicated},
    Entry{State::standing_by, Event::guided, State::flying},
    Entry{State::standing_by, Event::may_take, State::taking_over},
    Entry{State::standing_by, Event::may_launch, State::arming},
    Entry{State::standing_by, Event::given_back, State::taking_over},
    Entry{State::arming, Event::armed, State::climbing},
    Entry{State::arming, Event::not_obeyed, State::standing_by},
    Entry{State::arming, Event::other_mode, State::piloted},
    Entry{State::climbing, Event::climbed, State::taking_over},
    Entry{State::climbing, Event::other_mode, State::piloted},
    Entry{State::climbing, Event::disarmed, State::standing_by},
    Entry{State::climbing, Event::not_obeyed, State::piloted},
    Entry{State::taking_over, Event::guided, State::flying},
    Entry{State::taking_over, Event::not_obeyed, State::piloted},
    Entry{State::taking_over, Event::other_mode, State::piloted},
    Entry{State::taking_over, Event::disarmed, State::standing_by},
    Entry{State::flying, Event::other_mode, State::piloted},
    Entry{State::flying, Event::disarmed, State::standing_by},
    Entry{State::flying, Event::may_land, State::landing},
    Entry{State::landing, Event::disarmed, State::standing_by},
    Entry{State::landing, Event::other_mode, State::piloted},
    Entry{State::landing, Event::not_obeyed, State::piloted},
    Entry{State::piloted, Event::given_back, State::taking_over},
    Entry{State::piloted, Event::given_back_landed, State::standing_by},
    Entry{State::lost, Event::packets_back, State::checking},
    Entry{State::lost, Event::autopilot_silent, State::silent},
    Entry{State::lost, Event::rebooted, State::searching},
    Entry{State::lost, Event::duplicate, State::duplicated},
    Entry{State::silent, Event::packets_back, State::checking},
    Entry{State::silent, Event::link_lost, State::lost},
    Entry{State::silent, Event::rebooted, State::searching},
    Entry{State::silent, Event::duplicate, State::duplicated},
    Entry{State::checking, Event::guided, State::flying},
    Entry{State::checking, Event::still_climbing, State::climbing},
    Entry{State::checking, Event::still_landing, State::landing},
    Entry{State::checking, Event::not_ours, State::standing_by},
    Entry{State::checking, Event::other_mode, State::piloted},
    Entry{State::checking, Event::disarmed, State::standing_by},
    Entry{State::duplicated, Event::given_back, State::searching},
};

constexpr auto kTable = [] {
  std::array<Entry, kOwn.size() + 4 * kLinked.size()> table{};
  std::size_t at = 0;
  for (const Entry& entry : kOwn) table[at++] = entry;
  for (const State state : kLinked) {
    table[at++] = {state, Event::link_lost, State::lost};
    table[at++] = {state, Event::autopilot_silent, State::silent};
    table[at++] = {state, Event::rebooted, State::searching};
    table[at++] = {state, Event::duplicate, State::duplicated};
  }
  return table;
}();

constexpr std::array<std::string_view, static_cast<std::size_t>(State::count)> kStateNames{
    "searching", "refused", "preparing", "standing_by", "arming", "climbing", "taking_over",
    "flying",    "landing", "piloted",   "lost",        "silent", "checking", "duplicated"};

constexpr std::array<std::string_view, static_cast<std::size_t>(Event::count)> kEventNames{
    "autopilot_found", "wrong_autopilot",   "ready",          "may_launch",       "armed",
    "climbed",         "may_take",          "guided",         "may_land",         "other_mode",
    "disarmed",        "not_obeyed",        "still_climbing", "still_landing",    "not_ours",
    "given_back",      "given_back_landed", "link_lost",      "autopilot_silent", "packets_back",
    "rebooted",        "duplicate"};

}  // namespace

std::span<const Companion::Entry> Companion::table() { return kTable; }

std::string_view to_string(Companion::State state) {
  return kStateNames.at(static_cast<std::size_t>(state));
}
std::string_view to_string(Companion::Event event) {
  return kEventNames.at(static_cast<std::size_t>(event));
}

std::string_view to_string(Custody::State state) {
  static constexpr std::array<std::string_view, static_cast<std::size_t>(Custody::State::count)>
      kNames{"fresh", "ours", "spent", "taken_ours", "taken"};
  return kNames.at(static_cast<std::size_t>(state));
}
std::string_view to_string(Custody::Event event) {
  static constexpr std::array<std::string_view, static_cast<std::size_t>(Custody::Event::count)>
      kNames{"in_use",          "launched",   "disarmed",
             "taken_by_others", "given_back", "given_back_landed"};
  return kNames.at(static_cast<std::size_t>(event));
}

}  // namespace skein::ardupilot
