// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "skein/base/state_table.hpp"

namespace skein::ardupilot {

/// Whose the aircraft is, and whether the companion may launch it: never twice unasked, and never
/// one that others fly (docs/ardupilot.md). It outlives every loss of the link and every reboot.
class Custody {
 public:
  enum class State : std::uint8_t {
    fresh,       ///< never seen armed or in the air
    ours,        ///< launched by the companion, and not disarmed since
    spent,       ///< it was in use, or its launch was broken off
    taken_ours,  ///< by others, in a flight that the companion had launched
    taken,       ///< by others, until the operator gives it back
    count
  };
  enum class Event : std::uint8_t {
    in_use,    ///< seen armed or in the air, or its launch is over
    launched,  ///< armed by the companion, it climbs
    disarmed,
    taken_by_others,
    given_back,  ///< by the operator, in the air
    given_back_landed,
    count
  };
  using Entry = Transition<State, Event>;
  static constexpr auto kTable = state_table(
      from(State::fresh, on(Event::in_use, State::spent), on(Event::launched, State::ours),
           on(Event::taken_by_others, State::taken)),
      from(State::spent, on(Event::launched, State::ours), on(Event::taken_by_others, State::taken),
           on(Event::given_back_landed, State::fresh)),
      from(State::ours, on(Event::disarmed, State::spent),
           on(Event::taken_by_others, State::taken_ours)),
      from(State::taken_ours, on(Event::disarmed, State::taken),
           on(Event::given_back, State::ours)),
      from(State::taken, on(Event::given_back, State::spent),
           on(Event::given_back_landed, State::fresh)));

  /// What is not in the table changes nothing: most are heard again and again.
  void fire(Event event) {
    if (machine_.accepts(event)) machine_.fire(event);
  }
  [[nodiscard]] State state() const { return machine_.state(); }
  [[nodiscard]] bool by_others() const {
    return machine_.in(State::taken) || machine_.in(State::taken_ours);
  }
  [[nodiscard]] bool may_launch() const { return machine_.in(State::fresh); }
  [[nodiscard]] bool own_flight() const { return machine_.in(State::ours); }

 private:
  StateMachine<State, Event> machine_{kTable, State::fresh};
};
[[nodiscard]] std::string_view to_string(Custody::State state);
[[nodiscard]] std::string_view to_string(Custody::Event event);

}  // namespace skein::ardupilot
