// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include "skein/base/assert.hpp"
#include "skein/base/state_table.hpp"
#include "skein/coalition/messages.hpp"
#include "skein/domain/site.hpp"
#include "skein/domain/task.hpp"
#include "skein/mission/guidance.hpp"
#include "skein/planning/allocation.hpp"

namespace skein::mission {

/// An awarded task on its way: what is flown when, and how far it has come (docs/protocol.md). The
/// flight plan leads past a delivery's gate from `committed` on, and not before.
class TaskFlight {
 public:
  enum class State : std::uint8_t { planned, authorised, committed, begun, late, over, count };
  enum class Event : std::uint8_t {
    granted,    ///< by the operator, this round
    passed_on,  ///< a successor of the leader awards it anew, as it is
    committed,  ///< the flight plan now leads past the gate
    began,      ///< the gate or the start of the arc has been passed
    missed,     ///< it was passed uncommitted, or not certain
    finished,
    dropped,  ///< its lease has ended
    count
  };
  static constexpr auto kTable = state_table(
      from(State::planned, on(Event::granted, State::authorised),
           on(Event::passed_on, State::planned), on(Event::began, State::begun),
           on(Event::missed, State::late), on(Event::dropped, State::over)),
      from(State::authorised, on(Event::passed_on, State::planned),
           on(Event::committed, State::committed), on(Event::missed, State::late),
           on(Event::dropped, State::over)),
      from(State::committed, on(Event::granted, State::committed),
           on(Event::passed_on, State::committed), on(Event::began, State::begun),
           on(Event::dropped, State::over)),
      from(State::begun, on(Event::granted, State::begun), on(Event::passed_on, State::begun),
           on(Event::finished, State::over), on(Event::dropped, State::over)),
      from(State::late, on(Event::granted, State::late), on(Event::passed_on, State::late),
           on(Event::dropped, State::over)));

  TaskFlight() = default;
  TaskFlight(const coalition::Round& awarded, Site where, const TaskAssignment& what)
      : round{awarded}, site{std::move(where)}, assignment{what} {}

  coalition::Round round;
  Site site;
  TaskAssignment assignment;
  planning::TaskPlan plan;
  bool untimely = false;   ///< it has been told that the wind does not let it be on time
  bool strayed = false;    ///< from its arc (Ownship::on_arc), since it has begun
  Duration late{};         ///< that a delivery is over its site, as the wind has it
  bool unlocated = false;  ///< it is over, and where the vehicle was then has not been heard yet

  /// Precondition: the table has it.
  void fire(Event event) {
    const bool known = machine_.fire(event);
    SKEIN_ASSERT(known);
  }
  /// The operator has granted this round, then; false where that is known already.
  bool grant(Instant decided_at) {
    if (authorised()) return false;
    granted_ = round;
    decided_at_ = decided_at;
    fire(Event::granted);
    return true;
  }
  /// The operator's later word, that he grants it no more, changes something.
  [[nodiscard]] bool can_be_taken_back(Instant decided_at) const {
    const bool granted = in(State::authorised) || in_run();
    return is_delivery() && granted && decided_at > decided_at_;
  }
  void pass_on(const coalition::Round& to) {
    round = to;
    granted_.reset();
    fire(Event::passed_on);
  }
  [[nodiscard]] bool authorised() const { return granted_ == round; }
  [[nodiscard]] bool in(State state) const { return machine_.in(state); }
  [[nodiscard]] bool accepts(Event event) const { return machine_.accepts(event); }
  /// It is flown to its end, whatever comes: nothing else is planned for it.
  [[nodiscard]] bool in_run() const { return in(State::committed) || in(State::begun); }

  [[nodiscard]] bool is_delivery() const { return assignment.task.kind == TaskKind::deliver; }
  /// When the task's own run begins: the gate of a delivery, the entry of an arc.
  [[nodiscard]] Instant begin_time() const { return plan.timed.time_at(plan.gate_m); }
  [[nodiscard]] Instant end_time() const { return plan.timed.end_time(); }
  /// It is over, and something else may be flown.
  [[nodiscard]] Instant over_time() const { return end_time() + late; }
  /// What became of it is told: a moment later where that is not known at once.
  [[nodiscard]] Instant told_time() const {
    return unlocated ? over_time() + kFlightControllerSilence : over_time();
  }

 private:
  StateMachine<State, Event> machine_{kTable, State::planned};
  std::optional<coalition::Round> granted_;  ///< the newest that was
  Instant decided_at_{};                     ///< by the operator, on the newest that was granted
};
[[nodiscard]] std::string_view to_string(TaskFlight::State state);
[[nodiscard]] std::string_view to_string(TaskFlight::Event event);

}  // namespace skein::mission
