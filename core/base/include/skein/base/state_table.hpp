// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace skein {

/// One line of a state machine's table. The table is the machine: what is not in it does not
/// happen.
template <class State, class Event>
struct Transition {
  State from;
  Event event;
  State to;
};

/// A way out of a state, as from() takes it.
template <class State, class Event>
struct WayOut {
  Event event;
  State to;
};
template <class Event, class State>
[[nodiscard]] constexpr WayOut<State, Event> on(Event event, State to) {
  return {event, to};
}
/// The lines of one state: from(State::a, on(Event::x, State::b), on(Event::y, State::c)).
template <class State, class Event, class... More>
[[nodiscard]] constexpr auto from(State state, WayOut<State, Event> first, More... more) {
  using Line = Transition<State, Event>;
  return std::array{Line{state, first.event, first.to}, Line{state, more.event, more.to}...};
}
/// The lines of all states.
template <class Line, std::size_t... Counts>
[[nodiscard]] constexpr auto state_table(const std::array<Line, Counts>&... states) {
  std::array<Line, (Counts + ...)> table{};
  std::size_t at = 0;
  const auto add = [&](const auto& lines) {
    for (const Line& line : lines) table[at++] = line;
  };
  (add(states), ...);
  return table;
}

/// A state and the only way to change it: by an event that the table has an entry for. An event
/// without an entry leaves the state and is counted.
template <class State, class Event>
class StateMachine {
 public:
  using Table = std::span<const Transition<State, Event>>;
  constexpr StateMachine(Table table, State initial) : table_{table}, state_{initial} {}

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] bool in(State state) const { return state_ == state; }
  [[nodiscard]] bool accepts(Event event) const { return find(event) != nullptr; }
  /// False, and counted, when the table has no entry.
  bool fire(Event event) {
    const auto* entry = find(event);
    if (entry == nullptr) {
      ++protocol_errors_;
      return false;
    }
    state_ = entry->to;
    return true;
  }
  [[nodiscard]] std::uint64_t protocol_errors() const { return protocol_errors_; }

 private:
  [[nodiscard]] const Transition<State, Event>* find(Event event) const {
    for (const auto& entry : table_) {
      if (entry.from == state_ && entry.event == event) return &entry;
    }
    return nullptr;
  }

  Table table_;
  State state_;
  std::uint64_t protocol_errors_ = 0;
};

/// The table as a Mermaid state diagram, for the documents. `name_of` is to_string of both
/// enums.
template <class State, class Event>
[[nodiscard]] std::string mermaid(std::span<const Transition<State, Event>> table, State initial) {
  std::string text = "stateDiagram-v2\n    [*] --> " + std::string{to_string(initial)} + "\n";
  for (const auto& entry : table) {
    text += "    " + std::string{to_string(entry.from)} + " --> " +
            std::string{to_string(entry.to)} + " : " + std::string{to_string(entry.event)} + "\n";
  }
  return text;
}

}  // namespace skein
