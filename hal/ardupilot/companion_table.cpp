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

constexpr auto kOwn = state_table(
    from(State::searching, on(Event::autopilot_found, State::preparing),
         on(Event::wrong_autopilot, State::refused), on(Event::duplicate, State::duplicated)),
    from(State::refused, on(Event::autopilot_found, State::preparing),
         on(Event::duplicate, State::duplicated), on(Event::rebooted, State::searching)),
    from(State::preparing, on(Event::ready, State::standing_by),
         on(Event::wrong_autopilot, State::refused), on(Event::link_lost, State::searching),
         on(Event::rebooted, State::searching), on(Event::duplicate, State::duplicated)),
    from(State::standing_by, on(Event::guided, State::flying),
         on(Event::may_take, State::taking_over), on(Event::may_launch, State::arming),
         on(Event::given_back, State::taking_over)),
    from(State::arming, on(Event::armed, State::climbing),
         on(Event::not_obeyed, State::standing_by), on(Event::other_mode, State::piloted)),
    from(State::climbing, on(Event::climbed, State::taking_over),
         on(Event::other_mode, State::piloted), on(Event::disarmed, State::standing_by),
         on(Event::not_obeyed, State::piloted)),
    from(State::taking_over, on(Event::guided, State::flying),
         on(Event::not_obeyed, State::piloted), on(Event::other_mode, State::piloted),
         on(Event::disarmed, State::standing_by)),
    from(State::flying, on(Event::other_mode, State::piloted),
         on(Event::disarmed, State::standing_by), on(Event::may_land, State::landing)),
    from(State::landing, on(Event::disarmed, State::standing_by),
         on(Event::called_off, State::taking_over), on(Event::other_mode, State::piloted),
         on(Event::not_obeyed, State::piloted)),
    from(State::piloted, on(Event::given_back, State::taking_over),
         on(Event::given_back_landed, State::standing_by)),
    from(State::lost, on(Event::packets_back, State::checking),
         on(Event::autopilot_silent, State::silent), on(Event::rebooted, State::searching),
         on(Event::duplicate, State::duplicated)),
    from(State::silent, on(Event::packets_back, State::checking), on(Event::link_lost, State::lost),
         on(Event::rebooted, State::searching), on(Event::duplicate, State::duplicated)),
    from(State::checking, on(Event::guided, State::flying),
         on(Event::still_climbing, State::climbing), on(Event::still_landing, State::landing),
         on(Event::not_ours, State::standing_by), on(Event::other_mode, State::piloted),
         on(Event::disarmed, State::standing_by)),
    from(State::duplicated, on(Event::given_back, State::searching)));

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
    "autopilot_found", "wrong_autopilot",   "ready",         "may_launch",
    "armed",           "climbed",           "may_take",      "guided",
    "may_land",        "called_off",        "other_mode",    "disarmed",
    "not_obeyed",      "still_climbing",    "still_landing", "not_ours",
    "given_back",      "given_back_landed", "link_lost",     "autopilot_silent",
    "packets_back",    "rebooted",          "duplicate"};

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
