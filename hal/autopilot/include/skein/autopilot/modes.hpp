// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace skein::autopilot {

/// What a change of mode requires.
enum class Needs : std::uint8_t { nothing, position, mission, rotors };

/// One line of a mode table. No `from`: from every mode.
template <class Mode, class Event>
struct ModeRule {
  std::optional<Mode> from;
  Event event;
  Mode to;
  Needs needs;
};

struct ModeFacts {
  bool position = false;  ///< the position estimate is good
  bool mission = false;   ///< a mission is loaded
  bool rotors = false;    ///< it has some to hover on
};

/// A mode, and the only way to change it: the first rule of the table that fits the mode, the event
/// and the facts. What is not in the table does not happen.
template <class Mode, class Event>
class ModeMachine {
 public:
  using Table = std::span<const ModeRule<Mode, Event>>;
  constexpr ModeMachine(Table table, Mode initial) : table_{table}, mode_{initial} {}

  [[nodiscard]] constexpr Mode mode() const { return mode_; }
  [[nodiscard]] constexpr std::optional<Mode> next(Event event, const ModeFacts& facts) const {
    for (const auto& rule : table_) {
      if (rule.event == event && rule.from.value_or(mode_) == mode_ && meets(rule.needs, facts)) {
        return rule.to;
      }
    }
    return std::nullopt;
  }
  /// False, and nothing changed, where no rule fits.
  constexpr bool fire(Event event, const ModeFacts& facts) {
    const std::optional<Mode> to = next(event, facts);
    if (to) mode_ = *to;
    return to.has_value();
  }

 private:
  static constexpr bool meets(Needs needs, const ModeFacts& facts) {
    switch (needs) {
      case Needs::position:
        return facts.position;
      case Needs::mission:
        return facts.mission && facts.position;
      case Needs::rotors:
        return facts.rotors && facts.position;
      case Needs::nothing:
        break;
    }
    return true;
  }

  Table table_;
  Mode mode_;
};

/// The modes of a fixed wing, with the numbers that ArduPilot's Plane gives them; the last three
/// are a quadplane's.
enum class PlaneMode : std::uint8_t {
  manual = 0,
  fbwa = 5,
  mission = 10,  ///< AUTO
  rtl = 11,
  loiter = 12,
  takeoff = 13,
  guided = 15,
  q_loiter = 19,
  q_land = 20,
  q_rtl = 21,
};
/// The modes of a multirotor, with the numbers that ArduPilot's Copter gives them.
enum class CopterMode : std::uint8_t { stabilize = 0, guided = 4, loiter = 5, rtl = 6, land = 9 };

enum class PlaneEvent : std::uint8_t {
  select_manual,
  select_fbwa,
  select_mission,
  select_rtl,
  select_loiter,
  select_takeoff,
  select_guided,
  select_q_loiter,
  select_q_land,
  select_q_rtl,
  companion_lost,
  mission_ended,
};
enum class CopterEvent : std::uint8_t {
  select_stabilize,
  select_guided,
  select_loiter,
  select_rtl,
  select_land,
  companion_lost,
  position_lost,
};

/// A lost companion ends only what flies by itself: in MANUAL and FBWA a pilot flies, TAKEOFF and
/// RTL go on.
inline constexpr std::array kPlaneModes{
    ModeRule<PlaneMode, PlaneEvent>{
        {}, PlaneEvent::select_manual, PlaneMode::manual, Needs::nothing},
    ModeRule<PlaneMode, PlaneEvent>{{}, PlaneEvent::select_fbwa, PlaneMode::fbwa, Needs::nothing},
    ModeRule<PlaneMode, PlaneEvent>{
        {}, PlaneEvent::select_mission, PlaneMode::mission, Needs::mission},
    ModeRule<PlaneMode, PlaneEvent>{{}, PlaneEvent::select_rtl, PlaneMode::rtl, Needs::position},
    ModeRule<PlaneMode, PlaneEvent>{
        {}, PlaneEvent::select_loiter, PlaneMode::loiter, Needs::position},
    ModeRule<PlaneMode, PlaneEvent>{
        {}, PlaneEvent::select_takeoff, PlaneMode::takeoff, Needs::position},
    ModeRule<PlaneMode, PlaneEvent>{
        {}, PlaneEvent::select_guided, PlaneMode::guided, Needs::position},
    ModeRule<PlaneMode, PlaneEvent>{
        {}, PlaneEvent::select_q_loiter, PlaneMode::q_loiter, Needs::rotors},
    ModeRule<PlaneMode, PlaneEvent>{
        {}, PlaneEvent::select_q_land, PlaneMode::q_land, Needs::rotors},
    ModeRule<PlaneMode, PlaneEvent>{{}, PlaneEvent::select_q_rtl, PlaneMode::q_rtl, Needs::rotors},
    ModeRule<PlaneMode, PlaneEvent>{PlaneMode::guided, PlaneEvent::companion_lost, PlaneMode::rtl,
                                    Needs::position},
    ModeRule<PlaneMode, PlaneEvent>{PlaneMode::mission, PlaneEvent::companion_lost, PlaneMode::rtl,
                                    Needs::position},
    ModeRule<PlaneMode, PlaneEvent>{PlaneMode::loiter, PlaneEvent::companion_lost, PlaneMode::rtl,
                                    Needs::position},
    ModeRule<PlaneMode, PlaneEvent>{PlaneMode::mission, PlaneEvent::mission_ended, PlaneMode::rtl,
                                    Needs::position},
};

/// Without a position it cannot return, so it lands where it is.
inline constexpr std::array kCopterModes{
    ModeRule<CopterMode, CopterEvent>{
        {}, CopterEvent::select_stabilize, CopterMode::stabilize, Needs::nothing},
    ModeRule<CopterMode, CopterEvent>{
        {}, CopterEvent::select_guided, CopterMode::guided, Needs::position},
    ModeRule<CopterMode, CopterEvent>{
        {}, CopterEvent::select_loiter, CopterMode::loiter, Needs::position},
    ModeRule<CopterMode, CopterEvent>{
        {}, CopterEvent::select_rtl, CopterMode::rtl, Needs::position},
    ModeRule<CopterMode, CopterEvent>{
        {}, CopterEvent::select_land, CopterMode::land, Needs::nothing},
    ModeRule<CopterMode, CopterEvent>{CopterMode::guided, CopterEvent::companion_lost,
                                      CopterMode::rtl, Needs::position},
    ModeRule<CopterMode, CopterEvent>{CopterMode::guided, CopterEvent::companion_lost,
                                      CopterMode::land, Needs::nothing},
    ModeRule<CopterMode, CopterEvent>{CopterMode::guided, CopterEvent::position_lost,
                                      CopterMode::land, Needs::nothing},
    ModeRule<CopterMode, CopterEvent>{CopterMode::loiter, CopterEvent::position_lost,
                                      CopterMode::land, Needs::nothing},
    ModeRule<CopterMode, CopterEvent>{CopterMode::rtl, CopterEvent::position_lost, CopterMode::land,
                                      Needs::nothing},
};

/// As ArduPilot writes them: "GUIDED".
[[nodiscard]] std::string_view to_string(PlaneMode mode);
[[nodiscard]] std::string_view to_string(CopterMode mode);
/// The mode of a number on the wire, or none of ours.
[[nodiscard]] std::optional<PlaneMode> plane_mode(std::uint32_t number);
[[nodiscard]] std::optional<CopterMode> copter_mode(std::uint32_t number);
/// Those of a quadplane alone, by the table.
[[nodiscard]] constexpr bool needs_rotors(PlaneMode mode) {
  for (const auto& rule : kPlaneModes) {
    if (rule.to == mode && rule.needs == Needs::rotors) return true;
  }
  return false;
}
/// The event by which an operator or companion asks for a mode.
[[nodiscard]] PlaneEvent selection_of(PlaneMode mode);
[[nodiscard]] CopterEvent selection_of(CopterMode mode);

}  // namespace skein::autopilot
